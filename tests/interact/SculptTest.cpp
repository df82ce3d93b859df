// Strokes: what they do to the voxels, and that it can be undone, saved and picked.
#include "PickOracle.h"

#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/VoxelSeries.h>
#include <osgVolumizer/WritePyramid.h>
#include <osgVolumizer/WriteVoxels.h>
#include <osgVolumizer/interact/Sculpt.h>
#include <osgVolumizer/interact/private/SampleCache.h>

#include <support/FolderTest.h>

#include <cstdint>
#include <limits>

namespace SculptTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using Operation = Sculptor::Operation;

namespace {

const Operation OPERATIONS[] = {Operation::PERLIN_ADD, Operation::PERLIN_SUB, Operation::MAX_ADD,
                                Operation::MIN_SUB, Operation::ERASE};

// Bumps of a type that spans its range.
osg::ref_ptr<MemoryVoxelSource> makeBumps(const glm::ivec3& size, VoxelType type,
                                          int components = 1)
{
    VoxelSource::Description description;
    description.size = size;
    description.type = type;
    description.components = components;
    description.spacing = glm::dvec3(0.5, 1.0, 2.0);
    description.origin = glm::dvec3(10.0, -20.0, 30.0);
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    source->allocate(description);
    double low = 0.0, high = 1.0;
    voxelTypeRange(type, low, high);
    std::vector<double> values;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                for (int c = 0; c < components; ++c)
                    values.push_back(low + (high - low) * bumps({x + 7 * c, y, z}));
    core::convertVoxels(values.data(), VoxelType::FLOAT64, source->data(), type, values.size());
    return source;
}

std::vector<unsigned char> allOf(const VoxelSource& source, int level = 0)
{
    const VoxelSource::Description d = source.describe();
    const glm::ivec3 size = core::BrickTree::levelSize(d.size, level);
    std::vector<unsigned char> bytes(
        static_cast<std::size_t>(core::voxelBytes(size, d.type, d.components)));
    EXPECT_TRUE(source.readLevel(level, {glm::ivec3(0), size}, bytes.data()).ok());
    return bytes;
}

std::vector<unsigned char> allOf(const Voxels& voxels, int level = 0)
{
    return allOf(*voxels.getSource(), level);
}

Sculptor::Tool makeTool(Operation operation, double radius, double strength = 0.7)
{
    Sculptor::Tool tool;
    tool.operation = operation;
    tool.radius = osg::Vec3d(radius, radius, radius);
    tool.strength = strength;
    return tool;
}

// A voxel's place in the object frame of makeBumps().
osg::Vec3d at(double x, double y, double z)
{
    return {10.0 + 0.5 * x, -20.0 + y, 30.0 + 2.0 * z};
}

const std::vector<osg::Vec3d> PATH = {at(5, 6, 7), at(30, 20, 10), at(33, 36, 31)};

// As a source of several levels, one above another.
class LevelledSource : public MemoryVoxelSource
{
public:
    LevelledSource(const glm::ivec3& size, core::LevelRule rule)
    {
        const auto bumpy = makeBumps(size, VoxelType::UINT8);
        allocate(bumpy->describe());
        std::copy_n(static_cast<unsigned char*>(bumpy->data()), bumpy->sizeInBytes(),
                    static_cast<unsigned char*>(data()));
        make(rule);
    }
    // The coarser levels, as of these samples.
    void make(core::LevelRule rule)
    {
        const Description d = describe();
        _levels = {allOf(*this)};
        for (int level = 1; level < levelCount(); ++level) {
            const glm::ivec3 below = core::BrickTree::levelSize(d.size, level - 1);
            const glm::ivec3 size = core::BrickTree::levelSize(d.size, level);
            _levels.emplace_back(std::size_t(core::sampleCount(size)));
            core::downsample(_levels[std::size_t(level) - 1].data(), below, d.type, 1, rule,
                             _levels.back().data());
        }
    }
    int levelCount() const override { return 3; }
    int pageSize() const override { return 16; }
    Status readLevel(int level, const core::Box3i& region, void* destination) const override
    {
        if (level == 0) return read(region, destination);
        const Description d = describe();
        core::copyRegion({_levels[std::size_t(level)].data(), d.type, 1,
                          core::BrickTree::levelSize(d.size, level)},
                         region, destination);
        return {};
    }

private:
    std::vector<std::vector<unsigned char>> _levels;
};

// Fails, or throws, once told to.
class FailingSource : public MemoryVoxelSource
{
public:
    Status read(const core::Box3i& region, void* destination) const override
    {
        if (throws) throw std::runtime_error("a wire is loose");
        if (fails) return {ErrorCode::FILE_UNREADABLE, "the disk is dead"};
        return MemoryVoxelSource::read(region, destination);
    }
    VoxelBlock share(const core::Box3i&) const override { return {}; }
    bool fails = false, throws = false;
};

TEST(Sculpt, ADabDoesWhatTheToolDoes)
{
    for (const Operation operation : OPERATIONS) {
        osg::ref_ptr<MemoryVoxelSource> source = makeBumps({40, 38, 35}, VoxelType::UINT16);
        osg::ref_ptr<Voxels> voxels = new Voxels(source);
        Sculptor sculptor(voxels);
        Sculptor::Tool tool = makeTool(operation, 6.0);
        tool.unit = Sculptor::OBJECT; // samples: 12, 6, 3
        ASSERT_TRUE(sculptor.setTool(tool).ok());
        const auto dabs = sculptor.stroke({at(20.25, 17, 14.5)});
        ASSERT_TRUE(dabs.ok());
        EXPECT_EQ(*dabs, 1);
        std::vector<unsigned char> expected = allOf(*source);
        core::SculptTool same;
        same.operation = operation;
        same.radius = glm::dvec3(12, 6, 3);
        same.strength = 0.7;
        same.low = same.erased = voxels->getRange().x();
        same.high = voxels->getRange().y();
        std::vector<core::Box3i> changed;
        core::applyTool(same, {20.25, 17, 14.5}, expected.data(),
                        {glm::ivec3(0), glm::ivec3(40, 38, 35)}, VoxelType::UINT16, 1, changed);
        EXPECT_EQ(allOf(*voxels), expected) << int(operation);
        EXPECT_NE(allOf(*source), expected); // it is the voxels that have changed
    }
}

TEST(Sculpt, AStrokeHasNoGaps)
{
    VoxelSource::Description description;
    description.size = glm::ivec3(120, 20, 20);
    description.type = VoxelType::FLOAT32;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    ASSERT_TRUE(source->allocate(description).ok());
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    ASSERT_TRUE(voxels->setRange(osg::Vec2d(0.0, 1.0)).ok());
    Sculptor sculptor(voxels);
    Sculptor::Tool tool = makeTool(Operation::MAX_ADD, 4.0, 1.0);
    tool.spacing = 0.25; // a sample
    ASSERT_TRUE(sculptor.setTool(tool).ok());
    // Positions of a drag that are far from each other, and some that are near.
    ASSERT_TRUE(sculptor.beginStroke({10, 10, 10}).ok());
    for (const double x : {47.0, 47.3, 47.6, 95.0})
        ASSERT_TRUE(sculptor.strokeTo({x, 10, 10}).ok());
    sculptor.endStroke();
    const std::vector<unsigned char> bytes = allOf(*voxels);
    const auto* values = reinterpret_cast<const float*>(bytes.data());
    for (int x = 10; x <= 95; ++x)
        EXPECT_EQ(values[x + 120 * (10 + 20 * 10)], 1.0f) << x;
    EXPECT_EQ(values[5 + 120 * (10 + 20 * 10)], 0.0f);
    EXPECT_EQ(values[100 + 120 * (10 + 20 * 10)], 0.0f);
}

// However many positions a straight drag has, its dabs are the same.
TEST(Sculpt, AStrokeDoesNotDependOnItsPoints)
{
    std::vector<std::vector<unsigned char>> results;
    for (const int parts : {1, 7}) {
        osg::ref_ptr<Voxels> voxels = new Voxels(makeBumps({40, 38, 35}, VoxelType::UINT16));
        Sculptor sculptor(voxels);
        ASSERT_TRUE(sculptor.setTool(makeTool(Operation::PERLIN_ADD, 5.0, 0.2)).ok());
        std::int64_t dabs = *sculptor.beginStroke(at(4, 5, 6));
        for (int i = 1; i <= parts; ++i) {
            const double f = double(i) / parts;
            dabs += *sculptor.strokeTo(at(4 + 30 * f, 5 + 24 * f, 6 + 20 * f));
        }
        sculptor.endStroke();
        EXPECT_GT(dabs, 30);
        results.push_back(allOf(*voxels));
    }
    const auto* a = reinterpret_cast<const std::uint16_t*>(results[0].data());
    const auto* b = reinterpret_cast<const std::uint16_t*>(results[1].data());
    int worst = 0;
    for (std::size_t i = 0; i < results[0].size() / 2; ++i)
        worst = std::max(worst, std::abs(int(a[i]) - int(b[i])));
    EXPECT_LE(worst, 1);
}

TEST(Sculpt, UndoAndRedoAreExactToTheBit)
{
    for (const VoxelType type : {VoxelType::UINT8, VoxelType::INT16, VoxelType::FLOAT32})
        for (const int components : {1, 4}) {
            osg::ref_ptr<Voxels> voxels = new Voxels(makeBumps({40, 38, 35}, type, components));
            Sculptor sculptor(voxels);
            EXPECT_FALSE(sculptor.canUndo());
            std::vector<std::vector<unsigned char>> states = {allOf(*voxels)};
            for (const Operation operation : OPERATIONS) {
                ASSERT_TRUE(sculptor.setTool(makeTool(operation, 7.0)).ok());
                ASSERT_TRUE(sculptor.stroke(PATH).ok());
                states.push_back(allOf(*voxels));
                EXPECT_NE(states.back(), states[states.size() - 2]);
            }
            for (int round = 0; round < 2; ++round) {
                for (std::size_t i = states.size() - 1; i > 0; --i) {
                    EXPECT_TRUE(sculptor.canUndo());
                    ASSERT_TRUE(sculptor.undo().ok());
                    EXPECT_EQ(allOf(*voxels), states[i - 1]) << i;
                }
                EXPECT_FALSE(sculptor.canUndo());
                for (std::size_t i = 1; i < states.size(); ++i) {
                    EXPECT_TRUE(sculptor.canRedo());
                    ASSERT_TRUE(sculptor.redo().ok());
                    EXPECT_EQ(allOf(*voxels), states[i]) << i;
                }
                EXPECT_FALSE(sculptor.canRedo());
            }
            // A new stroke forgets what could be done again.
            ASSERT_TRUE(sculptor.undo().ok());
            ASSERT_TRUE(sculptor.setTool(makeTool(Operation::MAX_ADD, 3.0, 1.0)).ok());
            ASSERT_TRUE(sculptor.stroke({at(20, 20, 20)}).ok());
            EXPECT_FALSE(sculptor.canRedo());
            while (sculptor.canUndo())
                ASSERT_TRUE(sculptor.undo().ok());
            EXPECT_EQ(allOf(*voxels), states[0]);
            const auto* source = dynamic_cast<EditableVoxelSource*>(voxels->getSource());
            ASSERT_TRUE(source);
            EXPECT_FALSE(source->isChanged());
        }
}

TEST(Sculpt, UndoInAStrokeTakesAllOfIt)
{
    osg::ref_ptr<Voxels> voxels = new Voxels(makeBumps({40, 38, 35}, VoxelType::UINT8));
    const auto before = allOf(*voxels);
    Sculptor sculptor(voxels);
    ASSERT_TRUE(sculptor.beginStroke(PATH[0]).ok());
    ASSERT_TRUE(sculptor.strokeTo(PATH[1]).ok());
    EXPECT_TRUE(sculptor.canUndo());
    ASSERT_TRUE(sculptor.undo().ok());
    EXPECT_EQ(allOf(*voxels), before);
    EXPECT_FALSE(sculptor.strokeTo(PATH[2]).ok());
    EXPECT_EQ(allOf(*voxels), before);
}

TEST(Sculpt, HistoryKeepsWithinItsBound)
{
    osg::ref_ptr<Voxels> voxels = new Voxels(makeBumps(glm::ivec3(64), VoxelType::UINT8));
    Sculptor sculptor(voxels);
    ASSERT_TRUE(sculptor.setTool(makeTool(Operation::ERASE, 5.0)).ok());
    // Each within a block of its own: 2 x 4096 bytes.
    for (int i = 0; i < 4; ++i)
        ASSERT_TRUE(sculptor.stroke({at(8 + 16 * i, 8, 8)}).ok());
    sculptor.setHistoryBytes(2 * 2 * 4096);
    int undone = 0;
    for (; sculptor.canUndo(); ++undone)
        ASSERT_TRUE(sculptor.undo().ok());
    EXPECT_EQ(undone, 2);
    sculptor.setHistoryBytes(100);
    EXPECT_FALSE(sculptor.canRedo());
    const auto before = allOf(*voxels);
    ASSERT_TRUE(sculptor.stroke({at(8, 40, 40)}).ok());
    EXPECT_FALSE(sculptor.canUndo()); // larger by itself
    EXPECT_NE(allOf(*voxels), before);
}

TEST(Sculpt, TheRangeStays)
{
    for (const bool explicitly : {false, true}) {
        VoxelSource::Description description;
        description.size = glm::ivec3(32);
        description.type = VoxelType::FLOAT32;
        osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
        ASSERT_TRUE(source->allocate(description).ok());
        auto* values = static_cast<float*>(source->data());
        for (int i = 0; i < 32 * 32 * 32; ++i)
            values[i] = 2.0f + float(i % 32) / 31.0f;
        osg::ref_ptr<Voxels> voxels = new Voxels(source);
        if (explicitly) {
            ASSERT_TRUE(voxels->setRange(osg::Vec2d(1.0, 5.0)).ok());
        }
        const osg::Vec2d before = voxels->getRange();
        Sculptor sculptor(voxels);
        Sculptor::Tool tool = makeTool(Operation::ERASE, 9.0, 1.0);
        tool.erased = -100.0;
        ASSERT_TRUE(sculptor.setTool(tool).ok());
        ASSERT_TRUE(sculptor.stroke({{16, 16, 16}}).ok());
        EXPECT_EQ(voxels->getRange(), before);
        EXPECT_EQ(voxels->hasExplicitRange(), explicitly);
        EXPECT_LE(voxels->getBrickRange(0).first, -100.0);
        EXPECT_GE(voxels->getBrickRange(0).second, 3.0);
        ASSERT_TRUE(sculptor.setTool(makeTool(Operation::MAX_ADD, 4.0, 1.0)).ok());
        ASSERT_TRUE(sculptor.stroke({{16, 16, 16}}).ok());
        float middle = 0.0f;
        ASSERT_TRUE(voxels->getSource()->read({{16, 16, 16}, {17, 17, 17}}, &middle).ok());
        EXPECT_FLOAT_EQ(middle, float(before.y()));
    }
}

TEST(Sculpt, OutsideNothingChanges)
{
    osg::ref_ptr<Voxels> voxels = new Voxels(makeBumps({40, 38, 35}, VoxelType::UINT8));
    const auto before = allOf(*voxels);
    Sculptor sculptor(voxels);
    const unsigned count = voxels->getChangeCount();
    const auto dabs = sculptor.stroke({at(-50, 5, 5), at(-30, 50, 5), at(1e5, 1e5, 1e5)});
    ASSERT_TRUE(dabs.ok());
    EXPECT_EQ(*dabs, 0);
    EXPECT_EQ(allOf(*voxels), before);
    EXPECT_FALSE(sculptor.canUndo());
    EXPECT_EQ(voxels->getChangeCount(), count);
    // In part outside.
    ASSERT_TRUE(sculptor.setTool(makeTool(Operation::ERASE, 5.0)).ok());
    ASSERT_TRUE(sculptor.stroke({at(-3, -2, 36)}).ok());
    EXPECT_TRUE(sculptor.canUndo());
    EXPECT_NE(allOf(*voxels), before);
}

TEST(Sculpt, RefusesBadInput)
{
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    osg::ref_ptr<Voxels> voxels = new Voxels(makeBumps({40, 38, 35}, VoxelType::UINT8));
    const auto before = allOf(*voxels);
    Sculptor sculptor(voxels);
    const Sculptor::Tool good = makeTool(Operation::ERASE, 5.0);
    ASSERT_TRUE(sculptor.setTool(good).ok());
    for (const double bad : {0.0, -1.0, nan, infinity}) {
        for (int axis = 0; axis < 3; ++axis) {
            Sculptor::Tool tool = good;
            tool.radius[axis] = bad;
            EXPECT_EQ(sculptor.setTool(tool).code, ErrorCode::VALUE_INVALID) << bad;
        }
        Sculptor::Tool tool = good;
        tool.strength = bad;
        EXPECT_EQ(sculptor.setTool(tool).code, ErrorCode::VALUE_INVALID) << bad;
        tool = good;
        tool.spacing = bad;
        EXPECT_EQ(sculptor.setTool(tool).code, ErrorCode::VALUE_INVALID) << bad;
    }
    Sculptor::Tool tool = good;
    tool.strength = 1.01;
    EXPECT_EQ(sculptor.setTool(tool).code, ErrorCode::VALUE_INVALID);
    tool = good;
    tool.erased = nan;
    EXPECT_EQ(sculptor.setTool(tool).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(sculptor.getTool().radius, good.radius);

    EXPECT_EQ(sculptor.undo().code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(sculptor.redo().code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(sculptor.strokeTo(PATH[0]).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(sculptor.stroke({}).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(sculptor.stroke({PATH[0], {nan, 0, 0}}).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(sculptor.beginStroke({0, infinity, 0}).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(sculptor.stroke({PATH[0], at(1e12, 0, 0)}).status.code, ErrorCode::TOO_LARGE);
    EXPECT_EQ(allOf(*voxels), before);
    EXPECT_FALSE(sculptor.canUndo());
    Sculptor none(nullptr);
    EXPECT_EQ(none.stroke(PATH).status.code, ErrorCode::VALUE_INVALID);
    Sculptor empty(new Voxels);
    EXPECT_EQ(empty.stroke(PATH).status.code, ErrorCode::VALUE_INVALID);
}

TEST(Sculpt, RefusesWhatCannotBeWritten)
{
    osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    ASSERT_TRUE(series->setSteps({makeBumps(glm::ivec3(32), VoxelType::UINT8).get(),
                                  makeBumps(glm::ivec3(32), VoxelType::UINT8).get()}));
    osg::ref_ptr<Voxels> moving = new Voxels(series);
    Sculptor first(moving);
    EXPECT_EQ(first.stroke(PATH).status.code, ErrorCode::NOT_SUPPORTED);
    EXPECT_EQ(moving->getSource(), series.get());

    osg::ref_ptr<FailingSource> source = new FailingSource;
    VoxelSource::Description description;
    description.size = glm::ivec3(64);
    ASSERT_TRUE(source->allocate(description).ok());
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    const auto before = allOf(*voxels);
    Sculptor second(voxels);
    ASSERT_TRUE(second.setTool(makeTool(Operation::MAX_ADD, 5.0)).ok());
    ASSERT_TRUE(second.beginStroke({8, 8, 8}).ok());
    const auto begun = allOf(*voxels);
    EXPECT_NE(begun, before);
    for (const bool throws : {false, true}) {
        source->fails = !throws;
        source->throws = throws;
        const auto refused = second.strokeTo({50, 50, 50});
        EXPECT_EQ(refused.status.code, ErrorCode::FILE_UNREADABLE);
        EXPECT_FALSE(refused.status.text.empty());
        source->fails = source->throws = false;
        EXPECT_EQ(allOf(*voxels), begun);
    }
    EXPECT_TRUE(second.strokeTo({50, 50, 50}).ok()); // the wire is mended
    ASSERT_TRUE(second.undo().ok());
    EXPECT_EQ(allOf(*voxels), before);

    dynamic_cast<EditableVoxelSource&>(*voxels->getSource()).setMaximumBytes(1 << 14);
    EXPECT_EQ(second.stroke({{8, 8, 8}, {60, 60, 60}}).status.code, ErrorCode::TOO_LARGE);
    EXPECT_EQ(allOf(*voxels), before);
}

TEST(Editable, KnowsRangesAndSharesWhatIsTheSame)
{
    osg::ref_ptr<MemoryVoxelSource> source = makeBumps({40, 38, 35}, VoxelType::UINT8);
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    const auto made = makeEditable(*voxels);
    ASSERT_TRUE(made.ok());
    EditableVoxelSource& editable = **made;
    EXPECT_EQ(makeEditable(*voxels)->get(), &editable);
    const core::Box3i slice{{0, 0, 20}, {40, 38, 21}}, other{{0, 0, 3}, {40, 38, 4}};
    EXPECT_TRUE(editable.share(slice));
    EXPECT_EQ(editable.getBytes(), 0u);
    const core::Box3i box{{3, 17, 17}, {21, 25, 31}};
    std::vector<unsigned char> bytes(std::size_t(core::sampleCount(box.size())), 255);
    EXPECT_EQ(editable.write(box, bytes.data()).code, ErrorCode::VALUE_INVALID); // not held
    ASSERT_TRUE(editable.hold(box).ok());
    EXPECT_EQ(editable.getBytes(), std::size_t(2 * 16 * 16 * 16)); // two blocks, one up to z 32
    EXPECT_FALSE(editable.isChanged());
    EXPECT_EQ(allOf(editable), allOf(*source));
    ASSERT_TRUE(editable.write(box, bytes.data()).ok());
    EXPECT_TRUE(editable.isChanged());
    EXPECT_FALSE(editable.share(slice));
    EXPECT_TRUE(editable.share(other));
    EXPECT_EQ(editable.hold({{0, 0, 0}, {41, 1, 1}}).code, ErrorCode::INDEX_OUT_OF_RANGE);
    // Within the blocks it knows; elsewhere as much as its base, which is nothing.
    const auto range = editable.valueRange(box);
    ASSERT_TRUE(range);
    EXPECT_EQ(range->second, 255.0);
    EXPECT_GE(range->first, 0.0);
    EXPECT_FALSE(editable.valueRange({glm::ivec3(0), glm::ivec3(40, 38, 35)}));
    std::vector<unsigned char> expected = allOf(*source);
    core::pasteRegion(bytes.data(), box, VoxelType::UINT8, 1, {40, 38, 35}, expected.data());
    EXPECT_EQ(allOf(editable), expected);

    // A copy shares blocks until one of the two is written to.
    osg::ref_ptr<EditableVoxelSource> copy = new EditableVoxelSource(editable);
    std::fill(bytes.begin(), bytes.end(), static_cast<unsigned char>(7));
    ASSERT_TRUE(editable.write(box, bytes.data()).ok());
    EXPECT_EQ(allOf(*copy), expected);
    EXPECT_NE(allOf(editable), expected);
}

TEST(Editable, LevelsFollow)
{
    for (const core::LevelRule rule : {core::LevelRule::MEAN, core::LevelRule::MODE}) {
        osg::ref_ptr<LevelledSource> source = new LevelledSource({45, 51, 39}, rule);
        osg::ref_ptr<Voxels> voxels = new Voxels(source);
        ASSERT_TRUE(voxels->isPaged());
        const auto made = makeEditable(*voxels);
        ASSERT_TRUE(made.ok());
        (*made)->setLevelRule(rule);
        const auto first1 = allOf(*voxels, 1), first2 = allOf(*voxels, 2);
        Sculptor sculptor(voxels);
        ASSERT_TRUE(sculptor.setTool(makeTool(Operation::MIN_SUB, 6.0)).ok());
        ASSERT_TRUE(sculptor.stroke(PATH).ok());
        // The same of a volume that was made of the new samples.
        osg::ref_ptr<LevelledSource> anew = new LevelledSource({45, 51, 39}, rule);
        const auto bytes = allOf(*voxels);
        std::copy(bytes.begin(), bytes.end(), static_cast<unsigned char*>(anew->data()));
        anew->make(rule);
        for (const int level : {1, 2})
            EXPECT_EQ(allOf(*voxels, level), allOf(*anew, level)) << level;
        EXPECT_NE(allOf(*voxels, 2), first2);
        ASSERT_TRUE(sculptor.undo().ok());
        EXPECT_EQ(allOf(*voxels, 1), first1);
        EXPECT_EQ(allOf(*voxels, 2), first2);
        ASSERT_TRUE(sculptor.redo().ok());
        EXPECT_EQ(allOf(*voxels, 2), allOf(*anew, 2));
    }
}

class SculptFiles : public support::FolderTest
{
};

TEST_F(SculptFiles, WrittenAndReadBack)
{
    osg::ref_ptr<Voxels> voxels = new Voxels(makeBumps({40, 38, 35}, VoxelType::UINT16));
    Sculptor sculptor(voxels);
    ASSERT_TRUE(sculptor.stroke(PATH).ok());
    const auto sculpted = allOf(*voxels);
    const std::string plain = path("sculpted.tif"), pyramid = path("pyramid.tif");
    ASSERT_TRUE(writeVoxels(*voxels->getSource(), plain).ok());
    ASSERT_TRUE(writePyramid(*voxels->getSource(), pyramid).ok());
    for (const std::string& file : {plain, pyramid}) {
        const auto read = readVoxels(file);
        ASSERT_TRUE(read.ok()) << read.status.text;
        EXPECT_EQ(allOf(**read), sculpted) << file;
    }
    // A pyramid is sculpted in turn, and its levels are as they would be written.
    const auto read = readVoxels(pyramid);
    ASSERT_TRUE(read.ok());
    Sculptor second(read->get());
    ASSERT_TRUE(second.setTool(makeTool(Operation::PERLIN_SUB, 6.0)).ok());
    ASSERT_TRUE(second.stroke({at(10, 30, 20), at(30, 8, 9)}).ok());
    EXPECT_NE(allOf(**read), sculpted);
    const std::string third = path("third.tif");
    ASSERT_TRUE(writePyramid(*(*read)->getSource(), third).ok());
    const auto again = readVoxels(third);
    ASSERT_TRUE(again.ok());
    for (int level = 0; level < (*read)->getSource()->levelCount(); ++level)
        EXPECT_EQ(allOf(**read, level), allOf(**again, level)) << level;
}

TEST(SculptPicks, SeeTheChangeWithoutReadingTheRest)
{
    const auto voxels = makeVoxels(glm::ivec3(64), [](const glm::dvec3&) { return 0.0; });
    ASSERT_TRUE(voxels->setBrickSize({33, 33, 33}).ok());
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    appearance->setLookupTable(makeTable({{0.4, {1, 1, 1, 0.0}}, {0.5, {1, 1, 1, 0.9}}}));
    const Line line{{30.5, 30.5, -20}, {30.5, 30.5, 90}};
    EXPECT_FALSE(pickLine(*appearance, line));
    const auto cache = picking::pickData<picking::SampleCache>(*voxels);
    const auto reads = cache->readCount();
    Sculptor sculptor(voxels);
    ASSERT_TRUE(sculptor.setTool(makeTool(Operation::MAX_ADD, 10.0, 1.0)).ok());
    ASSERT_TRUE(sculptor.stroke({{30.5, 30.5, 30.5}}).ok());
    const auto hit = pickLine(*appearance, line);
    ASSERT_TRUE(hit);
    // A volume of the same samples, anew.
    osg::ref_ptr<MemoryVoxelSource> copy = new MemoryVoxelSource;
    ASSERT_TRUE(copy->allocate(voxels->getSource()->describe()).ok());
    const auto bytes = allOf(*voxels);
    std::copy(bytes.begin(), bytes.end(), static_cast<unsigned char*>(copy->data()));
    osg::ref_ptr<Voxels> fresh = new Voxels(copy);
    ASSERT_TRUE(fresh->setRange(osg::Vec2d(0.0, 1.0)).ok());
    ASSERT_TRUE(fresh->setBrickSize({33, 33, 33}).ok());
    osg::ref_ptr<VolumeAppearance> other = makeVolume(fresh);
    other->setLookupTable(appearance->getLookupTable());
    RandomLines random(glm::dvec3(0.0), glm::dvec3(63.0));
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
        const Line next = random.next();
        const auto a = pickLine(*appearance, next), b = pickLine(*other, next);
        ASSERT_EQ(a.has_value(), b.has_value()) << i;
        if (!a) continue;
        ++hits;
        EXPECT_DOUBLE_EQ(a->ratio, b->ratio) << i;
    }
    EXPECT_GT(hits, 10);
    EXPECT_NEAR(hit->voxel.z(), 30.5 - 5.5, 1.0);
    EXPECT_LE(cache->readCount(), reads + std::uint64_t(voxels->getLayout().brickCount()));
    const auto then = cache->readCount();
    ASSERT_TRUE(sculptor.undo().ok());
    EXPECT_FALSE(pickLine(*appearance, line));
    ASSERT_TRUE(sculptor.redo().ok());
    EXPECT_DOUBLE_EQ(pickLine(*appearance, line)->ratio, hit->ratio);
    EXPECT_EQ(cache->readCount(), then); // only what has changed was taken over
}

TEST(SculptPicks, SeeTheChangeOfPagedVoxels)
{
    osg::ref_ptr<LevelledSource> source = new LevelledSource(glm::ivec3(48), core::LevelRule::MEAN);
    std::fill_n(static_cast<unsigned char*>(source->data()), source->sizeInBytes(), 0);
    source->make(core::LevelRule::MEAN);
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    appearance->setLookupTable(makeTable({{0.4, {1, 1, 1, 0.0}}, {0.5, {1, 1, 1, 0.9}}}));
    const Line line{toDvec3(at(20, 21, -30)), toDvec3(at(20, 21, 90))};
    EXPECT_FALSE(pickLine(*appearance, line));
    Sculptor sculptor(voxels);
    ASSERT_TRUE(sculptor.setTool(makeTool(Operation::MAX_ADD, 8.0, 1.0)).ok());
    ASSERT_TRUE(sculptor.stroke({at(20, 21, 22)}).ok());
    const auto hit = pickLine(*appearance, line);
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->voxel.z(), 22.0 - 4.5, 1.0);
    ASSERT_TRUE(sculptor.undo().ok());
    EXPECT_FALSE(pickLine(*appearance, line));
}

} // namespace
} // namespace SculptTest
