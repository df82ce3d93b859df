#include <osgVolumizer/Paging.h>
#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/io/PluginFile.h>
#include <osgVolumizer/io/VoxelOptions.h>

#include "../support/FolderTest.h"
#include "../support/LeaksOfOthers.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>

namespace ReadVoxelsTest {

using namespace osgVolumizer;
namespace fs = std::filesystem;

namespace {

/// A fresh folder for one test, removed afterwards.
class ReadVoxels : public support::FolderTest
{
protected:
    /// Pixels of consecutive values, starting at `first`, in any type and number of channels.
    template <class T>
    std::string writeImage(const std::string& name, OIIO::ImageSpec spec, T first,
                           int subimages = 1) const
    {
        auto out = OIIO::ImageOutput::create(path(name));
        EXPECT_TRUE(out);
        std::vector<T> pixels(spec.image_pixels() * static_cast<std::size_t>(spec.nchannels));
        for (int s = 0; s < subimages; ++s) {
            std::iota(pixels.begin(), pixels.end(), first);
            first = static_cast<T>(first + static_cast<T>(pixels.size()));
            EXPECT_TRUE(
                out->open(path(name), spec,
                          s ? OIIO::ImageOutput::AppendSubimage : OIIO::ImageOutput::Create))
                << out->geterror();
            EXPECT_TRUE(out->write_image(spec.format, pixels.data())) << out->geterror();
        }
        return path(name);
    }
    static OIIO::ImageSpec plain(int width, int height, int channels, OIIO::TypeDesc type)
    {
        OIIO::ImageSpec spec(width, height, channels, type);
        spec.attribute("compression", "none");
        return spec;
    }
};

template <class T>
std::vector<T> values(const Voxels& voxels)
{
    const Voxels::Block block = voxels.getBrick(0);
    std::vector<T> v(block.bytes / sizeof(T));
    std::memcpy(v.data(), block.data, block.bytes);
    return v;
}

osg::ref_ptr<osgDB::Options> optionString(const std::string& text)
{
    return new osgDB::Options(text);
}

Status statusOf(const std::string& name, const std::string& options = {})
{
    const auto voxels = readVoxels(name, optionString(options).get());
    EXPECT_FALSE(voxels.ok()) << name;
    EXPECT_FALSE(voxels.value.valid());
    return voxels.status;
}

bool names(const Status& status, const std::string& what)
{
    return status.text.find(what) != std::string::npos;
}

} // namespace

TEST_F(ReadVoxels, PagesAreSlices)
{
    const auto file =
        writeImage<std::uint16_t>("a.tif", plain(4, 3, 1, OIIO::TypeDesc::UINT16), 500, 5);
    double done = 0.0;
    const auto voxels = readVoxels(file, nullptr, [&](double f) {
        EXPECT_GT(f, done);
        done = f;
    });
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_EQ(1.0, done);
    EXPECT_EQ(osg::Vec3i(4, 3, 5), (*voxels)->getSize());
    EXPECT_EQ(VoxelType::UINT16, (*voxels)->getType());
    std::vector<std::uint16_t> expected(60);
    std::iota(expected.begin(), expected.end(), std::uint16_t(500));
    EXPECT_EQ(expected, values<std::uint16_t>(**voxels));
    EXPECT_EQ(osg::Vec2d(500, 559), (*voxels)->getRange());
    EXPECT_EQ(file, (*voxels)->getFileName());
}

TEST_F(ReadVoxels, CalibratedValuesOfEveryType)
{
    const auto range = [&](const std::string& file) {
        const auto voxels = readVoxels(file);
        EXPECT_TRUE(voxels.ok()) << voxels.status.text;
        return voxels.ok() ? (*voxels)->getBrickRange(0) : std::make_pair(0.0, 0.0);
    };
    using Pair = std::pair<double, double>;
    EXPECT_EQ(Pair(-3, 8),
              range(writeImage<std::int8_t>("a.tif", plain(4, 3, 1, OIIO::TypeDesc::INT8), -3)));
    EXPECT_EQ(Pair(-1000, -989), range(writeImage<std::int16_t>(
                                     "b.tif", plain(4, 3, 1, OIIO::TypeDesc::INT16), -1000)));
    EXPECT_EQ(Pair(-70000, -69989), range(writeImage<std::int32_t>(
                                        "c.tif", plain(4, 3, 1, OIIO::TypeDesc::INT32), -70000)));
    EXPECT_EQ(Pair(4000000000.0, 4000000011.0),
              range(writeImage<std::uint32_t>("d.tif", plain(4, 3, 1, OIIO::TypeDesc::UINT32),
                                              4000000000u)));
    EXPECT_EQ(Pair(-0.5, 10.5),
              range(writeImage<float>("e.tif", plain(4, 3, 1, OIIO::TypeDesc::FLOAT), -0.5f)));
    EXPECT_EQ(Pair(-0.5, 10.5),
              range(writeImage<double>("f.tif", plain(4, 3, 1, OIIO::TypeDesc::DOUBLE), -0.5)));
    EXPECT_EQ(
        Pair(-0.5, 10.5),
        range(writeImage<float>("g.exr", OIIO::ImageSpec(4, 3, 1, OIIO::TypeDesc::FLOAT), -0.5f)));
    EXPECT_EQ(Pair(7, 18), range(writeImage<std::uint8_t>(
                               "h.png", OIIO::ImageSpec(4, 3, 1, OIIO::TypeDesc::UINT8), 7)));
}

TEST_F(ReadVoxels, ColoursAndAlpha)
{
    const auto rgba =
        readVoxels(writeImage<std::uint8_t>("a.tif", plain(2, 2, 4, OIIO::TypeDesc::UINT8), 10));
    ASSERT_TRUE(rgba.ok()) << rgba.status.text;
    EXPECT_EQ(4, (*rgba)->getComponents());
    std::vector<std::uint8_t> expected(16);
    std::iota(expected.begin(), expected.end(), std::uint8_t(10));
    EXPECT_EQ(expected, values<std::uint8_t>(**rgba)); // not premultiplied
    const auto rgb =
        readVoxels(writeImage<std::uint8_t>("b.tif", plain(2, 1, 3, OIIO::TypeDesc::UINT8), 10));
    ASSERT_TRUE(rgb.ok());
    EXPECT_EQ(1, (*rgb)->getComponents());
    // 10,11,12 and 13,14,15: luminance 10.86 and 13.86.
    EXPECT_EQ((std::vector<std::uint8_t>{11, 14}), values<std::uint8_t>(**rgb));
    const auto two =
        readVoxels(writeImage<std::uint8_t>("c.tif", plain(2, 1, 2, OIIO::TypeDesc::UINT8), 10));
    ASSERT_TRUE(two.ok());
    EXPECT_EQ((std::vector<std::uint8_t>{10, 12}), values<std::uint8_t>(**two));
}

// OpenImageIO's "null" format makes up images of any size; the file only has to be there.
TEST_F(ReadVoxels, ImagesWithDepth)
{
    for (const char* name : {"a.null?RES=20x17x9&TYPE=uint8&PIXEL=1",
                             "b.null?RES=20x17x9&TILE=8x8x4&TYPE=uint8&PIXEL=1"}) {
        const auto voxels = readVoxels(writeBytes(name, "something"));
        ASSERT_TRUE(voxels.ok()) << voxels.status.text;
        EXPECT_EQ(osg::Vec3i(20, 17, 9), (*voxels)->getSize());
        EXPECT_EQ(std::vector<std::uint8_t>(20 * 17 * 9, 255), values<std::uint8_t>(**voxels));
    }
    const Status huge = statusOf(writeBytes("c.null?RES=16384x8192x8192&TYPE=uint8", "x"));
    EXPECT_EQ(ErrorCode::FILE_UNREADABLE, huge.code);
    EXPECT_TRUE(names(huge, "1 bytes") && names(huge, "need")) << huge.text;
    const std::string large(2 << 20,
                            'x'); // enough bytes for it to be compressed, so the bound counts
    EXPECT_EQ(ErrorCode::TOO_LARGE,
              statusOf(writeBytes("d.null?RES=16384x8192x8192&TYPE=uint8", large)).code);
}

TEST_F(ReadVoxels, FoldersInNaturalOrder)
{
    for (const int i : {1, 2, 10})
        writeImage<std::uint8_t>("s" + std::to_string(i) + ".png",
                                 OIIO::ImageSpec(2, 1, 1, OIIO::TypeDesc::UINT8),
                                 static_cast<std::uint8_t>(10 * i));
    writeBytes("notes.txt", "not an image");
    writeBytes(".hidden.png", "neither");
    const auto voxels = readVoxels(path("") /* ends with a slash */);
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_EQ(osg::Vec3i(2, 1, 3), (*voxels)->getSize());
    EXPECT_EQ((std::vector<std::uint8_t>{10, 11, 20, 21, 100, 101}),
              values<std::uint8_t>(**voxels));
}

TEST_F(ReadVoxels, NumberedPatterns)
{
    for (int i = 8; i < 12; ++i) {
        char name[16];
        std::snprintf(name, sizeof(name), "s%03d.png", i);
        writeImage<std::uint8_t>(name, OIIO::ImageSpec(1, 1, 1, OIIO::TypeDesc::UINT8),
                                 static_cast<std::uint8_t>(i));
    }
    writeBytes("s9.png", "of another pattern");
    for (const char* pattern : {"s%03d.png", "s###.png", "s%02d.png"}) {
        const auto voxels = readVoxels(path(pattern));
        if (std::string(pattern) == "s%02d.png") {
            EXPECT_EQ(ErrorCode::FILE_NOT_FOUND, voxels.status.code);
            continue;
        }
        ASSERT_TRUE(voxels.ok()) << voxels.status.text;
        EXPECT_EQ((std::vector<std::uint8_t>{8, 9, 10, 11}), values<std::uint8_t>(**voxels));
    }
    fs::remove(path("s010.png"));
    const Status gap = statusOf(path("s%03d.png"));
    EXPECT_EQ(ErrorCode::FILE_NOT_FOUND, gap.code);
    EXPECT_TRUE(names(gap, "number 10")) << gap.text;
    // Along the data path.
    fs::remove(path("s011.png"));
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->getDatabasePathList().push_back(path(""));
    const auto found = readVoxels("s###.png", options.get());
    ASSERT_TRUE(found.ok()) << found.status.text;
    EXPECT_EQ(2, (*found)->getSize().z());
    EXPECT_EQ("s###.png", (*found)->getFileName());
}

TEST_F(ReadVoxels, RawFiles)
{
    std::string bytes = "HDR";
    for (int i = 0; i < 24; ++i)
        bytes += std::string(1, static_cast<char>(1)) + static_cast<char>(i);
    const std::string file = writeBytes("engine.raw", bytes);
    const auto big = readVoxels(file + ".4,3,2,uint16,3,big");
    ASSERT_TRUE(big.ok()) << big.status.text;
    EXPECT_EQ(256 + 23, values<std::uint16_t>(**big).back());
    const auto little = readVoxels(file + ".4,3,2,uint16,3");
    ASSERT_TRUE(little.ok());
    EXPECT_EQ(1 + 256 * 23, values<std::uint16_t>(**little).back());
    // Along the data path, under the name given.
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options;
    options->getDatabasePathList().push_back(path(""));
    const auto found = readVoxels("engine.raw.4,3,2,int16,3,little", options.get());
    ASSERT_TRUE(found.ok()) << found.status.text;
    EXPECT_EQ("engine.raw.4,3,2,int16,3,little", (*found)->getFileName());
}

TEST_F(ReadVoxels, RawFilesAreReadBrickByBrick)
{
    // More than one piece of the reader's buffer; rows that are whole, short, and long.
    const glm::ivec3 size(24000, 90, 3);
    std::string bytes = "HEADER";
    for (int i = 0; i < size.x * size.y * size.z; ++i) {
        bytes += static_cast<char>((i * 7) >> 8);
        bytes += static_cast<char>(i * 7);
    }
    const std::string file = writeBytes("v.raw", bytes);
    const auto read = readVoxels(file + ".24000,90,3,uint16,6,big");
    ASSERT_TRUE(read.ok()) << read.status.text;
    const VoxelSource& source = *(*read)->getSource();
    const core::Box3i boxes[] = {{{0, 0, 0}, size},
                                 {{5, 1, 1}, {9, 88, 3}},
                                 {{100, 80, 0}, {23000, 90, 1}},
                                 {{0, 40, 2}, {24000, 41, 3}},
                                 {{23999, 89, 2}, {24000, 90, 3}}};
    for (const core::Box3i& box : boxes) {
        const glm::ivec3 n = box.size();
        std::vector<std::uint16_t> values(std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z));
        ASSERT_TRUE(source.read(box, values.data()).ok());
        const std::uint16_t* value = values.data();
        int wrong = 0;
        for (int z = box.min.z; z < box.max.z; ++z)
            for (int y = box.min.y; y < box.max.y; ++y)
                for (int x = box.min.x; x < box.max.x; ++x)
                    wrong +=
                        *value++ != static_cast<std::uint16_t>(((z * size.y + y) * size.x + x) * 7);
        EXPECT_EQ(0, wrong) << box.min.x << " " << n.x;
    }
    std::uint16_t value = 0;
    EXPECT_FALSE(source.read({{0, 0, 2}, {1, 1, 4}}, &value).ok());
    // Nothing of the file is held until a brick is asked for, and then that.
    EXPECT_EQ(0u, (*read)->getCachedBytes());
    ASSERT_TRUE((*read)->setBrickSize({100, 90, 3}).ok());
    EXPECT_TRUE((*read)->getBrick(7));
    EXPECT_EQ(2u * 100 * 90 * 3, (*read)->getCachedBytes());
    // A file that has gone is still there for who has it open; one that is cut short is not.
    std::filesystem::resize_file(file, 1000);
    const Status cut = source.read(boxes[1], std::vector<std::uint16_t>(4 * 87 * 2).data());
    EXPECT_EQ(ErrorCode::FILE_UNREADABLE, cut.code);
    EXPECT_TRUE(names(cut, "v.raw")) << cut.text;
    EXPECT_TRUE(names(cut, std::to_string(bytes.size()))) << cut.text;
}

