// Voxels that are sculpted while they are drawn: what is uploaded, and that pictures are those of
// the same samples anew.

#include "PagedScene.h"
#include "Volumes.h"

#include <osgVolumizer/core/voxels/VoxelData.h>
#include <osgVolumizer/interact/Sculpt.h>

#include <support/GLTest.h>

#include <algorithm>
#include <atomic>

namespace SculptingTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;
using A = VolumeAppearance;
using Operation = Sculptor::Operation;

namespace {

constexpr int SIZE = 41, BRICK = 13;

RenderOptions view()
{
    return RenderOptions().size(80, 72).perspective(45.0).lookAt({72, -43, 60}, {20, 20, 20},
                                                                 {0, 0, 1});
}

double counter(const support::SceneRenderer& renderer, const std::string& name)
{
    const auto counters = renderer.counters();
    const auto found = counters.find("osgVolumizer " + name);
    return found == counters.end() ? 0.0 : found->second;
}

Sculptor::Tool makeTool(Operation operation, double radius, double strength = 1.0)
{
    Sculptor::Tool tool;
    tool.operation = operation;
    tool.radius = osg::Vec3d(radius, radius, radius);
    tool.strength = strength;
    return tool;
}

// The samples of other voxels in memory of their own, cut into the same bricks.
osg::ref_ptr<Voxels> anew(const Voxels& voxels)
{
    osg::ref_ptr<MemoryVoxelSource> copy = new MemoryVoxelSource;
    copy->allocate(voxels.getSource()->describe());
    const glm::ivec3 size = copy->describe().size;
    EXPECT_TRUE(voxels.getSource()->read({glm::ivec3(0), size}, copy->data()).ok());
    osg::ref_ptr<Voxels> fresh = new Voxels(copy);
    fresh->setRange(voxels.getRange());
    fresh->setOverlap(voxels.getOverlap());
    fresh->setBrickSize(voxels.getBrickSize());
    return fresh;
}

struct Way
{
    const char* name;
    A::Technique technique = A::SLABS;
    A::Interpolation interpolation = A::LINEAR;
    A::RayFunction function = A::COMPOSITE;
    bool shading = false;
    A::Gradients gradients = A::ON_THE_FLY;
    bool joining = true;
    int brick = BRICK;
    VoxelType type = VoxelType::FLOAT32;
    int components = 1;
    bool full = false; ///< something shows in every brick: they are joined all the time
};

const Way WAYS[] = {
    {"joined"},
    {"full_joined", A::SLABS, A::LINEAR, A::COMPOSITE, false, A::ON_THE_FLY, true, BRICK,
     VoxelType::FLOAT32, 1, true},
    {"full_cubic", A::SLABS, A::CUBIC, A::COMPOSITE, false, A::ON_THE_FLY, true, BRICK,
     VoxelType::FLOAT32, 1, true},
    {"full_gradients", A::SLABS, A::LINEAR, A::COMPOSITE, true, A::PRECOMPUTED, true, BRICK,
     VoxelType::FLOAT32, 1, true},
    {"full_gradients_of_bytes", A::SLABS, A::LINEAR, A::COMPOSITE, true, A::PRECOMPUTED, true,
     BRICK, VoxelType::UINT8, 1, true},
    {"full_isosurface", A::SLABS, A::LINEAR, A::ISOSURFACE, true, A::PRECOMPUTED, true, BRICK,
     VoxelType::FLOAT32, 1, true},
    {"apart", A::SLABS, A::LINEAR, A::COMPOSITE, false, A::ON_THE_FLY, false},
    {"slices", A::SLICES},
    {"one_brick", A::SLABS, A::LINEAR, A::COMPOSITE, false, A::ON_THE_FLY, true, SIZE},
    {"cubic", A::SLABS, A::CUBIC},
    {"nearest", A::SLABS, A::NEAREST, A::COMPOSITE, false, A::ON_THE_FLY, false},
    {"shaded", A::SLABS, A::LINEAR, A::COMPOSITE, true},
    {"gradients_joined", A::SLABS, A::LINEAR, A::COMPOSITE, true, A::PRECOMPUTED},
    {"gradients_apart", A::SLABS, A::LINEAR, A::COMPOSITE, true, A::PRECOMPUTED, false},
    {"gradients_of_bytes", A::SLABS, A::LINEAR, A::COMPOSITE, true, A::PRECOMPUTED, true, BRICK,
     VoxelType::UINT8},
    {"isosurface", A::SLABS, A::LINEAR, A::ISOSURFACE, true, A::PRECOMPUTED},
    {"maximum", A::SLABS, A::LINEAR, A::MAXIMUM},
    {"average", A::SLABS, A::LINEAR, A::AVERAGE},
    {"bytes", A::SLABS, A::LINEAR, A::COMPOSITE, false, A::ON_THE_FLY, false, BRICK,
     VoxelType::UINT8},
    {"signed", A::SLICES, A::LINEAR, A::COMPOSITE, false, A::ON_THE_FLY, true, BRICK,
     VoxelType::INT16},
    {"doubles", A::SLABS, A::LINEAR, A::COMPOSITE, false, A::ON_THE_FLY, true, BRICK,
     VoxelType::FLOAT64},
    {"colours", A::SLABS, A::LINEAR, A::COMPOSITE, false, A::ON_THE_FLY, true, BRICK,
     VoxelType::UINT8, 4}};

osg::ref_ptr<VolumeAppearance> makeAppearance(Voxels* voxels, const Way& way)
{
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
    volume->setTechnique(way.technique);
    volume->setLookupTable(makeTable(
        {{0.0, {0.1, 0.3, 0.9, 0.0}}, {0.3, {0.2, 0.8, 1, 0.0}}, {1.0, {1, 0.4, 0, 0.4}}}));
    if (way.function == A::AVERAGE || way.full)
        volume->setLookupTable(makeTable(smoothPoints(0.3)));
    volume->setInterpolation(way.interpolation);
    volume->setRayFunction(way.function);
    volume->setShading(way.shading);
    volume->setGradients(way.gradients);
    const osg::Vec2d range = voxels->getRange();
    volume->setIsoValue(range.x() + 0.5 * (range.y() - range.x()));
    return volume;
}

// A blob beside the middle, which leaves bricks empty.
osg::ref_ptr<Voxels> makeBlobOf(const Way& way)
{
    VoxelSource::Description d;
    d.size = glm::ivec3(SIZE);
    d.type = way.type;
    d.components = way.components;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    source->allocate(d);
    double low = 0.0, high = 1.0;
    voxelTypeRange(d.type, low, high);
    std::vector<double> values;
    const oracle::GaussianField field(glm::dvec3(16, 20, 24), 6.0);
    for (int z = 0; z < SIZE; ++z)
        for (int y = 0; y < SIZE; ++y)
            for (int x = 0; x < SIZE; ++x)
                for (int c = 0; c < d.components; ++c) {
                    const glm::dvec3 p(x, y, z);
                    const double v = way.full ? 0.1 + 0.8 * bumps(p) : field.value(p);
                    values.push_back(low +
                                     (high - low) * (c == 3 ? 0.2 * v : std::clamp(v, 0.0, 1.0)));
                }
    core::convertVoxels(values.data(), VoxelType::FLOAT64, source->data(), d.type, values.size());
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    voxels->setRange(osg::Vec2d(low, high));
    voxels->setBrickSize({way.brick, way.brick, way.brick});
    return voxels;
}

} // namespace

