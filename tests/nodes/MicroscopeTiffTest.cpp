// TIFF as microscopes write them: see io/PageLayout.h.
#include <osgVolumizer/Paging.h>
#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/WriteVoxels.h>
#include <osgVolumizer/core/voxels/VoxelData.h>

#include "../support/FolderTest.h"

#include <OpenImageIO/imageio.h>
#include <glm/geometric.hpp>
#ifdef OSGVOLUMIZER_HAVE_TIFF
#include <tiffio.h>
#endif

#include <cstring>

namespace MicroscopeTiffTest {

using namespace osgVolumizer;

namespace {

constexpr int WIDTH = 10, HEIGHT = 8;

class MicroscopeTiff : public support::FolderTest
{
protected:
    /// Pages whose pixels are all of the page's number, times 100.
    std::string write(const std::string& name, int pages, const std::string& description,
                      float resolution = 0.0f, const char* unit = "none") const
    {
        OIIO::ImageSpec spec(WIDTH, HEIGHT, 1, OIIO::TypeDesc::UINT16);
        spec.attribute("ImageDescription", description);
        if (resolution > 0.0f) {
            spec.attribute("XResolution", resolution);
            spec.attribute("YResolution", resolution);
            spec.attribute("ResolutionUnit", unit);
        }
        const auto out = OIIO::ImageOutput::create(path(name));
        for (int p = 0; p < pages; ++p) {
            const std::vector<std::uint16_t> pixels(WIDTH * HEIGHT,
                                                    static_cast<std::uint16_t>(100 * p));
            EXPECT_TRUE(
                out->open(path(name), spec,
                          p ? OIIO::ImageOutput::AppendSubimage : OIIO::ImageOutput::Create));
            EXPECT_TRUE(out->write_image(OIIO::TypeDesc::UINT16, pixels.data()));
        }
        return path(name);
    }
};

void addNumber(std::string& bytes, std::uint32_t value, int size)
{
    for (int i = 0; i < size; ++i)
        bytes += static_cast<char>(value >> (8 * i) & 255);
}

// A TIFF up to its pixels: tag, type and value of each entry.
std::string tiffOf(const std::uint32_t (*entries)[3], std::uint32_t count)
{
    std::string bytes("II*\0\10\0\0\0", 8);
    addNumber(bytes, count, 2);
    for (std::uint32_t i = 0; i < count; ++i) {
        addNumber(bytes, entries[i][0], 2);
        addNumber(bytes, entries[i][1], 2);
        addNumber(bytes, 1, 4);
        addNumber(bytes, entries[i][2], 4);
    }
    addNumber(bytes, 0, 4);
    return bytes;
}

osg::ref_ptr<Voxels> read(const std::string& file, const std::string& options = {})
{
    const osg::ref_ptr<osgDB::Options> said = new osgDB::Options(options);
    const auto voxels = readVoxels(file, said.get());
    EXPECT_TRUE(voxels.ok()) << voxels.status.text;
    return voxels.ok() ? voxels->get() : new Voxels;
}

// The pages that the slices of a step are.
std::vector<int> pagesOf(const Voxels& voxels, int step = 0)
{
    std::vector<int> pages;
    for (int z = 0; z < voxels.getSize().z(); ++z) {
        std::uint16_t value = 0;
        EXPECT_TRUE(voxels.getSource()->readStep(step, 0, {{3, 5, z}, {4, 6, z + 1}}, &value).ok());
        pages.push_back(value / 100);
    }
    return pages;
}

void expectSpacing(const osg::Vec3d& expected, const Voxels& voxels)
{
    EXPECT_LT((voxels.getSpacing() - expected).length(), 1e-6) << voxels.getSpacing().x();
}

using Pages = std::vector<int>;
const std::string OME_START = "<?xml version=\"1.0\" encoding=\"UTF-8\"?><OME "
                              "xmlns=\"http://www.openmicroscopy.org/Schemas/OME/2016-06\"><Image "
                              "ID=\"Image:0\"><Pixels ID=\"Pixels:0\" Type=\"uint16\" SizeX=\"10\" "
                              "SizeY=\"8\" ";

} // namespace

TEST_F(MicroscopeTiff, ImageJSaysHowFarSlicesAreApart)
{
    const std::string start = "ImageJ=1.53t\nimages=3\nslices=3\nhyperstack=true\n";
    expectSpacing({0.5, 0.5, 2.5}, *read(write("a.tif", 3, start + "unit=um\nspacing=2.5\n", 2)));
    expectSpacing({0.5, 0.5, 2.5},
                  *read(write("b.tif", 3, start + "unit=\\u00B5m\nspacing=2.5\n", 2)));
    const auto listed = listVolumes(path("b.tif"));
    ASSERT_TRUE(listed.ok()) << listed.status.text;
    EXPECT_EQ("lengths in micrometres", listed->front().text);
    expectSpacing({500, 500, 2500}, *read(write("c.tif", 3, start + "unit=mm\nspacing=2.5\n", 2)));
    expectSpacing({0.5, 0.5, 2.5}, *read(write("d.tif", 3, start + "spacing=2.5\n", 2)));
    expectSpacing({1, 1, 1}, *read(write("e.tif", 3, start)));
    // Dots per inch of other programs say nothing of voxels.
    expectSpacing({1, 1, 1}, *read(write("f.tif", 3, "a scan", 300, "in")));
}

TEST_F(MicroscopeTiff, ChannelsAndTimeStepsOfImageJAreNoSlices)
{
    const std::string channels =
        write("c.tif", 6, "ImageJ=1.11a\nimages=6\nchannels=2\nslices=3\nhyperstack=true\n");
    EXPECT_EQ((Pages{0, 2, 4}), pagesOf(*read(channels)));
    EXPECT_EQ((Pages{1, 3, 5}), pagesOf(*read(channels, "channel=1")));
    const auto listed = listVolumes(channels);
    ASSERT_TRUE(listed.ok()) << listed.status.text;
    EXPECT_EQ(2, listed->front().channels);
    EXPECT_EQ(3, listed->front().size.z());
    const osg::ref_ptr<osgDB::Options> third = new osgDB::Options("channel=2");
    const Status status = readVoxels(channels, third.get()).status;
    EXPECT_EQ(ErrorCode::INDEX_OUT_OF_RANGE, status.code);
    EXPECT_NE(std::string::npos, status.text.find("has no channel 2, but 2")) << status.text;

    const osg::ref_ptr<Voxels> times =
        read(write("t.tif", 6, "ImageJ=1.11a\nimages=6\nslices=3\nframes=2\nhyperstack=true\n"));
    ASSERT_EQ(2, times->getStepCount());
    EXPECT_EQ((Pages{0, 1, 2}), pagesOf(*times));
    EXPECT_EQ((Pages{3, 4, 5}), pagesOf(*times, 1));
    // Numbers that do not fit are not believed.
    EXPECT_EQ((Pages{0, 1, 2, 3}),
              pagesOf(*read(write("w.tif", 4, "ImageJ=1.11a\nimages=6\nchannels=2\nslices=3\n"))));
}

TEST_F(MicroscopeTiff, OmeSaysTheOrderOfDimensionsAndPhysicalSizes)
{
    const std::string sizes =
        "SizeZ=\"3\" SizeC=\"2\" SizeT=\"2\" PhysicalSizeX=\"500\" "
        "PhysicalSizeXUnit=\"nm\" PhysicalSizeY=\"0.5\" PhysicalSizeZ=\"2.5\" "
        "PhysicalSizeZUnit=\"\xc2\xb5m\" ";
    const std::string end = "></Pixels></Image></OME>";
    struct Case
    {
        const char* order;
        Pages first, last; // of channel 0 at time 0, of channel 1 at time 1
    } const cases[] = {{"XYZCT", {0, 1, 2}, {9, 10, 11}}, {"XYCZT", {0, 2, 4}, {7, 9, 11}},
                       {"XYTZC", {0, 2, 4}, {7, 9, 11}},  {"XYCTZ", {0, 4, 8}, {3, 7, 11}},
                       {"XYZTC", {0, 1, 2}, {9, 10, 11}}, {"XYTCZ", {0, 4, 8}, {3, 7, 11}}};
    for (const Case& c : cases) {
        const std::string file =
            write("a.ome.tif", 12, OME_START + sizes + "DimensionOrder=\"" + c.order + "\"" + end);
        const osg::ref_ptr<Voxels> voxels = read(file);
        expectSpacing({0.5, 0.5, 2.5}, *voxels);
        ASSERT_EQ(2, voxels->getStepCount());
        EXPECT_EQ(c.first, pagesOf(*voxels)) << c.order;
        EXPECT_EQ(c.last, pagesOf(*read(file, "channel=1"), 1)) << c.order;
    }
}

TEST_F(MicroscopeTiff, OmePlanesMayLieInAnyPage)
{
    std::string planes;
    for (int z = 0; z < 3; ++z)
        planes += "<TiffData FirstZ=\"" + std::to_string(z) + "\" IFD=\"" + std::to_string(2 - z) +
                  "\" PlaneCount=\"1\"><UUID FileName=\"a.tif\">urn</UUID></TiffData>";
    const std::string file =
        write("a.tif", 3,
              OME_START + "SizeZ=\"3\" SizeC=\"1\" SizeT=\"1\" DimensionOrder=\"XYZCT\">" + planes +
                  "</Pixels></Image></OME>");
    EXPECT_EQ((Pages{2, 1, 0}), pagesOf(*read(file)));
    // Where other planes lie in other files, those that are here are slices.
    const std::string part =
        write("b.tif", 3,
              OME_START + "SizeZ=\"3\" SizeC=\"2\" SizeT=\"1\" DimensionOrder=\"XYZCT\"/></OME>");
    EXPECT_EQ((Pages{0, 1, 2}), pagesOf(*read(part)));
}

// Whichever of them is white.
TEST_F(MicroscopeTiff, BitsAreZeroAndOne)
{
    for (const std::uint32_t photometric : {0, 1})
        for (const bool told : {true, false}) { // one bit is what is meant where nothing is said
            constexpr std::uint32_t COUNT = 8, DATA = 8 + 2 + 12 * COUNT + 4;
            const std::uint32_t entries[COUNT][3] = {
                {256, 4, 20}, {257, 4, 16},          {told ? 258u : 255u, 3, 1},
                {259, 3, 1},  {262, 3, photometric}, {273, 4, DATA},
                {278, 4, 16}, {279, 4, 48}};
            std::string bytes = tiffOf(entries, COUNT);
            for (int y = 0; y < 16; ++y)
                bytes += {'\x55', '\x55', '\x50'};
            const std::string file = writeBytes("bits.tif", bytes);
#ifndef OSGVOLUMIZER_HAVE_TIFF
            if (!told) {
                EXPECT_EQ(ErrorCode::NOT_SUPPORTED, readVoxels(file).status.code);
                continue;
            }
#endif
            const Voxels::Block block = read(file)->getBrick(0);
            ASSERT_EQ(320u, block.bytes);
            for (std::size_t i = 0; i < 320; ++i)
                ASSERT_EQ(i % 2, block.data[i]) << i << " " << photometric << " " << told;
        }
}

TEST_F(MicroscopeTiff, ChannelsOfAnyWidthKeepTheirValues)
{
    for (const int channels : {2, 3, 4, 5}) {
        OIIO::ImageSpec spec(4, 3, channels, OIIO::TypeDesc::UINT16);
        std::vector<std::uint16_t> pixels(std::size_t(12 * channels));
        for (std::size_t i = 0; i < pixels.size(); ++i)
            pixels[i] = static_cast<std::uint16_t>(1000 * i + 7);
        const auto out = OIIO::ImageOutput::create(path("c.tif"));
        ASSERT_TRUE(out->open(path("c.tif"), spec));
        ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT16, pixels.data()));
        out->close();
        for (int c = 0; c < channels; ++c) {
            const osg::ref_ptr<Voxels> voxels = read(path("c.tif"), "channel=" + std::to_string(c));
            ASSERT_EQ(VoxelType::UINT16, voxels->getType());
            std::vector<std::uint16_t> values(12), expected;
            ASSERT_TRUE(voxels->getSource()->read({{0, 0, 0}, {4, 3, 1}}, values.data()).ok());
            for (int i = 0; i < 12; ++i)
                expected.push_back(pixels[std::size_t(i * channels + c)]);
            EXPECT_EQ(expected, values) << channels << " " << c;
        }
    }
}