TEST_F(ReadVoxels, OptionsApplyAndAreKept)
{
    const std::string file = writeBytes("v.raw", std::string(64 * 4, 'x'));
    const auto voxels =
        readVoxels(file + ".4,4,4,float32",
                   optionString("spacing=1,1,1.5 origin=-4,0.5,3 range=-1,2.5 brick=3 "
                                "partial=average_up unit=2 table=none.lut")
                       .get());
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_EQ(osg::Vec3d(1, 1, 1.5), (*voxels)->getSpacing());
    EXPECT_EQ(osg::Vec3d(-4, 0.5, 3), (*voxels)->getOrigin());
    EXPECT_EQ(osg::Vec2d(-1, 2.5), (*voxels)->getRange());
    EXPECT_EQ(8, (*voxels)->getLayout().brickCount());
    EXPECT_EQ((*voxels)->getPartialBricks(), core::PartialBricks::AVERAGE_UP);
    EXPECT_EQ("spacing=1,1,1.5 origin=-4,0.5,3 range=-1,2.5 brick=3,3,3 partial=average_up",
              (*voxels)->getFileOptions());
    const auto again =
        readVoxels((*voxels)->getFileName(), optionString((*voxels)->getFileOptions()).get());
    ASSERT_TRUE(again.ok());
    EXPECT_EQ((*voxels)->getRange(), (*again)->getRange());
    EXPECT_EQ((*voxels)->getBrickSize(), (*again)->getBrickSize());
}

