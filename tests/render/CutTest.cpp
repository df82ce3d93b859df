// Regions cut volumes: boxes, half-spaces, spheres, surfaces, masks, all together.

#include "MixedScene.h"
#include "Volumes.h"

#include <osgVolumizer/VolumeCut.h>
#include <osgVolumizer/VolumeSlice.h>
#include <osgVolumizer/interact/CutCaps.h>

#include <osg/ShapeDrawable>

#include <support/GLTest.h>
#include <support/Precision.h>
#include <support/Reports.h>

#include <cmath>

namespace CutRenderTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 25;
const osg::BoundingBoxd PART(5.3, 4.2, 6.9, 19.6, 21.1, 17.4);
const osg::Vec3d MIDDLE(12.3, 11.8, 12.1);
constexpr double RADIUS = 9.2;

RenderOptions view(const osg::Vec3d& eye = {55, -40, 45})
{
    return RenderOptions().size(63, 56).perspective(35.0).lookAt(eye, {12, 12, 12}, {0, 0, 1});
}

osg::ref_ptr<A> volumeOf(const std::vector<CutRegion>& regions, double period = 0.25,
                         A::Technique technique = A::SLABS)
{
    static const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    const osg::ref_ptr<A> volume = makeVolume(voxels);
    volume->setTechnique(technique);
    volume->setLookupTable(makeTable(smoothPoints(0.15)));
    volume->setSamplingPeriod({period, period, period});
    support::filterExactly(*volume);
    if (regions.empty()) return volume;
    volume->setCut(new VolumeCut);
    for (const CutRegion& region : regions)
        EXPECT_TRUE(volume->getCut()->addRegion(region));
    return volume;
}

osg::ref_ptr<osg::Group> groupOf(std::initializer_list<osg::ref_ptr<osg::Node>> nodes)
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (const auto& node : nodes)
        group->addChild(node);
    return group;
}

// Triangles of a box as a mesh, or of a sphere, of so many along each edge that it is no
// polyhedron.
osg::ref_ptr<osg::Drawable> sphereOfTriangles()
{
    osg::ref_ptr<osg::TessellationHints> hints = new osg::TessellationHints;
    hints->setDetailRatio(6.0f);
    return new osg::ShapeDrawable(new osg::Sphere(MIDDLE, RADIUS), hints);
}

// The same sphere, less its distance, as voxels twice as fine as those that it is a mask of.
osg::ref_ptr<Voxels> sphereMask(bool labels)
{
    const osg::ref_ptr<Voxels> mask =
        makeVoxels(glm::ivec3(2 * SIZE - 1), [labels](const glm::dvec3& p) {
            const glm::dvec3 middle(MIDDLE.x(), MIDDLE.y(), MIDDLE.z());
            const double inside = RADIUS - glm::length(0.5 * p - middle);
            return labels ? (inside > 0.0 ? 3.0 : 7.0) : inside;
        });
    EXPECT_TRUE(mask->setSpacing({0.5, 0.5, 0.5}));
    return mask;
}

double difference(const FloatImage& a, const FloatImage& b)
{
    return support::compare(a, b, support::coveredPixels(a) | support::coveredPixels(b)).maximum;
}

double rmse(const FloatImage& a, const FloatImage& b)
{
    return support::compare(a, b).rmse;
}

class Cuts : public support::GLTest
{
};

} // namespace

// As clip planes do, and as geometry does.
TEST_F(Cuts, ABoxCutsAsABoxOfGeometry)
{
    const auto expected = [](const osg::Vec3d& eye) {
        const osg::ref_ptr<A> part = volumeOf({});
        part->removeChildren(0, 1);
        part->addChild(VolumeGeometry::createBox(PART));
        return support::renderScene(part, view(eye));
    };
    osg::ref_ptr<osg::ShapeDrawable> mesh = new osg::ShapeDrawable(
        new osg::Box(PART.center(), float(PART.xMax() - PART.xMin()),
                     float(PART.yMax() - PART.yMin()), float(PART.zMax() - PART.zMin())));
    for (const osg::Vec3d& eye : {osg::Vec3d(55, -40, 45), {12, 60, 12}}) {
        const FloatImage cut = support::renderScene(volumeOf({CutRegion::box(PART)}), view(eye));
        EXPECT_GT(support::coveredPixels(cut, 0.2f).count(), 250u);
        EXPECT_LT(difference(cut, expected(eye)), 1e-5);
        // Floats of the mesh are as good.
        EXPECT_LT(difference(support::renderScene(volumeOf({CutRegion::surface(*mesh)}), view(eye)),
                             expected(eye)),
                  1e-4);
    }
}

