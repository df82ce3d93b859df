// Deformed volumes are whole volumes: whatever an appearance asks for, one that is bent by a
// millionth shows what one that is not bent does. The one is walked through tetrahedron by
// tetrahedron, the other is one convex region.
#include "DeformedLattice.h"
#include "Volumes.h"

#include <osgVolumizer/VolumeCut.h>

#include <support/GLTest.h>
#include <support/Hooks.h>
#include <support/Precision.h>
#include <support/Reports.h>

#include <osg/Fog>

namespace DeformedTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 25; // voxels per axis

support::RenderOptions view()
{
    support::RenderOptions options;
    options.size(96, 96).perspective(36.0).lookAt({60, -40, 44}, {12, 12, 12}, {0, 0, 1});
    options.light = true;
    return options;
}

class Deformed : public support::GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        _voxels = makeVoxels(glm::ivec3(SIZE), bumps);
        _volume = makeVolume(_voxels);
        _volume->setLookupTable(makeTable(smoothPoints(0.15)));
        _volume->setSamplingPeriod(osg::Vec3d(0.25, 0.25, 0.25));
        _straight = _volume->getChild(0);
        _root->addChild(_volume);
    }
    support::FloatImage draw(osg::Node* geometry)
    {
        _volume->setChild(0, geometry);
        return support::renderScene(_root, view());
    }
    void expectSame(const std::string& name, double rmse, double maximum)
    {
        const support::FloatImage straight = draw(_straight), bent = draw(_bent);
        support::savePicture(bent, "deformed_" + name);
        const support::Mask inside =
            support::eroded(support::coveredPixels(straight) & support::coveredPixels(bent), 1);
        const support::Difference d = support::compare(bent, straight, inside);
        std::printf("  %-14s rmse %.1e, maximum %.1e at %d %d, %zu pixels\n", name.c_str(), d.rmse,
                    d.maximum, d.worstX, d.worstY, d.pixels);
        EXPECT_GT(d.pixels, 1000u) << name;
        EXPECT_LT(d.rmse, rmse) << name;
        EXPECT_LT(d.maximum, maximum) << name;
    }

    osg::ref_ptr<osg::Group> _root = new osg::Group;
    osg::ref_ptr<Voxels> _voxels;
    osg::ref_ptr<A> _volume;
    osg::ref_ptr<osg::Node> _straight, _bent = deformedLattice(SIZE, 1e-6);
};

} // namespace

TEST_F(Deformed, IsLit)
{
    _volume->setShading(true);
    // Both are off by as much where normals turn round.
    expectSame("lit", 2e-4, 6e-3);
    _volume->setGradients(A::PRECOMPUTED);
    expectSame("gradients", 2e-4, 6e-3);
}

TEST_F(Deformed, HasRayFunctions)
{
    _volume->setIsoValue(0.6);
    _volume->setLookupTable(makeTable({{0.0, {0, 0, 0, 1}}, {1.0, {1, 1, 1, 1}}}));
    for (const auto function : {A::MAXIMUM, A::AVERAGE}) {
        _volume->setRayFunction(function);
        expectSame(A::RAY_FUNCTION_NAMES[function], 2e-4, 2e-3);
    }
    _volume->setRayFunction(A::ISOSURFACE);
    _volume->setShading(true);
    expectSame("isosurface", 2e-3, 0.3); // whose outline differs by a ray here and there
}

TEST_F(Deformed, IsPreintegratedAndFilteredAsAskedFor)
{
    _volume->setLookup(A::PREINTEGRATED);
    expectSame("preintegrated", 2e-4, 2e-3);
    _volume->setLookup(A::AUTOMATIC_LOOKUP);
    _volume->setInterpolation(A::CUBIC);
    expectSame("cubic", 2e-4, 2e-3);
}

TEST_F(Deformed, IsCutAndInFog)
{
    osg::ref_ptr<VolumeCut> cut = new VolumeCut;
    cut->addRegion(CutRegion::sphere({12, 12, 12}, 9.0).complement());
    cut->addRegion(CutRegion::halfSpace({0.3, -0.5, 0.8, -12.0}));
    _volume->setCut(cut);
    expectSame("cut", 1e-3, 1e-2); // of the sphere each step has a share that is linear in it
    _volume->setCut(nullptr);
    osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setMode(osg::Fog::LINEAR);
    fog->setStart(50.0f);
    fog->setEnd(110.0f);
    fog->setColor(osg::Vec4(0.2f, 0.4f, 0.1f, 1.0f));
    _root->getOrCreateStateSet()->setAttributeAndModes(fog);
    expectSame("fog", 1e-4, 1e-3);
}

TEST_F(Deformed, BricksShareATexture)
{
    ASSERT_TRUE(_voxels->setBrickSize({9, 9, 9}).ok());
    expectSame("bricks", 1e-4, 1e-3);
}