TEST_F(ReadVoxels, BadOptionsAreNamed)
{
    const std::string file = writeBytes("v.raw", std::string(64, 'x')) + ".4,4,4,uint8";
    for (const char* bad : {"spacing=1,1",     "spacing=1,0,1",
                            "spacing=1,nan,1", "spacing=",
                            "origin=0,0,inf",  "origin=a,0,0",
                            "range=5,5",       "range=1",
                            "range=nan,1",     "range=-1e308,1e308",
                            "brick=1",         "brick=1e9",
                            "brick=8,8",       "unit=-1",
                            "unit=x",          "table=",
                            "dataset=",        "dataset=a\"b'c",
                            "channel=-1",      "channel=1.5",
                            "channel=",        "channel=2147483648",
                            "dimensions=x",    "dimensions=a,b,c,d,e"}) {
        const Status status = statusOf(file, bad);
        EXPECT_EQ(ErrorCode::VALUE_INVALID, status.code);
        const std::string option = std::string(bad).substr(0, std::string(bad).find('='));
        const std::string value = std::string(bad).substr(option.size() + 1);
        EXPECT_TRUE(names(status, "option " + option + " is \"" + value + "\"")) << status.text;
        EXPECT_TRUE(names(status, "v.raw")) << status.text;
    }
}