class SculptingWays : public support::GLTest, public ::testing::WithParamInterface<Way>
{
};

TEST_P(SculptingWays, PicturesAreThoseOfTheSameSamplesAnew)
{
    const Way& way = GetParam();
    const osg::ref_ptr<Voxels> voxels = makeBlobOf(way);
    const osg::ref_ptr<VolumeAppearance> volume = makeAppearance(voxels, way);
    const RenderOptions options = support::joining(view(), way.joining);
    support::SceneRenderer renderer(volume, options);
    const FloatImage before = renderer.render();
    Sculptor sculptor(voxels);
    const std::string name = std::string("sculpted_") + way.name;
    FloatImage last = before;
    int likeFrames = 0;
    const auto compareWithAnew = [&](const std::string& what) {
        const FloatImage now = renderer.render();
        const osg::ref_ptr<Voxels> fresh = anew(*voxels);
        support::SceneRenderer other(makeAppearance(fresh, way), options);
        const support::Difference d = compare(now, other.render());
        // Bricks that were drawn in one texture are not taken apart as soon as others are joined.
        const bool alike = counter(renderer, "draw calls") == counter(other, "draw calls");
        EXPECT_TRUE(alike || way.joining) << what;
        EXPECT_LE(d.maximum, alike ? 1e-6 : 1e-4) << what << " at " << d.worstX << " " << d.worstY;
        if (alike) {
            EXPECT_EQ(counter(renderer, "cells occupied"), counter(other, "cells occupied"))
                << what;
        }
        likeFrames += alike;
        EXPECT_EQ(counter(renderer, "bricks drawn"), counter(other, "bricks drawn")) << what;
        EXPECT_GT(compare(now, last).maximum, 1e-3) << what;
        EXPECT_EQ(renderer.glError(), 0u);
        last = now;
    };
    // Into bricks that were empty, across their borders, out of what was there, and all of it.
    const bool thin = way.components == 4;
    ASSERT_TRUE(sculptor.setTool(makeTool(Operation::MAX_ADD, 6.0, thin ? 0.3 : 1.0)).ok());
    ASSERT_TRUE(sculptor.stroke({{6, 6, 12}, {34, 10, 30}, {36, 36, 34}}).ok());
    compareWithAnew("added");
    support::savePicture(last, name);
    const FloatImage added = last;
    ASSERT_TRUE(sculptor.setTool(makeTool(Operation::ERASE, 7.0)).ok());
    ASSERT_TRUE(sculptor.stroke({{16, 20, 24}, {30, 4, 20}}).ok());
    compareWithAnew("erased");
    ASSERT_TRUE(sculptor.undo().ok());
    compareWithAnew("undone");
    EXPECT_LE(compare(last, added).maximum, 1e-6);
    ASSERT_TRUE(sculptor.undo().ok());
    compareWithAnew("all undone");
    EXPECT_LE(compare(last, before).maximum, way.joining ? 1e-4 : 1e-6);
    ASSERT_TRUE(sculptor.redo().ok());
    compareWithAnew("done again");
    EXPECT_LE(compare(last, added).maximum, 1e-6);
    EXPECT_GE(likeFrames, way.joining && !way.full ? 0 : 5);
}