TEST_F(Deformed, LeapsOverEmptyCells)
{
    _volume->setLookupTable(
        makeTable({{0.0, {0, 0, 0, 0}}, {0.7, {0, 0, 0, 0}}, {1.0, {1, 0.5, 0, 0.6}}}));
    _volume->setVoxels(makeBlob(glm::ivec3(SIZE), 2.5));
    _volume->setSamplingPeriod(osg::Vec3d(0.05, 0.05, 0.05));
    _volume->setChild(0, deformedLattice(SIZE, 1e-6, 2));
    const auto viewOf = [](bool skipping) {
        return support::prepared(view(), [skipping](osgViewer::Viewer& viewer) {
            support::viewHooks(viewer).skipping = skipping;
        });
    };
    const auto samplesOf = [&](bool skipping) {
        double sum = 0.0;
        for (const glm::vec4& pixel :
             support::renderScene(_root, support::countingSamples(viewOf(skipping))).pixels)
            sum += pixel.r;
        return sum;
    };
    EXPECT_LT(samplesOf(true), 0.5 * samplesOf(false));
    const support::Difference d = support::compare(support::renderScene(_root, viewOf(true)),
                                                   support::renderScene(_root, viewOf(false)));
    EXPECT_LT(d.rmse, 1e-5); // places are added up from another step
    EXPECT_LT(d.maximum, 1e-4);
}

TEST_F(Deformed, KeepsAnErrorTolerance)
{
    _volume->setErrorTolerance(1e-3);
    const support::Reports reports;
    const support::FloatImage fine = draw(_bent);
    EXPECT_EQ(reports.count("tolerance"), 0);
    _volume->setErrorTolerance(0.0);
    _volume->setSamplingPeriod(osg::Vec3d(0.0625, 0.0625, 0.0625));
    const support::FloatImage finest = draw(_bent);
    EXPECT_LT(support::compare(fine, finest).rmse, 1e-3);
}

TEST_F(Deformed, ItsSegmentsAreSecondOrder)
{
    // Really bent, against the finest.
    _bent = deformedLattice(SIZE, 1.5);
    std::vector<double> periods, errors;
    const auto pictureAt = [&](double period) {
        _volume->setSamplingPeriod(osg::Vec3d(period, period, period));
        return draw(_bent);
    };
    const support::FloatImage finest = pictureAt(0.0625);
    for (const double period : {2.0, 1.0, 0.5}) {
        periods.push_back(period);
        errors.push_back(support::compare(pictureAt(period), finest).rmse);
        std::printf("  period %.2f: %.2e\n", period, errors.back());
    }
    EXPECT_GT(support::convergenceOrder(periods, errors), 1.9);
    EXPECT_LT(errors[1], 4e-4);
}

// Regions of any shape of voxels in one frame: what lies between outer faces is marched at once.
TEST_F(Deformed, RegionsThatAreNotConvexAreMarchedAtOnce)
{
    const auto twin = makeTwin(_voxels, smoothPoints(0.1));
    oracle::TetraMesh mesh = oracle::cornerMesh(6);
    oracle::transform(mesh, glm::dmat4(glm::dmat3(SIZE - 1.0)));
    osg::ref_ptr<VolumeGeometry> corner = new VolumeGeometry;
    ASSERT_TRUE(corner->setTetraSet(oracle::tetraSet(mesh)).ok());
    oracle::Scene scene;
    for (const auto& cell : mesh.cells) {
        oracle::Volume part = twin.oracle;
        part.region = oracle::tetraRegion({mesh.corner(cell, 0), mesh.corner(cell, 1),
                                           mesh.corner(cell, 2), mesh.corner(cell, 3)});
        scene.volumes.push_back(part);
    }
    twin.node->setChild(0, corner);
    twin.node->setSamplingPeriod(osg::Vec3d(1.0, 1.0, 1.0));
    support::filterExactly(*twin.node);
    const auto options = view();
    const support::Difference d =
        support::compare(support::renderScene(twin.node, options), oraclePicture(scene, options),
                         awayFromSilhouettes(scene, options));
    EXPECT_LT(d.rmse, 2e-4);
    EXPECT_EQ(twin.node->getSettingsInForce(*corner).technique, A::SLABS);
}

TEST_F(Deformed, SlicesRemainAChoice)
{
    _volume->setTechnique(A::SLICES);
    auto* geometry = static_cast<VolumeGeometry*>(_bent.get());
    EXPECT_EQ(_volume->getSettingsInForce(*geometry).technique, A::SLICES);
    _volume->setSamplingPeriod(osg::Vec3d(0.1, 0.1, 0.1));
    const support::FloatImage slices = draw(_bent);
    _volume->setTechnique(A::AUTOMATIC);
    const support::FloatImage slabs = draw(_bent);
    EXPECT_LT(support::compare(slices, slabs).rmse, 3e-3);
    EXPECT_GT(support::compare(slices, slabs).rmse, 0.0);
}

} // namespace DeformedTest