TEST_F(MicroscopeTiff, WhatIsCutShortIsRefused)
{
    const std::string file = write("a.tif", 12, "");
    for (const double share : {0.5, 0.8, 0.95}) {
        std::filesystem::copy_file(file, path("cut.tif"),
                                   std::filesystem::copy_options::overwrite_existing);
        std::filesystem::resize_file(
            path("cut.tif"), std::uintmax_t(share * double(std::filesystem::file_size(file))));
        const auto voxels = readVoxels(path("cut.tif"));
        if (voxels.ok()) { // what is lost is no page
            EXPECT_EQ((Pages{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}), pagesOf(**voxels)) << share;
        } else {
            EXPECT_EQ(ErrorCode::FILE_UNREADABLE, voxels.status.code) << share;
        }
        EXPECT_TRUE(share > 0.9 || !voxels.ok()) << share;
    }
}

TEST_F(MicroscopeTiff, SixteenBitsOfImageJMayBeSigned)
{
    const osg::ref_ptr<Voxels> voxels =
        read(write("s.tif", 3, "ImageJ=1.53t\nimages=3\nslices=3\ncf=0\nc0=-32768\nc1=1\n"));
    ASSERT_EQ(VoxelType::INT16, voxels->getType());
    std::int16_t value = 0;
    ASSERT_TRUE(voxels->getSource()->read({{0, 0, 2}, {1, 1, 3}}, &value).ok());
    EXPECT_EQ(200 - 32768, value);
}