// What a region keeps and what its complement does are all of the volume: opacities multiply.
TEST_F(Cuts, AndItsComplementMakeAWhole)
{
    const std::vector<std::pair<const char*, CutRegion>> regions = {
        {"half_space", CutRegion::halfSpace({1, 2, -1, -20})},
        {"box", CutRegion::box(PART)},
        {"sphere", CutRegion::sphere(MIDDLE, RADIUS)},
        {"surface", CutRegion::surface(*sphereOfTriangles())},
        {"mask", CutRegion::mask(sphereMask(false), 0.0)},
        {"labels", CutRegion::mask(sphereMask(true), 2.5, 3.5)}};
    for (const auto technique : {A::SLABS, A::SLICES}) {
        const FloatImage whole = support::renderScene(volumeOf({}, 0.5, technique), view());
        for (const auto& region : regions) {
            for (const double softness : {0.0, 3.0}) {
                // Each is a shader to compile: one of analytic regions and one of grids will do.
                const std::string name = region.first;
                const bool all = technique == A::SLABS && softness == 0.0;
                if (!all && name != "sphere" && name != "mask") continue;
                const auto render = [&](const CutRegion& r) {
                    const osg::ref_ptr<A> volume = volumeOf({r}, 0.5, technique);
                    volume->getCut()->setSoftness(softness);
                    return support::renderScene(volume, view());
                };
                const FloatImage inside = render(region.second);
                const FloatImage outside = render(region.second.complement());
                double worst = 0.0;
                for (int y = 0; y < whole.height; ++y)
                    for (int x = 0; x < whole.width; ++x) {
                        const double through =
                            (1.0 - inside.at(x, y)[3]) * (1.0 - outside.at(x, y)[3]);
                        worst = std::max(worst, std::abs(1.0 - whole.at(x, y)[3] - through));
                    }
                // Steps are shared but at the edges of a box, whose inside is cut by planes.
                const bool edges = name == "box";
                EXPECT_LT(worst, edges ? 2e-2 : 2e-3)
                    << region.first << " " << softness << " " << technique;
                EXPECT_GT(support::coveredPixels(inside, 0.1f).count(), 150u) << region.first;
                EXPECT_GT(difference(inside, whole), 0.05) << region.first;
                const std::string file = "cut_" + name + (softness > 0.0 ? "_soft" : "") +
                                         (technique == A::SLICES ? "_slices" : "");
                support::savePicture(inside, file);
                support::savePicture(outside, file + "_complement");
            }
        }
    }
}

