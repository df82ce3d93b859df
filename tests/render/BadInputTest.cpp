// Incomplete and refused volumes: an error where something is wrong, and the rest of the scene is
// shown.

#include "Volumes.h"

#include <osgVolumizer/Error.h>

#include <support/GLTest.h>
#include <support/Shapes.h>

#include <osg/MatrixTransform>

#include <limits>

namespace BadInputTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

RenderOptions view()
{
    return RenderOptions().size(64, 64).perspective(45.0).lookAt({24, -14, 20}, {6, 6, 6},
                                                                 {0, 0, 1});
}

// A source that fails for one brick, or for all.
class FailingSource : public VoxelSource
{
public:
    META_Object(osgVolumizer, FailingSource)

        FailingSource() = default;
    FailingSource(const FailingSource& o, const osg::CopyOp& op) : VoxelSource(o, op) {}

    Description describe() const override
    {
        Description d;
        d.size = glm::ivec3(13);
        d.type = VoxelType::UINT8;
        return d;
    }
    Status read(const core::Box3i& region, void* destination) const override
    {
        if (region.min == glm::ivec3(0))
            return Status(ErrorCode::FILE_UNREADABLE, "test: the first brick cannot be read.");
        std::fill_n(static_cast<unsigned char*>(destination),
                    std::size_t(region.size().x) * region.size().y * region.size().z, 200);
        return {};
    }
};

class BadInput : public support::GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        _voxels = makeVoxels(glm::ivec3(13), bumps);
        _quad = support::makeQuad({osg::Vec3(-4, 14, -4), {16, 14, -4}, {16, 14, 16}, {-4, 14, 16}},
                                  {0.2f, 0.7f, 0.3f, 1.0f});
        _alone = support::renderScene(_quad, view());
        ASSERT_GT(support::coveredPixels(_alone).count(), 500u);
        clearLastError();
    }

    // Expects the picture of the quad alone, and no GL error, over two frames.
    void expectNothingBeside(osg::Node* node)
    {
        osg::ref_ptr<osg::Group> scene = new osg::Group;
        scene->addChild(node);
        scene->addChild(_quad);
        RenderOptions options = view();
        options.frames = 2;
        support::SceneRenderer renderer(scene, options);
        EXPECT_EQ(compare(renderer.render(), _alone).maximum, 0.0);
        EXPECT_EQ(renderer.glError(), 0u);
    }

    osg::ref_ptr<Voxels> _voxels;
    osg::ref_ptr<osg::Geometry> _quad;
    FloatImage _alone;
};

core::TetraSet oneTetrahedron()
{
    core::TetraSet set;
    set.vertices.resize(4);
    set.vertices.setPosition(1, {12, 0, 0});
    set.vertices.setPosition(2, {0, 12, 0});
    set.vertices.setPosition(3, {0, 0, 12});
    set.indices = {0, 1, 2, 3};
    return set;
}

TEST_F(BadInput, AppearanceWithoutVoxels)
{
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(_voxels);
    volume->setVoxels(nullptr);
    expectNothingBeside(volume);
    volume->setVoxels(new Voxels); // without a source
    expectNothingBeside(volume);
}

TEST_F(BadInput, GeometryWithoutAppearance)
{
    expectNothingBeside(VolumeGeometry::createBox(*_voxels));
}

TEST_F(BadInput, AppearanceWithoutGeometry)
{
    osg::ref_ptr<VolumeAppearance> volume = new VolumeAppearance;
    volume->setVoxels(_voxels);
    expectNothingBeside(volume);
}

TEST_F(BadInput, EmptyAndDegenerateTetraSets)
{
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(_voxels);
    osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    volume->setChild(0, geometry);
    for (const auto technique :
         {VolumeAppearance::AUTOMATIC, VolumeAppearance::SLABS, VolumeAppearance::SLICES}) {
        volume->setTechnique(technique);
        EXPECT_TRUE(geometry->setTetraSet(core::TetraSet()));
        expectNothingBeside(volume);
        // All in one point, in one line, in one plane: no volume.
        for (int dimensions = 0; dimensions < 3; ++dimensions) {
            core::TetraSet flat = oneTetrahedron();
            for (std::size_t i = 0; i < 4; ++i) {
                glm::dvec3 p = flat.vertices.position(i) + 1.0;
                for (int axis = dimensions; axis < 3; ++axis)
                    p[axis] = 3.0;
                flat.vertices.setPosition(i, p);
            }
            EXPECT_TRUE(geometry->setTetraSet(flat));
            expectNothingBeside(volume);
        }
        // Outside the voxels.
        core::TetraSet away = oneTetrahedron();
        for (std::size_t i = 0; i < 4; ++i)
            away.vertices.setPosition(i, away.vertices.position(i) + glm::dvec3(-12.5, -40, 0));
        EXPECT_TRUE(geometry->setTetraSet(away));
        expectNothingBeside(volume);
    }
}

TEST_F(BadInput, RefusedSetsLeaveTheOldOne)
{
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(_voxels);
    auto* geometry = static_cast<VolumeGeometry*>(volume->getChild(0));
    const FloatImage expected = support::renderScene(volume, view());
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        core::TetraSet set = oneTetrahedron();
        set.vertices.setPosition(2, {1, bad, 1});
        const Status status = geometry->setTetraSet(set);
        EXPECT_FALSE(status);
        EXPECT_EQ(status.index, 2);
        EXPECT_EQ(getLastError().text, status.text);
    }
    core::TetraSet set = oneTetrahedron();
    set.indices[3] = 4;
    EXPECT_FALSE(geometry->setTetraSet(set));
    set.indices.resize(3);
    EXPECT_FALSE(geometry->setTetraSet(set));
    EXPECT_EQ(compare(support::renderScene(volume, view()), expected).maximum, 0.0);
}

