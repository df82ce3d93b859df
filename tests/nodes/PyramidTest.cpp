#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/WritePyramid.h>
#include <osgVolumizer/core/voxels/VoxelData.h>

#include "../support/FolderTest.h"
#include "../support/LeaksOfOthers.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

namespace PyramidTest {

using namespace osgVolumizer;
namespace fs = std::filesystem;

namespace {

using Bytes = std::vector<unsigned char>;

// Values without a pattern, in any type.
osg::ref_ptr<MemoryVoxelSource> makeSource(const glm::ivec3& size, VoxelType type,
                                           int components = 1)
{
    VoxelSource::Description d;
    d.size = size;
    d.type = type;
    d.components = components;
    d.spacing = {0.5, 0.25, 2.0};
    d.origin = {-10.0, 0.125, 1e6};
    d.axes = glm::dmat3(0, 1, 0, 1, 0, 0, 0, 0, -1);
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    EXPECT_TRUE(source->allocate(d));
    std::mt19937 random(5);
    std::vector<double> values(std::size_t(core::sampleCount(size)) * std::size_t(components));
    std::size_t i = 0;
    for (double& v : values)
        v = (random() % 1000) / 10.0 + 20.0 * std::sin(0.001 * double(i++));
    core::convertVoxels(values.data(), VoxelType::FLOAT64, source->data(), type, values.size());
    return source;
}

// Counts what is read, and fails after so many reads.
class Disk : public VoxelSource
{
public:
    META_Object(osgVolumizer, Disk);
    Disk() = default;
    Disk(const Disk& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY)
        : VoxelSource(o, op), source(o.source)
    {
    }
    Description describe() const override { return source->describe(); }
    Status read(const core::Box3i& region, void* destination) const override
    {
        if (++reads > failAfter) return {ErrorCode::FILE_UNREADABLE, "the disk is dead"};
        return source->read(region, destination);
    }
    osg::ref_ptr<VoxelSource> source;
    int failAfter = 1 << 30;
    mutable int reads = 0;
};

class Pyramid : public support::FolderTest
{
protected:
    std::string path(const std::string& name = "a.tif") const { return FolderTest::path(name); }
    int files() const
    {
        return int(std::distance(fs::directory_iterator(folder()), fs::directory_iterator()));
    }
    osg::ref_ptr<VoxelSource> open(const std::string& name = "a.tif") const
    {
        const auto voxels = readVoxels(path(name));
        EXPECT_TRUE(voxels.ok()) << voxels.status.text;
        return voxels.ok() ? (*voxels)->getSource() : nullptr;
    }
    // What the file is refused with.
    std::string refusal(const std::string& name = "a.tif") const
    {
        const auto voxels = readVoxels(path(name));
        EXPECT_FALSE(voxels.ok());
        return voxels.status.text;
    }
};

// All samples of a level, and of the one that it was made from, the next.
void expectLevels(const VoxelSource& pyramid, const VoxelSource& source, core::LevelRule rule)
{
    const VoxelSource::Description d = pyramid.describe();
    const auto voxel = voxelTypeSize(d.type) * std::size_t(d.components);
    Bytes level(std::size_t(d.sizeInBytes()));
    Bytes own(std::size_t(source.describe().sizeInBytes()));
    ASSERT_TRUE(source.read({glm::ivec3(0), d.size}, own.data()).ok());
    core::convertVoxels(own.data(), source.describe().type, level.data(), d.type,
                        level.size() / voxelTypeSize(d.type));
    std::mt19937 random(9);
    for (int l = 0; l < pyramid.levelCount(); ++l) {
        const glm::ivec3 size = core::BrickTree::levelSize(d.size, l);
        if (l > 0) {
            Bytes coarser(std::size_t(core::sampleCount(size)) * voxel);
            core::downsample(level.data(), core::BrickTree::levelSize(d.size, l - 1), d.type,
                             d.components, rule, coarser.data());
            level.swap(coarser);
        }
        for (int i = 0; i < 30; ++i) {
            core::Box3i region{glm::ivec3(0), size};
            for (int axis = 0; axis < 3 && i > 0; ++axis) {
                region.min[axis] = int(random() % unsigned(size[axis]));
                region.max[axis] =
                    region.min[axis] + 1 + int(random() % unsigned(size[axis] - region.min[axis]));
            }
            Bytes read(std::size_t(core::sampleCount(region.size())) * voxel), expected(read);
            const Status status = pyramid.readLevel(l, region, read.data());
            ASSERT_TRUE(status.ok()) << status.text;
            core::copyRegion({level.data(), d.type, d.components, size}, region, expected.data());
            ASSERT_EQ(read, expected) << "level " << l << ", region " << i;
        }
    }
}

} // namespace

TEST_F(Pyramid, KeepsAllLevelsAndWhereTheyLie)
{
    const struct
    {
        glm::ivec3 size;
        VoxelType type;
        int components;
        core::LevelRule rule;
    } cases[] = {{{130, 67, 150}, VoxelType::UINT8, 1, core::LevelRule::MEAN},
                 {{61, 121, 5}, VoxelType::INT16, 1, core::LevelRule::MODE},
                 {{62, 1, 122}, VoxelType::FLOAT32, 1, core::LevelRule::MEAN},
                 {{70, 20, 64}, VoxelType::HALF, 1, core::LevelRule::MEAN},
                 {{60, 63, 3}, VoxelType::FLOAT64, 1, core::LevelRule::MEAN},
                 {{70, 3, 62}, VoxelType::INT32, 1, core::LevelRule::MEAN},
                 {{80, 66, 64}, VoxelType::UINT8, 4, core::LevelRule::MEAN}};
    for (const auto& c : cases) {
        const auto source = makeSource(c.size, c.type, c.components);
        PyramidOptions options;
        options.rule = c.rule;
        double last = 0.0;
        const Status status = writePyramid(*source, path(), options, [&last](double fraction) {
            EXPECT_GE(fraction, last);
            last = fraction;
        });
        ASSERT_TRUE(status.ok()) << status.text;
        EXPECT_DOUBLE_EQ(last, 1.0);
        EXPECT_EQ(files(), 1);
        const auto pyramid = open();
        ASSERT_TRUE(pyramid);
        const VoxelSource::Description d = pyramid->describe(), s = source->describe();
        EXPECT_EQ(d.size, s.size);
        EXPECT_EQ(d.type, c.type == VoxelType::HALF || c.type == VoxelType::FLOAT64
                              ? VoxelType::FLOAT32
                              : c.type);
        EXPECT_EQ(d.components, s.components);
        EXPECT_EQ(d.spacing, s.spacing);
        EXPECT_EQ(d.origin, s.origin);
        EXPECT_EQ(d.axes, s.axes);
        EXPECT_GT(pyramid->levelCount(), 1);
        expectLevels(*pyramid, *source, c.rule);
    }
}

// The range of a brick is that of all samples that it and those below it are made of.
TEST_F(Pyramid, KnowsTheRangesOfBricksWithoutReading)
{
    const auto source = makeSource({200, 140, 70}, VoxelType::UINT16);
    auto* values = static_cast<std::uint16_t*>(source->data());
    std::fill_n(values, 200 * 140 * 70, std::uint16_t(3));
    const glm::ivec3 at(150, 10, 20);
    values[at.x + 200 * (at.y + 140 * at.z)] = 60000;
    ASSERT_TRUE(writePyramid(*source, path()).ok());
    const auto voxels = readVoxels(path());
    ASSERT_TRUE(voxels.ok());
    ASSERT_TRUE((*voxels)->isPaged());
    EXPECT_EQ((*voxels)->getRange(), osg::Vec2d(3, 60000));
    const core::BrickTree& tree = (*voxels)->getTree();
    int mixed = 0;
    for (std::int64_t page = 0; page < tree.brickCount(); ++page) {
        const auto range = (*voxels)->getPageRange(page);
        ASSERT_TRUE(range);
        EXPECT_EQ(range->first, 3.0);
        const core::Box3d box = tree.brick(page).clipBox;
        bool inside = true;
        for (int axis = 0; axis < 3; ++axis)
            inside = inside && at[axis] >= box.min[axis] && at[axis] <= box.max[axis];
        EXPECT_EQ(range->second, inside ? 60000.0 : 3.0);
        mixed += range->second > 3.0;
    }
    EXPECT_EQ(mixed, tree.levelCount());
    EXPECT_EQ((*voxels)->getReadCount(), 0u);
}

TEST_F(Pyramid, IsGoneOnWithWhereItWasInterrupted)
{
    const auto source = makeSource({100, 130, 300}, VoxelType::UINT8);
    osg::ref_ptr<Disk> disk = new Disk;
    disk->source = source;
    PyramidOptions options;
    options.origin = "scan 7";
    ASSERT_TRUE(writePyramid(*disk, path("whole.tif"), options).ok());
    const int all = disk->reads;
    ASSERT_GE(all, 10);
    disk->reads = 0;
    disk->failAfter = all / 2;
    const Status failed = writePyramid(*disk, path(), options);
    EXPECT_EQ(failed.code, ErrorCode::FILE_UNREADABLE);
    EXPECT_NE(failed.text.find("the disk is dead"), std::string::npos);
    EXPECT_FALSE(fs::exists(path()));
    disk->reads = 0;
    disk->failAfter = 1 << 30;
    // Not with the voxels of something else.
    PyramidOptions other;
    other.origin = "scan 8";
    osg::ref_ptr<Disk> second = new Disk;
    fs::copy_file(path("a.part.tif"), path("b.part.tif"));
    second->source = source;
    Status status = writePyramid(*second, path("b.tif"), other);
    ASSERT_TRUE(status.ok()) << status.text;
    EXPECT_EQ(second->reads, all);
    status = writePyramid(*disk, path(), options);
    ASSERT_TRUE(status.ok()) << status.text;
    EXPECT_LT(disk->reads, all * 3 / 4);
    EXPECT_FALSE(fs::exists(path("a.part.tif")));
    expectLevels(*open(), *source, core::LevelRule::MEAN);
}

TEST_F(Pyramid, DamagedOnesAreRefusedWithASentence)
{
    ASSERT_TRUE(writePyramid(*makeSource({130, 40, 130}, VoxelType::UINT8), path()).ok());
    std::ifstream in(path(), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    const auto rewrite = [&](const std::string& text) {
        std::ofstream(path("b.tif"), std::ios::binary) << text;
    };
    const auto replaced = [&](const std::string& from, const std::string& to) {
        std::string text = bytes;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos);
        return text.replace(at, from.size(), to);
    };
    rewrite(replaced("size 130,40,130", "size 130,40,930"));
    EXPECT_NE(refusal("b.tif").find("not what the header says"), std::string::npos);
    rewrite(replaced("size 130,40,130", "size 930,40,130"));
    EXPECT_NE(refusal("b.tif").find("not what the header says"), std::string::npos);
    rewrite(replaced("size 130,40,130", "size 130,40,xxx"));
    EXPECT_NE(refusal("b.tif").find("size"), std::string::npos);
    rewrite(replaced("type uint8", "type int16"));
    EXPECT_NE(refusal("b.tif").find("not what the header says"), std::string::npos);
    rewrite(replaced("spacing 0.5", "spacing -.5"));
    EXPECT_NE(refusal("b.tif").find("spacing"), std::string::npos);
    rewrite(replaced("pyramid 1", "pyramid 2"));
    EXPECT_NE(refusal("b.tif").find("pyramid 1"), std::string::npos);
    rewrite(bytes.substr(0, bytes.size() - 100));
    EXPECT_NE(refusal("b.tif").find("cut short"), std::string::npos) << refusal("b.tif");
    for (const std::size_t length : {std::size_t(15), bytes.size() / 3, bytes.size() - 100}) {
        rewrite(bytes.substr(0, length));
        EXPECT_FALSE(refusal("b.tif").empty());
    }
    EXPECT_FALSE(writePyramid(*makeSource({9, 9, 9}, VoxelType::UINT8), "/nowhere/a.tif").ok());
}

// Damage beyond the headers is found when it is read, and does no harm.
TEST_F(Pyramid, DamagedSamplesAreAnErrorOfTheBrick)
{
    ASSERT_TRUE(writePyramid(*makeSource({130, 60, 60}, VoxelType::UINT8), path()).ok());
    std::fstream file(path(), std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(40);
    for (int i = 0; i < 3000; ++i)
        file.put(char(i * 37));
    file.close();
    const auto voxels = readVoxels(path());
    if (!voxels.ok()) return;
    int failed = 0;
    for (std::int64_t page = 0; page < (*voxels)->getTree().brickCount(); ++page)
        failed += !(*voxels)->readPage(page).ok();
    EXPECT_GT(failed, 0);
}

} // namespace PyramidTest