// A ball of one value: every pixel is one length.
TEST_F(Cuts, ASphereIsMetToSecondOrder)
{
    const osg::ref_ptr<A> volume = volumeOf({CutRegion::sphere(MIDDLE, RADIUS)});
    volume->setLookupTable(makeTable(constantPoints({0.8, 0.4, 0.2, 0.1})));
    const RenderOptions look = view();
    const oracle::Camera camera = support::oracleCamera(look);
    const glm::dmat4 toWorld = glm::inverse(camera.projection * camera.view);
    const auto chord = [&](int x, int y) {
        const auto at = [&](double z) {
            const glm::dvec4 p =
                toWorld * glm::dvec4((x + 0.5) / camera.width * 2.0 - 1.0,
                                     (y + 0.5) / camera.height * 2.0 - 1.0, z, 1.0);
            return glm::dvec3(p) / p.w;
        };
        const glm::dvec3 start = at(-1.0), direction = glm::normalize(at(1.0) - start);
        const glm::dvec3 to = glm::dvec3(MIDDLE.x(), MIDDLE.y(), MIDDLE.z()) - start;
        const double along = glm::dot(to, direction);
        const double square = RADIUS * RADIUS - (glm::dot(to, to) - along * along);
        return square > 0.0 ? 2.0 * std::sqrt(square) : 0.0;
    };
    std::vector<double> periods{1.0, 0.5, 0.25, 0.125}, errors;
    for (const double period : periods) {
        volume->setSamplingPeriod({period, period, period});
        const FloatImage picture = support::renderScene(volume, look);
        double sum = 0.0;
        int count = 0;
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x) {
                const double length = chord(x, y);
                // Shorter than a step, or nearly, where a ray grazes the sphere.
                if (length < 3.0) continue;
                const double expected = -std::expm1(std::log1p(-0.1) * length);
                sum += std::pow(picture.at(x, y)[3] - expected, 2.0);
                ++count;
            }
        EXPECT_GT(count, 150);
        errors.push_back(std::sqrt(sum / count));
    }
    EXPECT_GT(support::convergenceOrder(periods, errors), 1.8)
        << errors[0] << " " << errors[1] << " " << errors[2] << " " << errors[3];
    EXPECT_LT(errors.back(), 1e-4);
}

// Of the same sphere as triangles and as masks, the finer the grid the better.
TEST_F(Cuts, SurfacesAndMasksConvergeToTheSphere)
{
    const FloatImage exact =
        support::renderScene(volumeOf({CutRegion::sphere(MIDDLE, RADIUS)}), view());
    for (const bool mask : {false, true}) {
        std::vector<double> steps, errors;
        for (const int resolution : {13, 25, 49}) {
            const osg::ref_ptr<A> volume =
                volumeOf({mask ? CutRegion::mask(sphereMask(false), 0.0)
                               : CutRegion::surface(*sphereOfTriangles())});
            volume->getCut()->setResolution(resolution);
            errors.push_back(rmse(support::renderScene(volume, view()), exact));
            steps.push_back(24.0 / (resolution - 1));
        }
        EXPECT_GT(support::convergenceOrder(steps, errors), 1.7)
            << errors[0] << " " << errors[1] << " " << errors[2];
        EXPECT_LT(errors.back(), 2e-3);
    }
}

// Against an oracle that knows how much is left at each place.
TEST_F(Cuts, SoftOnesFadeToSecondOrder)
{
    class Faded : public oracle::Field
    {
    public:
        Faded(double extinction, double color) : _extinction(extinction * color) {}
        double value(const glm::dvec3& p) const override
        {
            const glm::dvec3 middle(MIDDLE.x(), MIDDLE.y(), MIDDLE.z());
            return _extinction *
                   glm::clamp((RADIUS - glm::length(p - middle)) / 4.0 + 0.5, 0.0, 1.0);
        }
        glm::dvec3 gradient(const glm::dvec3&) const override { return glm::dvec3(0.0); }

    private:
        double _extinction;
    };
    const osg::ref_ptr<A> volume = volumeOf({CutRegion::sphere(MIDDLE, RADIUS)});
    ASSERT_TRUE(volume->getCut()->setSoftness(4.0));
    volume->setLookupTable(makeTable(constantPoints({0.8, 0.4, 0.2, 0.1})));
    oracle::Volume expected =
        oracle::voxelVolume(std::make_shared<oracle::ConstantField>(0.5), glm::ivec3(SIZE),
                            oracle::Table(constantPoints({0.8, 0.4, 0.2, 0.1})));
    const double extinction = -std::log1p(-0.1);
    expected.medium = {
        std::make_shared<Faded>(extinction, 0.8), std::make_shared<Faded>(extinction, 0.4),
        std::make_shared<Faded>(extinction, 0.2), std::make_shared<Faded>(extinction, 1.0)};
    const FloatImage truth = oraclePicture(oracleScene(expected), view());
    std::vector<double> periods{2.0, 1.0, 0.5, 0.25}, errors;
    for (const double period : periods) {
        volume->setSamplingPeriod({period, period, period});
        errors.push_back(rmse(support::renderScene(volume, view()), truth));
    }
    EXPECT_GT(support::convergenceOrder(periods, errors), 1.8)
        << errors[0] << " " << errors[1] << " " << errors[2] << " " << errors[3];
    EXPECT_LT(errors.back(), 2e-4);
}