INSTANTIATE_TEST_SUITE_P(All, SculptingWays, ::testing::ValuesIn(WAYS),
                         [](const auto& way) { return std::string(way.param.name); });

using Sculpting = support::GLTest;

namespace {

// 512^3 bytes that are computed, of which it knows the range.
class ComputedSource : public VoxelSource
{
public:
    META_Object(osgVolumizer, ComputedSource);
    ComputedSource() = default;
    ComputedSource(const ComputedSource& o, const osg::CopyOp& op) : VoxelSource(o, op) {}

    static unsigned char at(const glm::ivec3& p)
    {
        return static_cast<unsigned char>(60 + (p.x / 3 + p.y / 5 + p.z / 7) % 40);
    }
    Description describe() const override
    {
        Description d;
        d.size = glm::ivec3(512);
        return d;
    }
    Status read(const core::Box3i& region, void* destination) const override
    {
        samples += core::sampleCount(region.size());
        auto* out = static_cast<unsigned char*>(destination);
        for (int z = region.min.z; z < region.max.z; ++z)
            for (int y = region.min.y; y < region.max.y; ++y)
                for (int x = region.min.x; x < region.max.x; ++x)
                    *out++ = at({x, y, z});
        return {};
    }
    std::optional<std::pair<double, double>> valueRange(const core::Box3i&) const override
    {
        return std::make_pair(60.0, 99.0);
    }
    mutable std::atomic<std::int64_t> samples{0};

protected:
    ~ComputedSource() override = default;
};

// Samples that are not what the source computes.
std::int64_t changedSamples(const VoxelSource& source, const core::Box3i& box)
{
    std::vector<unsigned char> bytes(std::size_t(core::sampleCount(box.size())));
    EXPECT_TRUE(source.read(box, bytes.data()).ok());
    std::int64_t count = 0;
    const unsigned char* now = bytes.data();
    for (int z = box.min.z; z < box.max.z; ++z)
        for (int y = box.min.y; y < box.max.y; ++y)
            for (int x = box.min.x; x < box.max.x; ++x)
                count += *now++ != ComputedSource::at({x, y, z});
    return count;
}

} // namespace

class SculptingLarge : public support::GLTest,
                       public ::testing::WithParamInterface<VolumeAppearance::Technique>
{
};