TEST_F(ReadVoxels, OptionsAreWrittenAsTheyAreRead)
{
    for (const char* dataset : {"/a/b", "/with blanks/in it", "/it's", "\"", "spacing=1,1,1"}) {
        io::VoxelOptions options;
        options.dataset = dataset;
        options.channel = 12;
        const Result<io::VoxelOptions> again = io::parseVoxelOptions(options.voxelText());
        ASSERT_TRUE(again.ok()) << again.status.text;
        EXPECT_EQ(again->dataset, options.dataset) << options.voxelText();
        EXPECT_EQ(again->channel, options.channel);
        EXPECT_FALSE(again->spacing);
    }
}

TEST_F(ReadVoxels, APluginThatIsMissingIsNamed)
{
    const io::PluginFormat format{"osgvolumizer_none", "NONE", "libnone (Debian: libnone-dev)"};
    io::VolumeRequest request;
    request.path = "scan.none";
    const std::string needs = "build with libnone (Debian: libnone-dev)";
    const Status status = io::readByPlugin({format}, request).status;
    EXPECT_EQ(ErrorCode::NOT_SUPPORTED, status.code);
    EXPECT_EQ("scan.none is NONE, which this build cannot read: " + needs, status.text);
    EXPECT_EQ(status.text, io::listByPlugin({format}, request).status.text);
    const osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    EXPECT_EQ("scan.none is NONE, which this build cannot write: " + needs,
              io::writeByPlugin({format}, *source, "scan.none").text);
}