TEST_F(Cuts, OverlappingVolumesHaveEachTheirOwn)
{
    const CutRegion sphere = CutRegion::sphere(MIDDLE, RADIUS);
    const FloatImage whole = support::renderScene(volumeOf({}), view());
    const FloatImage both = support::renderScene(
        groupOf({volumeOf({sphere}), volumeOf({sphere.complement()})}), view());
    EXPECT_LT(rmse(both, whole), 5e-4);
    const FloatImage meshes = support::renderScene(
        groupOf({volumeOf({CutRegion::surface(*sphereOfTriangles())}),
                 volumeOf({CutRegion::surface(*sphereOfTriangles()).complement()})}),
        view());
    EXPECT_LT(rmse(meshes, whole), 5e-4);
}

// A sheet of glass, and an opaque ball, within what is cut away.
TEST_F(Cuts, SurfacesShowInWhatIsCutAway)
{
    const auto glass =
        makeGeometry(quadMesh({glm::vec3(-4, 10, -4), {30, 14, -4}, {30, 14, 30}, {-4, 10, 30}}),
                     {0.2, 0.5, 0.9, 0.5}, false);
    const osg::ref_ptr<A> volume = volumeOf({CutRegion::sphere(MIDDLE, RADIUS).complement()});
    const FloatImage picture = support::renderScene(groupOf({volume, glass}), view());
    support::savePicture(picture, "cut_with_glass");
    EXPECT_GT(difference(picture, support::renderScene(volume, view())), 0.1);
}

TEST_F(Cuts, OtherRayFunctionsAreCut)
{
    const CutRegion box = CutRegion::box(PART);
    // By the shader, and by planes.
    for (const A::RayFunction function :
         {A::MAXIMUM, A::MINIMUM, A::AVERAGE, A::SUM, A::ISOSURFACE}) {
        const auto render = [&](const std::vector<CutRegion>& regions, double softness) {
            const osg::ref_ptr<A> volume = volumeOf(regions, 0.125);
            if (volume->getCut()) volume->getCut()->setSoftness(softness);
            volume->setRayFunction(function);
            volume->setIsoValue(0.5);
            return support::renderScene(volume, view());
        };
        const FloatImage planes = render({box}, 0.0), shader = render({box}, 1e-3);
        const FloatImage whole = render({}, 0.0);
        support::savePicture(shader, "cut_function_" + std::to_string(function));
        EXPECT_GT(support::coveredPixels(planes).count(), 100u);
        EXPECT_GT(rmse(planes, whole), 1e-2) << function;
        EXPECT_LT(rmse(shader, planes), 0.1 * rmse(planes, whole)) << function;
    }
}

