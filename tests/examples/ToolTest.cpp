// osgvolumizertool, run as a program.
#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/core/voxels/VoxelData.h>

#include "../support/FolderTest.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sys/wait.h>

namespace ToolTest {

using namespace osgVolumizer;
namespace fs = std::filesystem;

namespace {

class Tool : public support::FolderTest
{
protected:
    /// Runs the tool in the test's folder; its exit status.
    int run(const std::string& arguments)
    {
        const std::string command = "cd '" + folder().string() +
                                    "' && '" OSGVOLUMIZER_BINARY_DIR "/bin/osgvolumizertool' " +
                                    arguments + " 2>&1";
        FILE* pipe = popen(command.c_str(), "r");
        output.clear();
        std::array<char, 256> buffer;
        while (std::fgets(buffer.data(), buffer.size(), pipe))
            output += buffer.data();
        const int status = pclose(pipe);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    bool says(const std::string& text) const { return output.find(text) != std::string::npos; }
    std::string output;
};

std::vector<double> values(const Voxels& voxels)
{
    const Voxels::Block block = voxels.getBrick(0);
    const core::VoxelView view{block.data, voxels.getType(), 1, voxels.getLayout().size()};
    std::vector<double> v;
    for (std::int64_t i = 0; i < core::sampleCount(view.size); ++i)
        v.push_back(core::voxelValue(view, i));
    return v;
}

} // namespace

TEST_F(Tool, MakesCubes)
{
    ASSERT_EQ(0, run("mkcubes 12 8 10 4 cubes.tif")) << output;
    EXPECT_TRUE(says("cubes.tif: 12,8,10 voxels of uint8")) << output;
    const auto voxels = readVoxels(path("cubes.tif"));
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    ASSERT_EQ(osg::Vec3i(12, 8, 10), (*voxels)->getSize());
    // 1 in the middle of a cube, falling linearly with the largest distance along an axis to 0 at
    // its surface.
    const std::vector<double> v = values(**voxels);
    for (int z = 0; z < 10; ++z)
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 12; ++x) {
                const auto distance = [](int i) { return std::fabs(i % 4 - 1.5) / 2.0; };
                const double expected =
                    255.0 * (1.0 - std::max(distance(x), std::max(distance(y), distance(z))));
                ASSERT_NEAR(expected, v[static_cast<std::size_t>(x + 12 * (y + 8 * z))], 0.5);
            }
}

TEST_F(Tool, MakesCubesOfEveryType)
{
    for (int t = 0; t <= static_cast<int>(VoxelType::FLOAT64); ++t) {
        const std::string type = voxelTypeName(static_cast<VoxelType>(t));
        const int status = run("mkcubes 6 6 6 3 cubes.tif --type " + type);
        ASSERT_EQ(0, status) << output;
        const auto voxels = readVoxels(path("cubes.tif"));
        ASSERT_TRUE(voxels.ok()) << type << ": " << voxels.status.text;
        EXPECT_EQ(type == "half" ? "float32" : type, voxelTypeName((*voxels)->getType()));
        double low = 0.0, high = 1.0;
        voxelTypeRange((*voxels)->getType(), low, high);
        const auto range = (*voxels)->getBrickRange(0);
        EXPECT_NEAR(high, range.second, 1e-3 * high) << type;
        EXPECT_NEAR(high / 3.0, range.first, 0.01 * high) << type;
    }
}

TEST_F(Tool, RawToVolume)
{
    std::string bytes = "HEADER";
    for (int i = 0; i < 24; ++i)
        bytes += {static_cast<char>(i), '\1'};
    writeBytes("engine.raw", bytes);
    ASSERT_EQ(0, run("raw2volume engine.raw.4,3,2,uint16,6,big engine.tif --quiet")) << output;
    const auto voxels = readVoxels(path("engine.tif"));
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_EQ(osg::Vec3i(4, 3, 2), (*voxels)->getSize());
    for (std::size_t i = 0; i < 24; ++i)
        EXPECT_EQ(256.0 * static_cast<double>(i) + 1.0, values(**voxels)[i]);
}

TEST_F(Tool, StackToVolume)
{
    ASSERT_EQ(0, run("mkcubes 6 5 1 3 s8.tif && cp s8.tif s9.tif")) << output;
    ASSERT_EQ(0, run("mkcubes 6 5 1 5 s10.tif")) << output;
    const auto first = readVoxels(path("s8.tif")), last = readVoxels(path("s10.tif"));
    ASSERT_TRUE(first.ok() && last.ok());
    std::vector<double> expected = values(**first);
    for (const auto* v : {&first, &last}) {
        const std::vector<double> more = values(*v->value);
        expected.insert(expected.end(), more.begin(), more.end());
    }
    for (const char* in : {"s%d.tif", "s#.tif", "s8.tif s9.tif s10.tif"}) {
        ASSERT_EQ(0, run(std::string("stack2volume ") + in + " ../osgVolumizerToolStack.tif"))
            << output;
        const auto volume = readVoxels(path("../osgVolumizerToolStack.tif"));
        ASSERT_TRUE(volume.ok()) << volume.status.text;
        EXPECT_EQ(expected, values(**volume)) << in;
    }
    fs::remove(path("../osgVolumizerToolStack.tif"));
}

TEST_F(Tool, PyramidsHaveTheVoxelsOfAnyVolume)
{
    ASSERT_EQ(0, run("mkcubes 70 65 3 10 in.tif --type uint16")) << output;
    ASSERT_EQ(0, run("pyramid in.tif out.tif")) << output;
    EXPECT_TRUE(says("70,65,3 voxels in levels")) << output;
    const auto in = readVoxels(path("in.tif")), out = readVoxels(path("out.tif"));
    ASSERT_TRUE(in.ok() && out.ok());
    EXPECT_TRUE((*out)->isPaged());
    EXPECT_EQ((*out)->getTree().levelCount(), 2);
    EXPECT_EQ(values(**in), values(**out));
    writeBytes("r.raw", std::string(64 * 64 * 64, 'x'));
    ASSERT_EQ(0, run("pyramid r.raw.64,64,64,uint8 labels.tif --levels mode")) << output;
    EXPECT_FALSE(fs::exists(path("labels.part.tif")));
}

TEST_F(Tool, HelpAndWrongCommandLines)
{
    EXPECT_EQ(0, run("--help"));
    EXPECT_TRUE(says("mkcubes") && says("pyramid") && says("raw2volume") && says("stack2volume"));
    const std::pair<const char*, const char*> cases[] = {
        {"", "no command"},
        {"frobnicate", "\"frobnicate\""},
        {"--fast", "\"--fast\""},
        {"mkcubes 4 4 4 4 a.tif --type", "\"--type\""},
        {"mkcubes 4 4 4 4 a.tif --type uint9", "\"uint9\""},
        {"raw2volume a.raw.1,1,1,uint8 a.tif --type uint8", "for mkcubes only"},
        {"mkcubes 4 4 4 a.tif", "4 arguments"},
        {"mkcubes 4 0 4 4 a.tif", "HEIGHT is \"0\""},
        {"mkcubes 4 4 4 x a.tif", "EDGE is \"x\""},
        {"mkcubes 99999999999 4 4 4 a.tif", "WIDTH is \"99999999999\""},
        {"raw2volume a.raw", "takes"},
        {"raw2volume a.raw a.tif", "does not end in"},
        {"stack2volume a.tif", "takes"},
        {"pyramid a.tif", "takes"},
        {"pyramid a.tif b.tif --levels median", "\"median\""},
        {"mkcubes 4 4 4 4 a.tif --levels mode", "for pyramid only"},
    };
    for (const auto& c : cases) {
        EXPECT_EQ(2, run(c.first)) << c.first;
        EXPECT_TRUE(says(c.second)) << output;
    }
}

TEST_F(Tool, FailuresLeaveNothingBehind)
{
    writeBytes("cut.raw", "123");
    EXPECT_EQ(1, run("raw2volume cut.raw.2,2,2,uint8 out.tif"));
    EXPECT_TRUE(says("cut.raw has 3 bytes") && says("need 8")) << output;
    EXPECT_EQ(1, run("raw2volume none.raw.2,2,2,uint8 out.tif"));
    EXPECT_TRUE(says("none.raw was not found")) << output;
    EXPECT_EQ(1, run("stack2volume none.png nor.png out.tif"));
    EXPECT_TRUE(says("none.png")) << output;
    EXPECT_EQ(1, run("mkcubes 4 4 4 2 nowhere/out.tif"));
    EXPECT_TRUE(says("nowhere/out.tif")) << output;
    EXPECT_EQ(1, run("mkcubes 4 4 4 2 out.png"));
    EXPECT_TRUE(says("cannot hold slices")) << output;
    EXPECT_EQ(1, run("mkcubes 4 4 4 2 out.unknown"));
    for (const auto& entry : fs::directory_iterator(path("")))
        EXPECT_EQ("cut.raw", entry.path().filename().string());
}

TEST_F(Tool, WritingOverAFileReplacesItWhole)
{
    ASSERT_EQ(0, run("mkcubes 8 8 8 4 a.tif"));
    ASSERT_EQ(0, run("mkcubes 4 4 2 2 a.tif"));
    const auto voxels = readVoxels(path("a.tif"));
    ASSERT_TRUE(voxels.ok());
    EXPECT_EQ(osg::Vec3i(4, 4, 2), (*voxels)->getSize());
}

TEST_F(Tool, InfoTellsAllThatIsKnown)
{
    ASSERT_EQ(0, run("mkcubes 12 8 10 4 cubes.tif --quiet")) << output;
    ASSERT_EQ(0, run("info cubes.tif --quiet -O 'spacing=0.5,1,2 origin=1,2,3'")) << output;
    for (const char* line :
         {"size         12 x 8 x 10 voxels of uint8\n", "spacing      0.5,1,2\n",
          "first voxel  1,2,3\n", "last voxel   6.5,9,21\n", "orientation  LPS\n",
          "memory       960 bytes\n", "range        0 to 255", "of 960 samples\n"})
        EXPECT_TRUE(says(line)) << line << output;
    ASSERT_EQ(0, run("list cubes.tif")) << output;
    EXPECT_EQ("* 12 x 8 x 10 of uint8\n", output);
    EXPECT_EQ(1, run("info none.tif"));
    EXPECT_TRUE(says("none.tif")) << output;
    EXPECT_EQ(1, run("info cubes.tif -O spacing=0"));
    EXPECT_TRUE(says("option spacing")) << output;
    EXPECT_EQ(2, run("info"));
}

TEST_F(Tool, ConvertsWithWhereItLies)
{
    ASSERT_EQ(0, run("mkcubes 12 8 10 4 cubes.tif --quiet")) << output;
    ASSERT_EQ(0, run("convert cubes.tif placed.tif --quiet -O 'spacing=0.5,1,2 origin=1,2,3'"))
        << output;
    const auto voxels = readVoxels(path("placed.tif"));
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_EQ(osg::Vec3d(0.5, 1, 2), (*voxels)->getSpacing());
    EXPECT_EQ(osg::Vec3d(1, 2, 3), (*voxels)->getOrigin());
    EXPECT_EQ(values(**readVoxels(path("cubes.tif"))), values(**voxels));
}

} // namespace ToolTest