TEST_F(ReadVoxels, FilesAreListed)
{
    const std::string file = writeBytes("v.raw", std::string(128, 'x')) + ".4,4,4,uint16";
    const auto one = listVolumes(file);
    ASSERT_TRUE(one.ok()) << one.status.text;
    ASSERT_EQ(1u, one->size());
    EXPECT_EQ(osg::Vec3i(4, 4, 4), one->front().size);
    EXPECT_EQ(VoxelType::UINT16, one->front().type);
    EXPECT_TRUE(one->front().chosen);
    EXPECT_EQ(ErrorCode::FILE_NOT_FOUND, listVolumes(path("none.tif")).status.code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID,
              listVolumes(file, optionString("channel=x").get()).status.code);
}

TEST_F(ReadVoxels, WhatThereIsNothingToChooseByIsRefused)
{
    const std::string file = writeBytes("v.raw", std::string(64, 'x')) + ".4,4,4,uint8";
    EXPECT_EQ(ErrorCode::VALUE_INVALID, statusOf(file, "dataset=a").code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, statusOf(file, "dimensions=x,y,z").code);
    EXPECT_EQ(ErrorCode::INDEX_OUT_OF_RANGE, statusOf(file, "channel=1").code);
    const auto first = readVoxels(file, optionString("channel=0").get());
    EXPECT_TRUE(first.ok()) << first.status.text;
    const OIIO::ImageSpec spec(4, 3, 3, OIIO::TypeDesc::UINT8);
    for (const char* name : {"s1.png", "s2.png"})
        writeImage<std::uint8_t>(name, spec, 10);
    const auto green = readVoxels(path("s#.png"), optionString("channel=1").get());
    ASSERT_TRUE(green.ok()) << green.status.text;
    EXPECT_EQ(11, values<std::uint8_t>(**green)[0]);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, statusOf(path("s#.png"), "dataset=a").code);
}

TEST_F(ReadVoxels, OptionsOfOthersAreLeftToThem)
{
    const std::string file = writeBytes("v.raw", std::string(64, 'x')) + ".4,4,4,uint8";
    const auto voxels =
        readVoxels(file, optionString("fast colour=red spacing=2,2,2 noRotation").get());
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_EQ(osg::Vec3d(2, 2, 2), (*voxels)->getSpacing());
    EXPECT_EQ("spacing=2,2,2", (*voxels)->getFileOptions());
}