// Nothing of what is cut away is asked for.
TEST_F(Cuts, WhatIsCutAwayIsNeitherReadNorDrawn)
{
    const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    ASSERT_TRUE(voxels->setBrickSize({7, 7, 7}));
    const auto counters = [&](const std::vector<CutRegion>& regions) {
        const osg::ref_ptr<A> volume = volumeOf(regions);
        volume->setVoxels(voxels);
        voxels->dirty();
        const std::uint64_t before = voxels->getReadCount();
        support::SceneRenderer renderer(volume, support::joining(view(), false));
        renderer.render();
        return std::make_pair(renderer.counters()["osgVolumizer bricks drawn"],
                              voxels->getReadCount() - before);
    };
    const auto whole = counters({});
    const auto corner = counters({CutRegion::sphere({0, 0, 0}, 5.0)});
    const osg::ref_ptr<osg::Drawable> ball =
        new osg::ShapeDrawable(new osg::Sphere({2.5, 2.5, 2.5}, 2.0));
    const auto mesh = counters({CutRegion::surface(*ball)});
    EXPECT_EQ(whole.first, 64.0);
    EXPECT_EQ(corner.first, 1.0);
    EXPECT_LE(mesh.first, 8.0); // a grid's blocks are larger than that
    EXPECT_EQ(whole.second, 64u);
    EXPECT_EQ(corner.second, 1u);
    // Within a brick, cells are leapt over.
    const auto samples = [](const std::vector<CutRegion>& regions) {
        const osg::ref_ptr<Voxels> fine = makeVoxels(glm::ivec3(65), bumps);
        const osg::ref_ptr<A> volume = volumeOf(regions);
        volume->setVoxels(fine);
        volume->removeChildren(0, 1);
        volume->addChild(VolumeGeometry::createBox(*fine));
        const FloatImage picture = support::renderScene(
            volume,
            support::countingSamples(view().lookAt({150, -100, 120}, {32, 32, 32}, {0, 0, 1})));
        double sum = 0.0;
        for (int y = 0; y < picture.height; ++y)
            for (int x = 0; x < picture.width; ++x)
                sum += picture.at(x, y)[0];
        return sum;
    };
    EXPECT_LT(samples({CutRegion::sphere({10, 10, 10}, 6.0)}),
              0.05 * samples({CutRegion::sphere({32, 32, 32}, 100.0)}));
}

// A cut is of the voxels as they lie by themselves: it moves, turns and bends with them.
TEST_F(Cuts, MovesAndBendsWithTheVolume)
{
    const osg::ref_ptr<A> volume = volumeOf({CutRegion::sphere(MIDDLE, 5.0)}, 0.25, A::SLICES);
    // Of twice the size along x, by voxel coordinates of the vertices; one vertex is moved by
    // nothing that counts, so that the map is no affine one.
    core::TetraSet set = *VolumeGeometry::createBox(*volume->getVoxels())->getTetraSet();
    core::TetraSet bent;
    bent.indices = set.indices;
    bent.vertices = core::VertexArray(core::VertexFormat::user(3, 0, 0));
    bent.vertices.resize(set.vertices.size());
    for (std::size_t i = 0; i < set.vertices.size(); ++i) {
        const glm::dvec3 p = set.vertices.position(i);
        double* record = bent.vertices.record(i);
        for (int k = 0; k < 3; ++k)
            record[bent.vertices.format().voxelCoordinateOffset() + k] = p[k];
        bent.vertices.setPosition(i, glm::dvec3(2.0 * p.x + (i == 0 ? 1e-5 : 0.0), p.y, p.z));
    }
    osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    ASSERT_TRUE(geometry->setTetraSet(bent));
    const auto render = [&](VolumeGeometry* g, const RenderOptions& options) {
        volume->removeChildren(0, 1);
        volume->addChild(g);
        return support::renderScene(volume, options);
    };
    RenderOptions look = RenderOptions().size(100, 60).perspective(40.0).lookAt(
        {24, -60, 12}, {24, 12, 12}, {0, 0, 1});
    const FloatImage cut = render(geometry, look);
    support::savePicture(cut, "cut_bent");
    // An ellipse of half-axes 10 and 5 about the middle, which is not black.
    const auto covered = [&cut](int x, int y) { return cut.at(x, y)[3] > 0.05f; };
    int width = 0, height = 0;
    for (int x = 0; x < cut.width; ++x)
        width += covered(x, cut.height / 2);
    for (int y = 0; y < cut.height; ++y)
        height += covered(cut.width / 2, y);
    EXPECT_NEAR(double(width) / height, 2.0, 0.25);
    // The same by planes: eight and more are put into the grid where the volume is deformed.
    volume->getCut()->clear();
    EXPECT_TRUE(volume->getCut()->addRegion(CutRegion::box({5, 5, 5, 19, 19, 19})));
    EXPECT_TRUE(volume->getCut()->addRegion(CutRegion::box({4, 4, 4, 20, 20, 20})));
    const FloatImage boxes = render(geometry, look);
    EXPECT_GT(support::coveredPixels(boxes, 0.05f).count(), 100u);
}