// A stroke of 100 dabs in 512^3: all at once, then dab by dab with a frame each.
TEST_P(SculptingLarge, UploadsLittleMoreThanWhatChanged)
{
    osg::ref_ptr<ComputedSource> source = new ComputedSource;
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    ASSERT_TRUE(voxels->setBrickSize({128, 128, 128}).ok());
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
    volume->setTechnique(GetParam());
    volume->setLookupTable(makeTable(smoothPoints(0.2)));
    // A narrow view of a few bricks, whose textures only are made.
    RenderOptions options = RenderOptions().size(48, 48).perspective(5.0).lookAt(
        {250, -900, 250}, {250, 60, 250}, {0, 0, 1});
    support::SceneRenderer renderer(volume, support::joining(options, false));
    volume->removeChildren(0, volume->getNumChildren());
    volume->addChild(VolumeGeometry::createBox(osg::BoundingBoxd(200, 20, 200, 300, 110, 300)));
    const FloatImage before = renderer.render();
    ASSERT_GT(support::coveredPixels(before, 0.2f).count(), 500u);
    const double bricks = counter(renderer, "bricks drawn");
    EXPECT_EQ(bricks, 4);
    EXPECT_EQ(counter(renderer, "voxels uploaded"), bricks * 128 * 128 * 128);

    Sculptor sculptor(voxels);
    Sculptor::Tool tool = makeTool(Operation::MAX_ADD, 10.0);
    ASSERT_TRUE(sculptor.setTool(tool).ok());
    source->samples = 0;
    // 99 spacings of a quarter of the radius, through all four bricks, and within them.
    const double side = std::sqrt(0.5 * (247.5 * 247.5 - 25.0)) + 1e-9;
    const osg::Vec3d start(150.0, 50.0, 155.0), way(side, 5.0, side);
    const osg::Vec3d middle = start + way * 0.5, end = start + way;
    const auto dabs = sculptor.stroke({start, middle, end});
    ASSERT_TRUE(dabs.ok());
    EXPECT_EQ(*dabs, 100);
    const std::int64_t readForIt = source->samples;
    const FloatImage after = renderer.render();
    const std::int64_t readInAll = source->samples;
    const core::Box3i around{{135, 30, 135}, {345, 75, 350}};
    const std::int64_t changed = changedSamples(*voxels->getSource(), around);
    EXPECT_GT(changed, 30000);
    const double uploaded = counter(renderer, "voxels uploaded");
    RecordProperty("changed", std::to_string(changed));
    RecordProperty("uploaded", std::to_string(uploaded));
    EXPECT_GE(uploaded, double(changed));
    EXPECT_LT(uploaded, 1.5 * double(changed));
    EXPECT_EQ(counter(renderer, "bytes uploaded"), uploaded);
    EXPECT_GT(compare(after, before).maximum, 1e-2);
    // Blocks that the tool touched, and cells that changed: a small part of what is resident.
    EXPECT_LT(double(readForIt), 16.0 * double(changed));
    EXPECT_LT(double(readInAll), 0.25 * bricks * 128 * 128 * 128);
    RecordProperty("read", std::to_string(readInAll));
    renderer.render();
    EXPECT_EQ(counter(renderer, "voxels uploaded"), 0);

    ASSERT_TRUE(sculptor.undo().ok());
    EXPECT_EQ(changedSamples(*voxels->getSource(), around), 0);
    EXPECT_LE(compare(renderer.render(), before).maximum, 1e-6);
    EXPECT_LT(counter(renderer, "voxels uploaded"), 1.5 * double(changed));

    // Again with a frame after each dab.
    ASSERT_TRUE(sculptor.beginStroke(start).ok());
    double sum = 0.0, changes = 0.0;
    std::vector<unsigned char> was, is;
    for (int i = 1; i < 12; ++i) {
        const double f = i / 99.0;
        const core::Box3i near{{135, 35, 140}, {200, 70, 205}};
        was.resize(std::size_t(core::sampleCount(near.size())));
        is.resize(was.size());
        ASSERT_TRUE(voxels->getSource()->read(near, was.data()).ok());
        renderer.render();
        ASSERT_TRUE(sculptor.strokeTo(start + (end - start) * f).ok());
        ASSERT_TRUE(voxels->getSource()->read(near, is.data()).ok());
        renderer.render();
        for (std::size_t k = 0; k < was.size(); ++k)
            changes += was[k] != is[k];
        sum += counter(renderer, "voxels uploaded");
    }
    sculptor.endStroke();
    EXPECT_GT(changes, 1000.0);
    EXPECT_LT(sum, 1.5 * changes);
    EXPECT_GE(sum, changes);
    RecordProperty("dab by dab", std::to_string(sum / changes));
}