TEST_F(ReadVoxels, BadRawNamesAreNamed)
{
    const std::string file = writeBytes("v.raw", std::string(64, 'x'));
    const std::pair<const char*, const char*> cases[] = {
        {".4,4,uint8", "has 3 fields"},
        {".4,4,4,uint8,0,big,1", "has 7 fields"},
        {".4,0,4,uint8", "height \"0\""},
        {".-4,4,4,uint8", "width \"-4\""},
        {".4,4,4.5,uint8", "fields"},
        {".4,4,99999999999,uint8", "depth \"99999999999\""},
        {".4,4,4,uint9", "\"uint9\""},
        {".4,4,4,uint8,-1", "header length \"-1\""},
        {".4,4,4,uint8,0,middle", "byte order \"middle\""},
    };
    for (const auto& c : cases) {
        const Status status = statusOf(file + c.first);
        EXPECT_EQ(ErrorCode::VALUE_INVALID, status.code) << c.first;
        EXPECT_TRUE(names(status, c.second)) << status.text;
    }
}

TEST_F(ReadVoxels, RawFilesOfAnotherSize)
{
    const std::string file = writeBytes("v.raw", std::string(63, 'x'));
    const Status cut = statusOf(file + ".4,4,4,uint8");
    EXPECT_EQ(ErrorCode::FILE_UNREADABLE, cut.code);
    EXPECT_TRUE(names(cut, file) && names(cut, "63 bytes") && names(cut, "need 64")) << cut.text;
    const Status header = statusOf(file + ".4,4,4,uint8,9223372036854775807");
    EXPECT_EQ(ErrorCode::FILE_UNREADABLE, header.code);
    const Status longer = statusOf(file + ".4,4,3,uint8");
    EXPECT_EQ(ErrorCode::SIZE_MISMATCH, longer.code);
    EXPECT_TRUE(names(longer, "63 bytes") && names(longer, "need 48")) << longer.text;
}

TEST_F(ReadVoxels, AbsurdSizesAreRefusedBeforeAllocation)
{
    const std::string file = writeBytes("v.raw", std::string(64, 'x'));
    for (const char* format :
         {".16384,8192,8192,uint8", ".2147483647,2147483647,2147483647,float64"}) {
        const Status status = statusOf(file + format);
        EXPECT_EQ(ErrorCode::FILE_UNREADABLE, status.code);
        EXPECT_TRUE(names(status, "v.raw")) << status.text;
    }
    // A file of 2^40 bytes that takes no room on disk is paged.
    std::error_code failed;
    fs::resize_file(file, std::uintmax_t(1) << 40, failed);
    if (failed) return;
    const auto large = readVoxels(file + ".16384,8192,8192,uint8");
    ASSERT_TRUE(large.ok()) << large.status.text;
    ASSERT_TRUE((*large)->isPaged());
    const core::BrickTree& tree = (*large)->getTree();
    EXPECT_EQ(tree.levelCount(), 9);
    const auto page = (*large)->readPage(tree.index(8, glm::ivec3(0)));
    ASSERT_TRUE(page.ok()) << page.status.text;
    EXPECT_EQ(page->data[0], 0);
    EXPECT_EQ((*large)->getCachedBytes(), 0u);
}