// Far away, and small, it is the same.
TEST_F(Cuts, HoldsFarFromTheOrigin)
{
    const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    const osg::Vec3d origin(6.4e6, -3.2e6, 1.6e6);
    const osg::ref_ptr<A> near =
        volumeOf({CutRegion::surface(*sphereOfTriangles()),
                  CutRegion::sphere(MIDDLE - osg::Vec3d(5, 0, 0), RADIUS)});
    const FloatImage expected = support::renderScene(near, view());
    ASSERT_TRUE(voxels->setOrigin(origin));
    const osg::ref_ptr<A> far = volumeOf({});
    far->setVoxels(voxels);
    far->removeChildren(0, 1);
    far->addChild(VolumeGeometry::createBox(*voxels));
    far->setCut(new VolumeCut);
    core::TriangleMesh mesh = *CutRegion::surface(*sphereOfTriangles()).getMesh();
    for (glm::dvec3& v : mesh.vertices)
        v += glm::dvec3(origin.x(), origin.y(), origin.z());
    ASSERT_TRUE(far->getCut()->addRegion(CutRegion::surface(mesh)));
    ASSERT_TRUE(
        far->getCut()->addRegion(CutRegion::sphere(origin + MIDDLE - osg::Vec3d(5, 0, 0), RADIUS)));
    const FloatImage there =
        support::renderScene(far, view().lookAt(origin + osg::Vec3d(55, -40, 45),
                                                origin + osg::Vec3d(12, 12, 12), {0, 0, 1}));
    EXPECT_LT(rmse(there, expected), 1e-4);
}

// Slices on the surfaces of a cut, in what it leaves.
TEST_F(Cuts, CapsShowWhatIsCut)
{
    const auto capped = [](const std::vector<CutRegion>& regions) {
        const osg::ref_ptr<A> volume = volumeOf(regions);
        volume->addChild(createCaps(*volume->getCut()));
        return volume;
    };
    // Seen across a half-space's plane all is its cap.
    const RenderOptions across = view({12, -60, 12}).lookAt({12, -60, 12}, {12, 12, 12}, {0, 0, 1});
    const FloatImage half =
        support::renderScene(capped({CutRegion::halfSpace({0, 1, 0, -11.7})}), across);
    osg::ref_ptr<A> alone = volumeOf({});
    alone->removeChildren(0, 1);
    osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
    ASSERT_TRUE(slice->setPlane(osg::Vec4d(0, 1, 0, -11.7)));
    alone->addChild(slice);
    const FloatImage plane = support::renderScene(alone, across);
    EXPECT_GT(support::coveredPixels(plane, 0.99f).count(), 250u);
    EXPECT_LT(
        support::compare(half, plane, support::eroded(support::coveredPixels(plane, 0.99f), 1))
            .maximum,
        1e-4);
    // Of a corner that is taken out, three faces; of a ball, its inner side; of both what is left.
    const CutRegion corner = CutRegion::box({12, -1, 12, 25, 12, 25}).complement();
    const CutRegion ball = CutRegion::sphere(MIDDLE, RADIUS);
    const CutRegion mesh = CutRegion::surface(*sphereOfTriangles());
    const std::vector<std::pair<const char*, std::vector<CutRegion>>> all = {
        {"corner", {corner}}, {"ball", {ball}}, {"both", {corner, ball}}, {"mesh", {corner, mesh}}};
    for (const auto& cut : all) {
        const FloatImage picture = support::renderScene(capped(cut.second), view());
        support::savePicture(picture, std::string("caps_") + cut.first);
        const FloatImage open = support::renderScene(volumeOf(cut.second), view());
        // Opaque where there is a cap, and nothing beyond what the cut leaves.
        EXPECT_GT(support::coveredPixels(picture, 0.999f).count(), 200u) << cut.first;
        EXPECT_LT(support::coveredPixels(picture, 0.01f).count(),
                  support::coveredPixels(open, 0.001f).count() + 200u)
            << cut.first;
    }
}