TEST_F(BadInput, ABrickThatFailsIsLeftOut)
{
    osg::ref_ptr<Voxels> voxels = new Voxels(new FailingSource);
    ASSERT_TRUE(voxels->setBrickSize({7, 7, 7}));
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
    volume->setLookupTable(makeTable(smoothPoints(0.2)));
    RenderOptions options = view();
    options.frames = 3;
    support::SceneRenderer renderer(volume, options);
    const FloatImage image = renderer.render();
    EXPECT_EQ(renderer.glError(), 0u);
    EXPECT_NE(getLastError().text.find("first brick"), std::string::npos);
    EXPECT_EQ(renderer.counters().at("osgVolumizer bricks drawn"), 7.0);
    EXPECT_GT(support::coveredPixels(image, 0.2f).count(), 500u);

    // All bricks fail.
    ASSERT_TRUE(voxels->setBrickSize({13, 13, 13}));
    expectNothingBeside(volume);
}

TEST_F(BadInput, SingularAndNonFiniteTransforms)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto technique : {VolumeAppearance::SLABS, VolumeAppearance::SLICES}) {
        osg::ref_ptr<VolumeAppearance> volume = makeVolume(_voxels);
        volume->setTechnique(technique);
        for (const osg::Matrixd& matrix :
             {osg::Matrixd::scale(1, 1, 0), osg::Matrixd::scale(0, 0, 0),
              osg::Matrixd::translate(nan, 0, 0)}) {
            osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(matrix);
            transform->addChild(volume);
            transform->setCullingActive(false);
            expectNothingBeside(transform);
        }
    }
}

TEST_F(BadInput, ExtremeSampling)
{
    // Absurd periods are bounded by the maximum of samples; a volume of one layer is still drawn.
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(_voxels);
    volume->setLookupTable(makeTable(constantPoints({1.0, 0.5, 0.2, 0.1})));
    for (const auto technique : {VolumeAppearance::SLABS, VolumeAppearance::SLICES}) {
        volume->setTechnique(technique);
        for (const double period : {1e-12, 1e12}) {
            ASSERT_TRUE(volume->setSamplingPeriod(osg::Vec3d(period, period, period)));
            support::SceneRenderer renderer(volume, view());
            const FloatImage image = renderer.render();
            EXPECT_EQ(renderer.glError(), 0u);
            EXPECT_GT(support::coveredPixels(image, 0.05f).count(), 300u);
            for (const glm::vec4& p : image.pixels)
                ASSERT_TRUE(p.a >= 0.0f && p.a <= 1.0f);
        }
    }
}

TEST_F(BadInput, StrangeTables)
{
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(_voxels);
    const glm::dvec4 red(1, 0, 0, 0.1), white(1, 1, 1, 1.0), nothing(0.0);
    const Points tables[] = {{{0.5, red}},                               // a single entry
                             {{-7.0, red}},                              // outside of the range
                             {{0.5, nothing}, {0.5, white}, {0.5, red}}, // nothing but a jump
                             {{0.0, white}, {1.0, white}},               // opaque
                             {{0.4, nothing}, {0.4 + 1e-12, white}, {1.0, white}}};
    for (const auto lookup :
         {VolumeAppearance::AFTER_INTERPOLATION, VolumeAppearance::BEFORE_INTERPOLATION,
          VolumeAppearance::PREINTEGRATED, VolumeAppearance::AUTOMATIC_LOOKUP}) {
        volume->setLookup(lookup);
        for (const Points& points : tables) {
            volume->setLookupTable(makeTable(points));
            support::SceneRenderer renderer(volume, view());
            const FloatImage image = renderer.render();
            EXPECT_EQ(renderer.glError(), 0u);
            for (const glm::vec4& p : image.pixels)
                for (int c = 0; c < 4; ++c)
                    ASSERT_TRUE(p[c] >= 0.0f && p[c] <= 1.00001f);
        }
    }
    // What has no meaning is refused, and the table before it still drawn.
    const FloatImage before = support::renderScene(volume, view());
    LookupTable& table = *volume->getLookupTable();
    const Points refused[] = {{{0.0, glm::dvec4(0, 0, 0, NAN)}, {1.0, red}},
                              {{0.0, glm::dvec4(0, 0, 0, -0.1)}, {1.0, red}},
                              {{0.0, glm::dvec4(0, 0, 0, 1.1)}, {1.0, red}},
                              {{NAN, red}, {1.0, red}},
                              {{1.0, red}, {0.0, nothing}}};
    for (const Points& points : refused) {
        const Status status = table.setPoints(points, LookupTable::RANGE_FRACTION);
        EXPECT_EQ(status.code, ErrorCode::VALUE_INVALID) << status.text;
    }
    EXPECT_EQ(compare(support::renderScene(volume, view()), before).maximum, 0.0);
}

TEST_F(BadInput, TinyVolumes)
{
    // One sample along an axis is a layer; two have one cell.
    for (const glm::ivec3& size : {glm::ivec3(1), glm::ivec3(5, 5, 1), glm::ivec3(2)}) {
        osg::ref_ptr<Voxels> voxels = makeVoxels(size, [](const glm::dvec3&) { return 1.0; });
        osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
        volume->setLookupTable(makeTable(constantPoints({1.0, 0.5, 0.2, 0.9})));
        RenderOptions options = view();
        options.perspective(5.0).lookAt({24, -14, 20}, {0.5, 0.5, 0.5}, {0, 0, 1});
        support::SceneRenderer renderer(volume, options);
        const FloatImage image = renderer.render();
        EXPECT_EQ(renderer.glError(), 0u);
        EXPECT_GT(support::coveredPixels(image, 0.3f).count(), 200u);
    }
}

} // namespace

} // namespace BadInputTest