// Its coarser levels are samples of it.
TEST_F(ReadVoxels, RawFilesLargerThanTheirShareOfMemoryArePaged)
{
    constexpr int size = 100;
    std::string bytes = "HEADER";
    for (int i = 0; i < size * size * size; ++i) {
        bytes += static_cast<char>((i * 7) >> 8);
        bytes += static_cast<char>(i * 7);
    }
    const std::string name = writeBytes("v.raw", bytes) + ".100,100,100,uint16,6,big";
    EXPECT_FALSE((*readVoxels(name))->isPaged());
    PagingBudget budget = defaultPagingBudget();
    budget.memoryBytes = 3 << 20;
    ASSERT_TRUE(setPagingBudget(budget));
    const auto voxels = readVoxels(name);
    EXPECT_TRUE(setPagingBudget(defaultPagingBudget()));
    ASSERT_TRUE(voxels.ok() && (*voxels)->isPaged());
    const VoxelSource& source = *(*voxels)->getSource();
    ASSERT_EQ(source.levelCount(), 2);
    const core::Box3i box{{3, 0, 49}, {50, 7, 50}};
    std::vector<std::uint16_t> values(47 * 7);
    ASSERT_TRUE(source.readLevel(1, box, values.data()).ok());
    const std::uint16_t* value = values.data();
    for (int y = 0; y < 7; ++y)
        for (int x = 3; x < 50; ++x)
            ASSERT_EQ(*value++,
                      static_cast<std::uint16_t>(((99 * size + 2 * y + 1) * size + 2 * x + 1) * 7));
    EXPECT_FALSE(source.readLevel(1, {{0, 0, 0}, {51, 1, 1}}, values.data()).ok());
    EXPECT_FALSE(source.readLevel(2, box, values.data()).ok());
}

TEST_F(ReadVoxels, MissingFiles)
{
    for (const char* name :
         {"nothing.tif", "nothing.raw.4,4,4,uint8", "nothing%03d.png", "", "."}) {
        const Status status = statusOf(std::string(name) == "." ? path("none") : name);
        EXPECT_EQ(ErrorCode::FILE_NOT_FOUND, status.code) << name;
    }
    EXPECT_TRUE(names(statusOf("nothing.tif"), "nothing.tif"));
    fs::create_directories(path("empty"));
    const Status empty = statusOf(path("empty"));
    EXPECT_EQ(ErrorCode::FILE_NOT_FOUND, empty.code);
    EXPECT_TRUE(names(empty, "has no images"));
}

TEST_F(ReadVoxels, TruncatedImages)
{
    for (const char* compression : {"none", "zip"}) {
        OIIO::ImageSpec spec(64, 64, 1, OIIO::TypeDesc::UINT16);
        spec.attribute("compression", compression);
        const std::string file = writeImage<std::uint16_t>("cut.tif", spec, 0, 8);
        const auto whole = fs::file_size(file);
        for (const double part : {0.99, 0.5, 0.1, 0.0}) {
            fs::resize_file(file, static_cast<std::uintmax_t>(static_cast<double>(whole) * part));
            const auto voxels = readVoxels(file);
            // What is left may be a shorter file that is whole in itself; else it is refused by
            // name.
            if (voxels.ok()) {
                EXPECT_LT((*voxels)->getSize().z(), 8);
                continue;
            }
            EXPECT_EQ(ErrorCode::FILE_UNREADABLE, voxels.status.code);
            EXPECT_TRUE(names(voxels.status, file)) << voxels.status.text;
            EXPECT_TRUE(names(voxels.status, std::to_string(fs::file_size(file)) + " bytes"))
                << voxels.status.text;
        }
    }
    const std::string png =
        writeImage<std::uint8_t>("cut.png", OIIO::ImageSpec(64, 64, 1, OIIO::TypeDesc::UINT8), 0);
    fs::resize_file(png, fs::file_size(png) / 2);
    {
        const osgVolumizer::test::LeaksOfOthers pngReader; // jumps over a string of its own
        EXPECT_EQ(ErrorCode::FILE_UNREADABLE, statusOf(png).code);
    }
    EXPECT_EQ(ErrorCode::FILE_UNREADABLE, statusOf(writeBytes("text.tif", "no image")).code);
}

TEST_F(ReadVoxels, PlainImagesThatClaimMoreThanTheyHold)
{
    // The header of a plain TIFF, made to say 60000 rows where 64 are stored.
    const std::string file =
        writeImage<std::uint8_t>("liar.tif", plain(64, 64, 1, OIIO::TypeDesc::UINT8), 0);
    std::ifstream in(file, std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(in)), {});
    std::uint32_t directory = 0;
    std::memcpy(&directory, bytes.data() + 4, 4);
    std::uint16_t entries = 0;
    std::memcpy(&entries, bytes.data() + directory, 2);
    for (int i = 0; i < entries; ++i) {
        char* entry = &bytes[directory + 2 + 12 * static_cast<std::uint32_t>(i)];
        std::uint16_t tag = 0;
        std::memcpy(&tag, entry, 2);
        const std::uint32_t rows = 60000, type = 4, count = 1;
        if (tag != 257) continue;
        std::memcpy(entry + 2, &type, 2);
        std::memcpy(entry + 4, &count, 4);
        std::memcpy(entry + 8, &rows, 4);
    }
    writeBytes("liar.tif", bytes);
    const Status status = statusOf(file);
    EXPECT_EQ(ErrorCode::FILE_UNREADABLE, status.code);
    EXPECT_TRUE(names(status, file)) << status.text;
}