// A volume of one voxel, and many boxes and surfaces, are cut like any other.
TEST_F(Cuts, HoldsInExtremes)
{
    const osg::ref_ptr<Voxels> one =
        makeVoxels(glm::ivec3(1), [](const glm::dvec3&) { return 1.0; });
    const osg::ref_ptr<A> tiny = makeVolume(one);
    tiny->addChild(VolumeGeometry::createBox({-3, -3, -3, 3, 3, 3}));
    tiny->setCut(new VolumeCut);
    ASSERT_TRUE(tiny->getCut()->addRegion(CutRegion::mask(sphereMask(false), 0.0)));
    support::renderScene(tiny, view());
    std::vector<CutRegion> many;
    for (int i = 0; i < 40; ++i) {
        const double d = 0.01 * i;
        many.push_back(CutRegion::box({4 - d, 4 - d, 4 - d, 20 + d, 20 + d, 20 + d}));
        many.push_back(CutRegion::sphere(MIDDLE, RADIUS + d));
    }
    const FloatImage picture = support::renderScene(volumeOf(many), view());
    const FloatImage expected = support::renderScene(volumeOf({many[0], many[1]}), view());
    EXPECT_LT(rmse(picture, expected), 2e-3);
    EXPECT_GT(support::coveredPixels(picture, 0.1f).count(), 100u);
    // What is made for one state is made once, for any number of volumes.
    const osg::ref_ptr<VolumeCut> cut = volumeOf(many)->getCut();
    std::vector<std::shared_ptr<const core::Cut>> made;
    for (int round = 0; round < 2; ++round)
        for (int i = 0; i < 10; ++i)
            made.push_back(cut->cutOf({glm::dvec3(0.0), glm::dvec3(10.0 + i)}));
    for (int i = 0; i < 10; ++i)
        EXPECT_EQ(made[std::size_t(i)], made[std::size_t(i) + 10]);
    const osg::ref_ptr<VolumeCut> copy = osg::clone(cut.get(), osg::CopyOp::DEEP_COPY_ALL);
    EXPECT_EQ(copy->getNumRegions(), cut->getNumRegions());
}

TEST_F(Cuts, BadRegionsChangeNothing)
{
    const support::Reports reports;
    const osg::ref_ptr<VolumeCut> cut = new VolumeCut;
    const double infinite = std::numeric_limits<double>::infinity();
    core::TriangleMesh mesh = *CutRegion::surface(*sphereOfTriangles()).getMesh();
    EXPECT_TRUE(core::checkClosed(mesh).ok());
    mesh.indices.resize(mesh.indices.size() - 3);
    for (const CutRegion& region :
         {CutRegion::halfSpace({0, 0, 0, 1}), CutRegion::halfSpace({NAN, 0, 1, 1}),
          CutRegion::box({1, 1, 1, 1, 2, 2}), CutRegion::box({0, 0, 0, infinite, 1, 1}),
          CutRegion::sphere({0, 0, 0}, 0.0), CutRegion::sphere({0, 0, 0}, -1.0),
          CutRegion::sphere({NAN, 0, 0}, 1.0), CutRegion::surface(mesh),
          CutRegion::surface(core::TriangleMesh()), CutRegion::mask(nullptr, 0.5),
          CutRegion::mask(sphereMask(true), 4.0, 3.0)}) {
        EXPECT_FALSE(cut->addRegion(region));
        EXPECT_EQ(cut->getNumRegions(), 0u);
    }
    EXPECT_FALSE(cut->setSoftness(-1.0));
    EXPECT_FALSE(cut->setResolution(3));
    EXPECT_FALSE(cut->setRegion(0, CutRegion::sphere({0, 0, 0}, 1.0)));
    EXPECT_FALSE(cut->removeRegion(0));
    EXPECT_EQ(cut->getModifiedCount(), 0u);
}

} // namespace CutRenderTest