TEST_F(MicroscopeTiff, FilesLargerThanTheirShareOfMemoryAreReadAsTheyAreAskedFor)
{
    constexpr int EDGE = 256, SLICES = 9; // more than a megabyte
    const auto valueAt = [](int x, int y, int z) {
        return static_cast<std::uint16_t>(x + 257 * y + 7000 * z);
    };
    OIIO::ImageSpec spec(EDGE, EDGE, 1, OIIO::TypeDesc::UINT16);
    const auto out = OIIO::ImageOutput::create(path("a.tif"));
    for (int z = 0; z < SLICES; ++z) {
        std::vector<std::uint16_t> pixels;
        for (int i = 0; i < EDGE * EDGE; ++i)
            pixels.push_back(valueAt(i % EDGE, i / EDGE, z));
        ASSERT_TRUE(out->open(path("a.tif"), spec,
                              z ? OIIO::ImageOutput::AppendSubimage : OIIO::ImageOutput::Create));
        ASSERT_TRUE(out->write_image(OIIO::TypeDesc::UINT16, pixels.data()));
    }
    out->close();
    const PagingBudget before = getPagingBudget();
    PagingBudget small = before;
    small.memoryBytes = 1 << 20;
    ASSERT_TRUE(setPagingBudget(small).ok());
    const osg::ref_ptr<Voxels> voxels = read(path("a.tif"));
    ASSERT_TRUE(setPagingBudget(before).ok());
    ASSERT_TRUE(voxels->isPaged());
    const VoxelSource& source = *voxels->getSource();
    for (int z : {0, 7, SLICES - 1}) {
        std::vector<std::uint16_t> part(4 * 150);
        ASSERT_TRUE(source.read({{200, 100, z}, {204, 250, z + 1}}, part.data()).ok());
        for (int i = 0; i < 600; ++i)
            ASSERT_EQ(valueAt(200 + i % 4, 100 + i / 4, z), part[std::size_t(i)]) << i;
    }
    // Of what a sample of a level stands for, the one in the middle; as readThinned() has it.
    const core::Box3i all{{0, 0, 0}, {128, 128, 5}};
    std::vector<std::uint16_t> level(128 * 128 * 5), expected(level);
    ASSERT_TRUE(source.readLevel(1, all, level.data()).ok());
    ASSERT_TRUE(source.readThinned(1, all, expected.data()).ok());
    EXPECT_EQ(expected, level);
    EXPECT_EQ(valueAt(255, 255, 8), level.back());
    EXPECT_FALSE(source.read({{0, 0, SLICES - 1}, {1, 1, SLICES + 1}}, level.data()).ok());
}