// SGI's tag for several slices in a page, which OpenImageIO overlooks: no volume with slices
// missing.
TEST_F(ReadVoxels, SlicesWithinAPageAreRefused)
{
    const std::uint16_t entries[][3] = {{256, 4, 4},  {257, 4, 3}, {258, 3, 8},  {259, 3, 1},
                                        {262, 3, 1},  {273, 4, 0}, {277, 3, 1},  {278, 4, 3},
                                        {279, 4, 24}, {284, 3, 1}, {32997, 4, 2}};
    const std::uint16_t count = 11;
    std::string bytes("II*\0\x08\0\0\0", 8);
    bytes.append(reinterpret_cast<const char*>(&count), 2);
    for (const auto& e : entries) {
        const std::uint32_t one = 1, value = e[0] == 273 ? 8 + 2 + 12 * count + 4 : e[2];
        bytes.append(reinterpret_cast<const char*>(e), 4);
        bytes.append(reinterpret_cast<const char*>(&one), 4);
        bytes.append(reinterpret_cast<const char*>(&value), 4);
    }
    bytes.append(4 + 24, '\0');
    const Status status = statusOf(writeBytes("sgi.tif", bytes));
    EXPECT_EQ(ErrorCode::NOT_SUPPORTED, status.code);
    EXPECT_TRUE(names(status, "sgi.tif") && names(status, "ImageDepth")) << status.text;
}

TEST_F(ReadVoxels, UnequalSlices)
{
    writeImage<std::uint8_t>("s1.png", OIIO::ImageSpec(4, 4, 1, OIIO::TypeDesc::UINT8), 0);
    writeImage<std::uint8_t>("s2.png", OIIO::ImageSpec(4, 5, 1, OIIO::TypeDesc::UINT8), 0);
    const Status size = statusOf(path(""));
    EXPECT_EQ(ErrorCode::SIZE_MISMATCH, size.code);
    EXPECT_TRUE(names(size, "s2.png") && names(size, "4,5,1") && names(size, "4,4,1")) << size.text;
    writeImage<std::uint16_t>("s2.png", OIIO::ImageSpec(4, 4, 1, OIIO::TypeDesc::UINT16), 0);
    EXPECT_EQ(ErrorCode::SIZE_MISMATCH, statusOf(path("s#.png")).code);
    auto out = OIIO::ImageOutput::create(path("pages.tif"));
    const OIIO::ImageSpec first = plain(4, 4, 1, OIIO::TypeDesc::UINT8);
    const OIIO::ImageSpec second = plain(4, 2, 1, OIIO::TypeDesc::UINT8);
    const std::vector<std::uint8_t> pixels(16);
    ASSERT_TRUE(out->open(path("pages.tif"), first));
    ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
    ASSERT_TRUE(out->open(path("pages.tif"), second, OIIO::ImageOutput::AppendSubimage));
    ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT8, pixels.data()));
    out->close();
    const Status pages = statusOf(path("pages.tif"));
    EXPECT_EQ(ErrorCode::SIZE_MISMATCH, pages.code);
    EXPECT_TRUE(names(pages, "subimage 1")) << pages.text;
}

TEST(ReadVoxelsData, TheShippedHead)
{
    const auto voxels = readVoxels(OSGVOLUMIZER_SOURCE_DIR "/data/head.tif");
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_EQ(osg::Vec3i(128, 128, 84), (*voxels)->getSize());
    EXPECT_EQ(VoxelType::UINT8, (*voxels)->getType());
    const std::vector<std::uint8_t> v = values<std::uint8_t>(**voxels);
    EXPECT_EQ(19284185u, std::accumulate(v.begin(), v.end(), 0u));
}

} // namespace ReadVoxelsTest