INSTANTIATE_TEST_SUITE_P(Both, SculptingLarge, ::testing::Values(A::SLABS, A::SLICES),
                         techniqueName);

TEST_F(Sculpting, OneTextureForAllBricksIsChangedInPart)
{
    Way way{"joined"};
    const osg::ref_ptr<Voxels> voxels =
        makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3& p) { return 0.4 + 0.5 * bumps(p); });
    ASSERT_TRUE(voxels->setBrickSize({BRICK, BRICK, BRICK}).ok());
    const osg::ref_ptr<VolumeAppearance> volume = makeAppearance(voxels, way);
    support::SceneRenderer renderer(volume, view());
    renderer.render();
    ASSERT_EQ(counter(renderer, "draw calls"), 1);
    Sculptor sculptor(voxels);
    ASSERT_TRUE(sculptor.setTool(makeTool(Operation::MIN_SUB, 5.0)).ok());
    ASSERT_TRUE(sculptor.stroke({{18, 18, 18}}).ok());
    renderer.render();
    EXPECT_EQ(counter(renderer, "draw calls"), 1);
    // A ball of 5 samples, and the samples that neighbours share with it.
    EXPECT_GT(counter(renderer, "voxels uploaded"), 100);
    EXPECT_LT(counter(renderer, "voxels uploaded"), 1.5 * 523);
    EXPECT_LE(counter(renderer, "bricks uploaded"), 8);
}

TEST_F(Sculpting, AnApplicationsOwnChangesAreUploadedInPart)
{
    const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    const osg::ref_ptr<VolumeAppearance> volume = makeAppearance(voxels, Way{"own"});
    support::SceneRenderer renderer(volume, view());
    renderer.render();
    auto* data = static_cast<float*>(dynamic_cast<MemoryVoxelSource*>(voxels->getSource())->data());
    const core::Box3i box{{30, 3, 20}, {40, 12, 37}};
    for (int z = box.min.z; z < box.max.z; ++z)
        for (int y = box.min.y; y < box.max.y; ++y)
            for (int x = box.min.x; x < box.max.x; ++x)
                data[x + SIZE * (y + SIZE * z)] = 1.0f;
    voxels->dirtyRegion({{30, 3, 20}, {40, 12, 60}}); // also beyond the volume
    const FloatImage now = renderer.render();
    EXPECT_EQ(counter(renderer, "voxels uploaded"), 10.0 * 9.0 * (SIZE - 20));
    const osg::ref_ptr<Voxels> fresh = anew(*voxels);
    EXPECT_LE(compare(now, support::renderScene(makeAppearance(fresh, Way{"own"}), view())).maximum,
              1e-6);
}

TEST_F(Sculpting, PagesThatAreTouchedAreReadAgain)
{
    const osg::ref_ptr<paged::FormulaSource> source = new paged::FormulaSource(64, paged::waves);
    const osg::ref_ptr<VolumeAppearance> volume = paged::volumeOf(source);
    Voxels& voxels = *volume->getVoxels();
    support::SceneRenderer renderer(volume, paged::viewOf(64, {120, -60, 90}));
    const FloatImage before = paged::settle(renderer);
    const double all = counter(renderer, "pages wanted");
    Sculptor sculptor(&voxels);
    ASSERT_TRUE(sculptor.setTool(makeTool(Operation::MAX_ADD, 7.0)).ok());
    ASSERT_TRUE(sculptor.stroke({{50, 10, 44}, {56, 20, 50}}).ok());
    double uploads = 0.0;
    FloatImage now = paged::renderUntil(renderer, [&](const FloatImage&) {
        uploads += counter(renderer, "bricks uploaded");
        return counter(renderer, "pages missing") == 0.0;
    });
    EXPECT_GT(uploads, 0);
    EXPECT_LT(uploads, 0.6 * all);
    EXPECT_GT(paged::largest(now, before), 1e-2);
    support::savePicture(now, "sculpted_pages");
    const osg::ref_ptr<VolumeAppearance> other = makeVolume(new Voxels(voxels));
    other->setLookupTable(volume->getLookupTable());
    support::SceneRenderer second(other, paged::viewOf(64, {120, -60, 90}));
    EXPECT_LE(paged::largest(now, paged::settle(second)), 1e-6);
    ASSERT_TRUE(sculptor.undo().ok());
    EXPECT_LE(paged::largest(paged::settle(renderer), before), 1e-6);
}

} // namespace SculptingTest