TEST_F(MicroscopeTiff, WrittenVolumesKeepWhereTheyLie)
{
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    VoxelSource::Description d;
    d.size = {5, 4, 3};
    d.type = VoxelType::UINT16;
    d.spacing = {0.1, 0.7, 1.0 / 3.0};
    d.origin = {-12.125, 1e-3, 98765.4321};
    d.axes[0] = glm::normalize(glm::dvec3(1, 0.1, 0));
    d.axes[1] = glm::normalize(glm::dvec3(0, 1, 0.3));
    ASSERT_TRUE(source->allocate(d).ok());
    ASSERT_TRUE(writeVoxels(*source, path("a.tif")).ok());
    const VoxelSource::Description again = read(path("a.tif"))->getSource()->describe();
    EXPECT_EQ(d.size, again.size);
    EXPECT_EQ(d.spacing, again.spacing);
    EXPECT_EQ(d.origin, again.origin);
    EXPECT_EQ(d.axes, again.axes);
}

#ifdef OSGVOLUMIZER_HAVE_TIFF

TEST_F(MicroscopeTiff, TilesMayHaveDepth)
{
    const glm::ivec3 size(40, 35, 33), tile(16, 16, 16);
    const auto open = [&](const char* name, int length, int depth, int compression) {
        TIFF* tiff = TIFFOpen(path(name).c_str(), "w");
        TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, depth > 1 ? size.x : tile.x);
        TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, depth > 1 ? size.y : length);
        TIFFSetField(tiff, TIFFTAG_TILEWIDTH, tile.x);
        TIFFSetField(tiff, TIFFTAG_TILELENGTH, length);
        if (depth > 1) {
            TIFFSetField(tiff, TIFFTAG_IMAGEDEPTH, size.z);
            TIFFSetField(tiff, TIFFTAG_TILEDEPTH, depth);
        }
        TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, 16);
        TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
        TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
        TIFFSetField(tiff, TIFFTAG_COMPRESSION, compression);
        return tiff;
    };
    // libtiff compresses flat tiles only: those that are as long as the deep ones are in all.
    const auto packed = [&](const std::vector<std::uint16_t>& box, int compression) {
        TIFF* flat = open("flat.tif", tile.y * tile.z, 1, compression);
        EXPECT_GT(TIFFWriteEncodedTile(flat, 0, const_cast<std::uint16_t*>(box.data()),
                                       tmsize_t(box.size() * 2)),
                  0);
        TIFFClose(flat);
        flat = TIFFOpen(path("flat.tif").c_str(), "r");
        std::vector<unsigned char> bytes(std::size_t(TIFFGetStrileByteCount(flat, 0)));
        TIFFReadRawTile(flat, 0, bytes.data(), tmsize_t(bytes.size()));
        TIFFClose(flat);
        return bytes;
    };
    for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW}) {
        TIFF* tiff = open("v.tif", tile.y, tile.z, compression);
        std::vector<std::uint16_t> box(16 * 16 * 16);
        std::uint32_t index = 0;
        for (int z = 0; z < size.z; z += 16)
            for (int y = 0; y < size.y; y += 16)
                for (int x = 0; x < size.x; x += 16) {
                    for (int i = 0; i < 4096; ++i)
                        box[std::size_t(i)] = static_cast<std::uint16_t>(
                            (x + i % 16) + 50 * (y + i / 16 % 16) + 1800 * (z + i / 256));
                    std::vector<unsigned char> bytes = packed(box, compression);
                    ASSERT_GT(TIFFWriteRawTile(tiff, index++, bytes.data(), tmsize_t(bytes.size())),
                              0);
                }
        TIFFClose(tiff);
        const osg::ref_ptr<Voxels> voxels = read(path("v.tif"));
        ASSERT_EQ(osg::Vec3i(40, 35, 33), voxels->getSize());
        const Voxels::Block held = voxels->getBrick(0);
        for (std::int64_t i = 0; i < core::sampleCount(size); ++i) {
            const std::int64_t expected = i % 40 + 50 * (i / 40 % 35) + 1800 * (i / 1400);
            std::uint16_t value = 0;
            std::memcpy(&value, held.data + 2 * i, 2);
            ASSERT_EQ(static_cast<std::uint16_t>(expected), value) << i;
        }
    }
    std::filesystem::resize_file(path("v.tif"), 300);
    EXPECT_EQ(ErrorCode::FILE_UNREADABLE, readVoxels(path("v.tif")).status.code);
}

