// HDF5 files as nobody should write them: a sentence each, and nothing printed.

#ifdef OSGVOLUMIZER_HAVE_HDF5

#include "Hdf5Files.h"

#include <osgVolumizer/Error.h>

#include <sys/stat.h>

#include <fstream>
#include <sstream>

namespace Hdf5BadFileTest {

using namespace osgVolumizer;
namespace fs = std::filesystem;

namespace {

class Hdf5BadFile : public Hdf5FolderTest
{
protected:
    void SetUp() override
    {
        FolderTest::SetUp();
        testing::internal::CaptureStderr();
    }
    void TearDown() override
    {
        EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
        Hdf5FolderTest::TearDown();
    }
    /// Expects that a file is refused for a reason with these words.
    void expectRefusal(const std::string& name, const std::string& options, ErrorCode code,
                       const std::string& words) const
    {
        const auto voxels = read(name, options);
        EXPECT_FALSE(voxels.ok()) << name << " " << options;
        expectSentence(voxels.status, code, words);
        EXPECT_NE(voxels.status.text.find(name), std::string::npos) << voxels.status.text;
    }
    static void expectSentence(const Status& status, ErrorCode code, const std::string& words)
    {
        EXPECT_EQ(errorName(status.code), std::string(errorName(code))) << status.text;
        EXPECT_NE(status.text.find(words), std::string::npos) << status.text;
        EXPECT_EQ(status.text.find('\n'), std::string::npos) << status.text;
    }
    std::string bytesOf(const std::string& name) const
    {
        std::ostringstream bytes;
        bytes << std::ifstream(path(name), std::ios::binary).rdbuf();
        return bytes.str();
    }
    /// The reason why a region cannot be read.
    static Status failure(const VoxelSource& source, const glm::ivec3& size, int step = 0,
                          int level = 0)
    {
        std::vector<char> samples(std::size_t(size.x) * size.y * size.z * 4);
        return source.readStep(step, level, {glm::ivec3(0), size}, samples.data());
    }
    void writeSmallImaris(Hdf5Writer& file, int step, int n) const
    {
        const std::string group =
            "/DataSet/ResolutionLevel 0/TimePoint " + std::to_string(step) + "/Channel 0";
        file.dataset(group + "/Data", Size(3, hsize_t(n)), volume<std::uint8_t>(n, n, n));
    }
};

std::size_t skipAll(unsigned, std::size_t, const unsigned*, std::size_t bytes, std::size_t*, void**)
{
    return bytes;
}

} // namespace

TEST_F(Hdf5BadFile, CutShort)
{
    {
        Hdf5Writer file(path("whole.h5"));
        file.dataset("/v", {20, 20, 20}, volume<std::uint8_t>(20, 20, 20), H5T_NATIVE_UINT8,
                     {8, 8, 8}, H5Z_FILTER_DEFLATE);
    }
    const std::string whole = bytesOf("whole.h5");
    ASSERT_GT(whole.size(), 2000u);
    for (std::size_t n = 0; n < whole.size(); n += n < 200 ? 7 : 97) {
        writeBytes("cut.h5", whole.substr(0, n));
        expectRefusal("cut.h5", "", ErrorCode::FILE_UNREADABLE, "cannot be read: ");
    }
}

TEST_F(Hdf5BadFile, NoHdf5AtAll)
{
    writeBytes("text.h5", "these are words\n");
    expectRefusal("text.h5", "", ErrorCode::FILE_UNREADABLE, "cannot be read: ");
    writeBytes("long.ims", std::string(100000, 'x'));
    expectRefusal("long.ims", "channel=1", ErrorCode::FILE_UNREADABLE, "cannot be read: ");
    ASSERT_EQ(mkfifo(path("pipe.h5").c_str(), 0600), 0);
    expectRefusal("pipe.h5", "", ErrorCode::FILE_UNREADABLE, "no regular file");
    expectRefusal("missing.h5", "", ErrorCode::FILE_NOT_FOUND, "was not found");
}

TEST_F(Hdf5BadFile, NoVolume)
{
    {
        Hdf5Writer file(path("empty.h5"));
    }
    expectRefusal("empty.h5", "", ErrorCode::FILE_UNREADABLE, "there are no datasets at all");
    {
        Hdf5Writer file(path("flat.h5"));
        for (int i = 0; i < 7; ++i)
            file.dataset("/group/d" + std::to_string(i), {3, hsize_t(i) + 1}, std::vector<float>());
        // A group within itself.
        EXPECT_GE(H5Lcreate_hard(file.id(), "/group", file.id(), "/group/again", H5P_DEFAULT,
                                 H5P_DEFAULT),
                  0);
    }
    expectRefusal(
        "flat.h5", "", ErrorCode::FILE_UNREADABLE,
        "there is /group/d0 (3,1 of float32), /group/d1 (3,2 of float32), /group/d2 (3,3 "
        "of float32), /group/d3 (3,4 of float32), /group/d4 (3,5 of float32), and 2 more");
    expectRefusal("flat.h5", "dataset=/group/d2", ErrorCode::NOT_SUPPORTED,
                  "/group/d2 (3,3 of float32) has neither the axes z,y,x");
    expectRefusal("flat.h5", "dataset=/group/d9", ErrorCode::VALUE_INVALID,
                  "there is no dataset /group/d9; there is /group/d0 (3,1");
    expectRefusal("flat.h5", "dataset=/group", ErrorCode::VALUE_INVALID,
                  "there is no dataset /group;");
}

TEST_F(Hdf5BadFile, ValuesThatAreNoNumbers)
{
    const hid_t pair = H5Tcreate(H5T_COMPOUND, 8), text = H5Tcopy(H5T_C_S1);
    const hid_t wide = H5Tcopy(H5T_STD_I32LE);
    H5Tset_size(wide, 1000);
    H5Tinsert(pair, "a\nb", 0, H5T_NATIVE_INT);
    H5Tset_size(text, H5T_VARIABLE);
    {
        Hdf5Writer file(path("types.h5"));
        file.dataset("/pairs", {4, 4, 4}, std::vector<int>(), pair);
        file.dataset("/te\nxt", {4, 4, 4}, std::vector<int>(), text);
        file.dataset("/bits", {4, 4, 4}, std::vector<int>(), H5T_STD_B8LE);
        file.dataset("/wide", {4, 4, 4}, std::vector<int>(), wide);
    }
    H5Tclose(wide);
    H5Tclose(pair);
    H5Tclose(text);
    expectRefusal("types.h5", "", ErrorCode::FILE_UNREADABLE,
                  "/bits (4,4,4 of bits), /pairs (4,4,4 of compound values), /te xt (4,4,4 of "
                  "strings), /wide (4,4,4 of int8000)");
    expectRefusal("types.h5", "dataset=/pairs", ErrorCode::NOT_SUPPORTED, "holds no numbers");
    expectRefusal("types.h5", "dataset=\"/te\nxt\"", ErrorCode::NOT_SUPPORTED, "holds no numbers");
}

TEST_F(Hdf5BadFile, SizesThatNoVolumeHas)
{
    const hsize_t many = hsize_t(1) << 31, most = many - 1;
    {
        Hdf5Writer file(path("sizes.h5"));
        const std::vector<std::uint8_t> nothing;
        file.dataset("/none", {4, 0, 4}, nothing);
        file.dataset("/many", {many, 4, 4}, nothing, H5T_NATIVE_UINT8, {8, 4, 4});
        file.dataset("/times", {many, 4, 4, 4}, nothing, H5T_NATIVE_UINT8, {8, 4, 4, 4});
        file.dataset("/never", {0, 4, 4, 4}, nothing);
        file.dataset("/all", {most, most, most}, nothing, H5T_NATIVE_UINT8, {8, 4, 4});
        file.dataset("/pieces", {4096, 4096, 4096}, nothing, H5T_NATIVE_UINT8, {2048, 1024, 1024});
    }
    expectRefusal("sizes.h5", "dataset=/none", ErrorCode::VALUE_INVALID, "4,0,4 of uint8");
    expectRefusal("sizes.h5", "dataset=/many", ErrorCode::TOO_LARGE, "2147483648,4,4 of uint8");
    expectRefusal("sizes.h5", "dataset=/times", ErrorCode::VALUE_INVALID, "2147483648 time steps");
    expectRefusal("sizes.h5", "dataset=/never", ErrorCode::VALUE_INVALID, "0 time steps");
    expectRefusal("sizes.h5", "dataset=/all", ErrorCode::TOO_LARGE, "2147483647");
    expectRefusal("sizes.h5", "dataset=/pieces", ErrorCode::TOO_LARGE, "pieces of 2048 MB");
}

TEST_F(Hdf5BadFile, ChannelsThatThereAreNot)
{
    {
        Hdf5Writer file(path("cells.ims"));
        writeSmallImaris(file, 0, 8);
        Hdf5Writer plain(path("plain.h5"));
        plain.dataset("/v", {3, 3, 3}, volume<std::uint8_t>(3, 3, 3));
        Hdf5Writer views(path("views.h5"));
        for (const char* setup : {"s01", "s02", "s05", "s06", "s08", "s09", "s31"})
            views.dataset(std::string("/t00000/") + setup + "/0/cells", {3, 3, 3},
                          volume<std::int16_t>(3, 3, 3));
    }
    expectRefusal("cells.ims", "channel=1", ErrorCode::INDEX_OUT_OF_RANGE,
                  "there is no channel 1, but 0");
    expectRefusal("views.h5", "channel=3", ErrorCode::INDEX_OUT_OF_RANGE,
                  "there is no setup 3, but 1, 2, 5, 6, 8, ... 31");
    expectRefusal("plain.h5", "channel=0", ErrorCode::VALUE_INVALID, "dataset=/path");
    expectRefusal("plain.h5", "channel=0 dataset=/v", ErrorCode::VALUE_INVALID,
                  "one excludes the other");
    expectRefusal("plain.h5", "channel=-1", ErrorCode::VALUE_INVALID, "channel is \"-1\"");
    expectRefusal("plain.h5", "dataset=", ErrorCode::VALUE_INVALID, "dataset is \"\"");
    EXPECT_TRUE(read("plain.h5").ok());
}

TEST_F(Hdf5BadFile, ImarisOfWrongSizes)
{
    const std::string group = "/DataSet/ResolutionLevel 0/TimePoint 0/Channel 0";
    for (const char* size : {"9", "0", "-1", "2.5", "8 8", "many", "nan", "1e30"}) {
        {
            Hdf5Writer file(path("bad.ims"));
            writeSmallImaris(file, 0, 8);
            file.attribute(group, "ImageSizeY", size);
        }
        expectRefusal("bad.ims", "", ErrorCode::FILE_UNREADABLE, "ImageSizeY of level 0 is ");
    }
    for (const char* end : {"-1", "nan", "word", "1e300"}) { // as if nothing were said
        {
            Hdf5Writer file(path("place.ims"));
            writeSmallImaris(file, 0, 8);
            for (const char* name : {"ExtMin0", "ExtMin1", "ExtMin2", "ExtMax1", "ExtMax2"})
                file.attribute("/DataSetInfo/Image", name, name[3] == 'i' ? "0" : "8");
            file.attribute("/DataSetInfo/Image", "ExtMax0", end);
        }
        const auto voxels = read("place.ims");
        ASSERT_TRUE(voxels.ok()) << voxels.status.text;
        EXPECT_EQ((*voxels)->getSpacing(), osg::Vec3d(1, 1, 1));
    }
    {
        Hdf5Writer file(path("flat.ims"));
        file.dataset(group + "/Data", {8, 8}, std::vector<float>());
        Hdf5Writer none(path("none.ims"));
        none.attribute("/DataSet/ResolutionLevel 0/TimePoint 0", "nothing", "here");
    }
    expectRefusal("flat.ims", "", ErrorCode::NOT_SUPPORTED,
                  "8,8 of float32) has other axes than z,y,x");
    expectRefusal("none.ims", "", ErrorCode::INDEX_OUT_OF_RANGE, "there is no channel 0");
}

// Only the first time step is looked at when a file is opened.
TEST_F(Hdf5BadFile, TimeStepsUnlikeTheFirst)
{
    {
        Hdf5Writer file(path("steps.ims"));
        for (int step = 0; step < 3; ++step)
            writeSmallImaris(file, step, step == 1 ? 7 : 8);
        file.attribute("/DataSet/ResolutionLevel 0/TimePoint 3/Channel 0", "no", "data");
    }
    const auto source = open("steps.ims");
    ASSERT_TRUE(source);
    EXPECT_EQ(source->stepCount(), 4);
    EXPECT_TRUE(failure(*source, glm::ivec3(8), 0).ok());
    expectSentence(failure(*source, glm::ivec3(8), 1), ErrorCode::SIZE_MISMATCH, "7,7,7 of uint8");
    EXPECT_TRUE(failure(*source, glm::ivec3(8), 2).ok());
    expectSentence(failure(*source, glm::ivec3(8), 3), ErrorCode::FILE_UNREADABLE, "TimePoint 3");
}

TEST_F(Hdf5BadFile, AFilterThatIsMissing)
{
    constexpr H5Z_filter_t NUMBER = 311;
    const H5Z_class2_t filter{H5Z_CLASS_T_VERS, NUMBER,  1,       1,
                              "sque\neze",      nullptr, nullptr, skipAll};
    ASSERT_GE(H5Zregister(&filter), 0);
    {
        Hdf5Writer file(path("packed.h5"));
        file.dataset("/v", {4, 4, 4}, volume<std::uint8_t>(4, 4, 4), H5T_NATIVE_UINT8, {4, 4, 4},
                     NUMBER);
    }
    EXPECT_TRUE(read("packed.h5").ok());
    ASSERT_GE(H5Zunregister(NUMBER), 0);
    expectRefusal("packed.h5", "", ErrorCode::NOT_SUPPORTED, "filter 311 (sque eze)");
}

TEST_F(Hdf5BadFile, CutShortWhileItIsRead)
{
    {
        Hdf5Writer file(path("cut.h5"));
        file.dataset("/v", {64, 64, 64}, volume<std::uint8_t>(64, 64, 64));
    }
    const auto source = open("cut.h5");
    ASSERT_TRUE(source);
    EXPECT_TRUE(failure(*source, glm::ivec3(64)).ok());
    fs::resize_file(path("cut.h5"), 10000);
    const Status status = failure(*source, glm::ivec3(64));
    expectSentence(status, ErrorCode::FILE_UNREADABLE, "cut.h5 cannot be read");
}

// Whoever else uses the library in this process hears of its own errors.
TEST_F(Hdf5BadFile, PrintingIsAsItWas)
{
    H5E_auto2_t before = nullptr, after = nullptr;
    void *beforeTo = nullptr, *afterTo = nullptr;
    // GDAL, which other tests use, turns it off for the process.
    ASSERT_GE(H5Eset_auto2(H5E_DEFAULT, reinterpret_cast<H5E_auto2_t>(H5Eprint2), stderr), 0);
    ASSERT_GE(H5Eget_auto2(H5E_DEFAULT, &before, &beforeTo), 0);
    ASSERT_TRUE(before);
    writeBytes("text.h5", "these are words\n");
    expectRefusal("text.h5", "", ErrorCode::FILE_UNREADABLE, "");
    ASSERT_GE(H5Eget_auto2(H5E_DEFAULT, &after, &afterTo), 0);
    EXPECT_EQ(before, after);
    EXPECT_EQ(beforeTo, afterTo);
}

} // namespace Hdf5BadFileTest

#endif