// ImageJ's way with more than 4 GB, in small.
TEST_F(MicroscopeTiff, AllSlicesBehindOneDirectory)
{
    const std::string text = "ImageJ=1.53t\nimages=12\nchannels=2\nslices=3\nframes=2\nspacing=2\n";
    constexpr std::uint32_t COUNT = 10, TEXT = 8 + 2 + 12 * COUNT + 4;
    const auto length = static_cast<std::uint32_t>(text.size() + 1), data = TEXT + length;
    const std::uint32_t entries[COUNT][3] = {{256, 4, WIDTH},  {257, 4, HEIGHT},
                                             {258, 3, 16},     {259, 3, 1},
                                             {262, 3, 1},      {270, 2, TEXT},
                                             {273, 4, data},   {277, 3, 1},
                                             {278, 4, HEIGHT}, {279, 4, WIDTH * HEIGHT * 2}};
    std::string bytes = tiffOf(entries, COUNT);
    // The text is as long as it is.
    std::string count;
    addNumber(count, length, 4);
    bytes.replace(8 + 2 + 12 * 5 + 4, 4, count);
    bytes += text + '\0';
    for (std::uint32_t page = 0; page < 12; ++page)
        for (int i = 0; i < WIDTH * HEIGHT; ++i)
            addNumber(bytes, 100 * page, 2);
    const std::string file = writeBytes("a.tif", bytes);
    const osg::ref_ptr<Voxels> voxels = read(file, "channel=1");
    ASSERT_EQ(osg::Vec3i(WIDTH, HEIGHT, 3), voxels->getSize());
    ASSERT_EQ(2, voxels->getStepCount());
    expectSpacing({1, 1, 2}, *voxels);
    EXPECT_EQ((Pages{1, 3, 5}), pagesOf(*voxels));
    EXPECT_EQ((Pages{7, 9, 11}), pagesOf(*voxels, 1));
    bytes.resize(bytes.size() - 1);
    const Status status = readVoxels(writeBytes("cut.tif", bytes)).status;
    EXPECT_EQ(ErrorCode::FILE_UNREADABLE, status.code) << status.text;
}

#endif

} // namespace MicroscopeTiffTest
