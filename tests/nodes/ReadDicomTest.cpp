// DICOM files, made here element by element.
#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/VolumeGeometry.h>
#include <osgVolumizer/core/voxels/VoxelData.h>

#include "../support/FolderTest.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>
#include <osg/Notify>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>

namespace ReadDicomTest {

using namespace osgVolumizer;
namespace fs = std::filesystem;

namespace {

std::string number16(int v)
{
    return {static_cast<char>(v & 255), static_cast<char>(v >> 8 & 255)};
}

std::string number32(std::uint32_t v)
{
    return number16(static_cast<int>(v & 0xffff)) + number16(static_cast<int>(v >> 16));
}

std::string element(int group, int tag, const std::string& vr, std::string value, bool implicit)
{
    if (value.size() % 2) value += vr == "UI" || vr == "OB" ? '\0' : ' ';
    const std::string head = number16(group) + number16(tag);
    const std::uint32_t length = static_cast<std::uint32_t>(value.size());
    if (implicit) return head + number32(length) + value;
    if (vr == "OB" || vr == "OW" || vr == "SQ" || vr == "UN")
        return head + vr + number16(0) + number32(length) + value;
    return head + vr + number16(static_cast<int>(length)) + value;
}

/// A file to be; every test changes what it is about.
struct Dicom
{
    int columns = 4, rows = 3, frames = 1;
    int allocated = 16, stored = 16, highBit = 15, representation = 0;
    std::string slope, intercept, spacing, thickness, position, instance, series;
    std::string orientation = "1\\0\\0\\0\\1\\0";
    std::string syntax = "1.2.840.10008.1.2.1";
    std::string pixels;
    std::string before; ///< more elements, in front of the image's own

    void setValues(const std::vector<int>& values)
    {
        pixels.clear();
        for (const int v : values)
            pixels += allocated == 8    ? std::string(1, static_cast<char>(v))
                      : allocated == 16 ? number16(v)
                                        : number32(static_cast<std::uint32_t>(v));
    }
    std::string bytes() const
    {
        const bool implicit = syntax == "1.2.840.10008.1.2";
        const auto add = [&](int group, int tag, const char* vr, const std::string& value) {
            return value.empty() ? value : element(group, tag, vr, value, implicit);
        };
        std::string meta = element(2, 1, "OB", std::string("\0\1", 2), false) +
                           element(2, 0x10, "UI", syntax, false);
        meta = element(2, 0, "UL", number32(static_cast<std::uint32_t>(meta.size())), false) + meta;
        std::string body = before + add(0x18, 0x50, "DS", thickness) +
                           add(0x20, 0xe, "UI", series) + add(0x20, 0x13, "IS", instance) +
                           add(0x20, 0x32, "DS", position);
        if (!position.empty()) body += add(0x20, 0x37, "DS", orientation);
        body += add(0x28, 2, "US", number16(1));
        if (frames != 1) body += add(0x28, 8, "IS", std::to_string(frames));
        body += add(0x28, 0x10, "US", number16(rows)) + add(0x28, 0x11, "US", number16(columns)) +
                add(0x28, 0x30, "DS", spacing) + add(0x28, 0x100, "US", number16(allocated)) +
                add(0x28, 0x101, "US", number16(stored)) +
                add(0x28, 0x102, "US", number16(highBit)) +
                add(0x28, 0x103, "US", number16(representation)) +
                add(0x28, 0x1052, "DS", intercept) + add(0x28, 0x1053, "DS", slope);
        return std::string(128, '\0') + "DICM" + meta + body +
               element(0x7fe0, 0x10, "OW", pixels, implicit);
    }
};

class ReadDicom : public support::FolderTest
{
protected:
    void SetUp() override
    {
        FolderTest::SetUp();
        values.resize(12);
        std::iota(values.begin(), values.end(), -5);
        file.setValues(values);
    }
    std::string write(const std::string& name, const std::string& bytes) const
    {
        return writeBytes(name, bytes);
    }
    static std::vector<double> read(const std::string& name, VoxelType type)
    {
        const auto voxels = readVoxels(name);
        EXPECT_TRUE(voxels.ok()) << voxels.status.text;
        if (!voxels.ok()) return {};
        EXPECT_STREQ(voxelTypeName(type), voxelTypeName((*voxels)->getType()));
        std::vector<double> v;
        const Voxels::Block block = (*voxels)->getBrick(0);
        const core::VoxelView view{block.data, (*voxels)->getType(), 1,
                                   (*voxels)->getLayout().size()};
        for (std::int64_t i = 0; i < core::sampleCount(view.size); ++i)
            v.push_back(core::voxelValue(view, i));
        return v;
    }
    Status statusOf(const Dicom& dicom) const
    {
        const auto voxels = readVoxels(write("bad.dcm", dicom.bytes()));
        EXPECT_FALSE(voxels.ok());
        EXPECT_NE(std::string::npos, voxels.status.text.find("bad.dcm")) << voxels.status.text;
        return voxels.status;
    }

    Dicom file;
    std::vector<int> values; ///< -5 ... 6
};

std::vector<double> scaled(const std::vector<int>& values, double slope, double intercept)
{
    std::vector<double> v;
    for (const int i : values)
        v.push_back(slope * i + intercept);
    return v;
}

} // namespace

TEST_F(ReadDicom, SignedValuesAsTheyAre)
{
    file.representation = 1;
    EXPECT_EQ(scaled(values, 1, 0), read(write("a.dcm", file.bytes()), VoxelType::INT16));
    file.syntax = "1.2.840.10008.1.2"; // implicit
    EXPECT_EQ(scaled(values, 1, 0), read(write("b.dcm", file.bytes()), VoxelType::INT16));
}

TEST_F(ReadDicom, RescaledToCalibratedValues)
{
    file.representation = 1;
    file.intercept = "-1024";
    file.slope = "1";
    EXPECT_EQ(scaled(values, 1, -1024), read(write("ct.dcm", file.bytes()), VoxelType::INT32));
    file.stored = 12, file.highBit = 11;
    EXPECT_EQ(scaled(values, 1, -1024), read(write("ct12.dcm", file.bytes()), VoxelType::INT16));
    file.slope = "0.5 ";
    EXPECT_EQ(scaled(values, 0.5, -1024), read(write("pet.dcm", file.bytes()), VoxelType::FLOAT32));
}

TEST_F(ReadDicom, BitsAroundTheStoredOnesDoNotCount)
{
    // 12 bits in the upper part of 16, with an overlay in the lowest.
    std::vector<int> shifted;
    for (int i = 0; i < 12; ++i)
        shifted.push_back((300 * i) << 4 | 9);
    file.setValues(shifted);
    file.stored = 12, file.highBit = 15;
    std::vector<double> expected;
    for (int i = 0; i < 12; ++i)
        expected.push_back(300 * i);
    EXPECT_EQ(expected, read(write("a.dcm", file.bytes()), VoxelType::UINT16));
}

TEST_F(ReadDicom, EveryWidth)
{
    file.allocated = file.stored = 8, file.highBit = 7;
    file.setValues(values);
    std::vector<double> expected;
    for (const int v : values)
        expected.push_back(v & 255);
    EXPECT_EQ(expected, read(write("a.dcm", file.bytes()), VoxelType::UINT8));
    file.allocated = file.stored = 32, file.highBit = 31, file.representation = 1;
    file.setValues(values);
    EXPECT_EQ(scaled(values, 1, 0), read(write("b.dcm", file.bytes()), VoxelType::INT32));
}

TEST_F(ReadDicom, FramesAreSlices)
{
    file.columns = 2, file.rows = 3, file.frames = 2;
    file.representation = 1;
    file.spacing = "0.8\\0.5"; // between rows first
    file.thickness = "2.5";
    const auto voxels = readVoxels(write("a.dcm", file.bytes()));
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_EQ(osg::Vec3i(2, 3, 2), (*voxels)->getSize());
    EXPECT_EQ(osg::Vec3d(0.5, 0.8, 2.5), (*voxels)->getSpacing());
    EXPECT_EQ(scaled(values, 1, 0), read(path("a.dcm"), VoxelType::INT16));
}

TEST_F(ReadDicom, ASeriesIsSortedAlongThePatient)
{
    file.representation = 1;
    file.spacing = "1\\1";
    // Names, instances and places in three different orders; files without extension.
    const std::tuple<const char*, const char*, double, int> slices[] = {
        {"IM1", "3", 30.0, 2}, {"IM2", "1", 27.0, 1}, {"IM10", "2", 24.0, 0}};
    for (const auto& [name, instance, z, order] : slices) {
        file.instance = instance;
        file.position = "-100\\-100\\" + std::to_string(z);
        std::vector<int> v(12);
        std::iota(v.begin(), v.end(), 100 * order);
        file.setValues(v);
        write(name, file.bytes());
    }
    const auto voxels = readVoxels(path(""));
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_EQ(osg::Vec3d(1, 1, 3), (*voxels)->getSpacing());
    std::vector<double> expected;
    for (int s = 0; s < 3; ++s)
        for (int i = 0; i < 12; ++i)
            expected.push_back(100 * s + i);
    EXPECT_EQ(expected, read(path(""), VoxelType::INT16));
    // The option string has the last word.
    osg::ref_ptr<osgDB::Options> options = new osgDB::Options("spacing=2,2,2");
    EXPECT_EQ(osg::Vec3d(2, 2, 2), (*readVoxels(path(""), options.get()))->getSpacing());
}

TEST_F(ReadDicom, AxesPointWhereTheHeaderSays)
{
    const auto axes = [&](const std::string& orientation) {
        file.position = "1\\2\\3";
        file.orientation = orientation;
        const auto voxels = readVoxels(write("a.dcm", file.bytes()));
        EXPECT_TRUE(voxels.ok()) << voxels.status.text;
        return voxels.ok() ? (*voxels)->getSource()->describe().axes : glm::dmat3(0.0);
    };
    EXPECT_EQ(axes("1\\0\\0\\0\\1\\0"), glm::dmat3(1.0));
    // Sagittal: columns go backwards, rows down, and so slices to the right.
    const glm::dmat3 sagittal(glm::dvec3(0, 1, 0), glm::dvec3(0, 0, -1), glm::dvec3(-1, 0, 0));
    EXPECT_EQ(axes("0\\1\\0\\0\\0\\-1"), sagittal);
    // Not quite of unit length, nor at a right angle: the nearest rotation.
    const glm::dmat3 rough = axes("0.0\\0.999\\0.0001\\0.0\\0.0002\\-1.001");
    EXPECT_NEAR(glm::length(rough[1]), 1.0, 1e-12);
    EXPECT_NEAR(glm::dot(rough[0], rough[1]), 0.0, 1e-12);
    EXPECT_NEAR(rough[2].x, -1.0, 1e-3);
    // What are no two directions is no orientation.
    for (const char* bad :
         {"0\\0\\0\\0\\1\\0", "1\\0\\0\\1\\0\\0", "1\\0\\0", "1e300\\0\\0\\0\\1e300\\0"})
        EXPECT_EQ(axes(bad), glm::dmat3(1.0)) << bad;
}

TEST_F(ReadDicom, ASliceIsAsThickAsItsHeaderSays)
{
    file.spacing = "0.5\\0.5";
    file.thickness = "3";
    const auto one = readVoxels(write("a.dcm", file.bytes()));
    ASSERT_TRUE(one.ok()) << one.status.text;
    EXPECT_EQ((*one)->getSize().z(), 1);
    EXPECT_EQ((*one)->getSpacing(), osg::Vec3d(0.5, 0.5, 3.0));
    const osg::BoundingBox box = VolumeGeometry::createBox(**one)->getBoundingBox();
    EXPECT_EQ(box.zMin(), -1.5f);
    EXPECT_EQ(box.zMax(), 1.5f);
}

TEST_F(ReadDicom, ASliceOfASeriesIsToldToBeOne)
{
    struct Heard : osg::NotifyHandler
    {
        void notify(osg::NotifySeverity, const char* text) override { all += text; }
        std::string all;
    };
    const osg::ref_ptr<osg::NotifyHandler> before = osg::getNotifyHandler();
    const auto heard = [&](const std::string& name) {
        const osg::ref_ptr<Heard> handler = new Heard;
        osg::setNotifyHandler(handler);
        EXPECT_TRUE(readVoxels(name).ok());
        osg::setNotifyHandler(before);
        return handler->all;
    };
    file.series = "1.2.3";
    const std::string first = write("a.dcm", file.bytes());
    EXPECT_EQ(heard(first), "");
    file.series = "1.2.4";
    write("b.dcm", file.bytes());
    write("c.txt", "no slice");
    EXPECT_EQ(heard(first), ""); // of another series
    file.series = "1.2.3";
    write("d.dcm", file.bytes());
    const std::string text = heard(first);
    EXPECT_NE(text.find(first), std::string::npos) << text;
    EXPECT_NE(text.find("folder"), std::string::npos) << text;
    fs::remove(path("b.dcm"));
    fs::remove(path("c.txt"));
    EXPECT_EQ(heard(path("")), "");
}

TEST_F(ReadDicom, SequencesAreSkippedWhateverTheirForm)
{
    file.representation = 1;
    const std::string inner = element(0x28, 0x10, "US", number16(999), false);
    const std::string item = number16(0xfffe) + number16(0xe000);
    const std::string itemEnd = number16(0xfffe) + number16(0xe00d) + number32(0);
    const std::string sequenceEnd = number16(0xfffe) + number16(0xe0dd) + number32(0);
    const std::string undefined = number32(0xffffffffu);
    const std::string head = number16(8) + number16(0x1140) + "SQ" + number16(0);
    file.before =
        element(8, 0x1110, "SQ", item + number32(static_cast<std::uint32_t>(inner.size())) + inner,
                false) +
        head + undefined + item + undefined + inner + itemEnd + sequenceEnd;
    EXPECT_EQ(scaled(values, 1, 0), read(write("a.dcm", file.bytes()), VoxelType::INT16));
}

TEST_F(ReadDicom, BadFilesAreRefusedByName)
{
    Dicom bad = file;
    bad.columns = 0;
    EXPECT_EQ(ErrorCode::VALUE_INVALID, statusOf(bad).code);
    bad = file;
    bad.frames = -1;
    EXPECT_EQ(ErrorCode::VALUE_INVALID, statusOf(bad).code);
    bad = file;
    bad.highBit = 20;
    EXPECT_EQ(ErrorCode::VALUE_INVALID, statusOf(bad).code);
    bad = file;
    bad.slope = "0";
    EXPECT_EQ(ErrorCode::VALUE_INVALID, statusOf(bad).code);
    bad = file;
    bad.columns = bad.rows = 60000; // more than there is
    const Status huge = statusOf(bad);
    EXPECT_EQ(ErrorCode::FILE_UNREADABLE, huge.code);
    EXPECT_NE(std::string::npos, huge.text.find("has 24 bytes")) << huge.text;
    EXPECT_NE(std::string::npos, huge.text.find("need 7200000000")) << huge.text;
}

TEST_F(ReadDicom, CutAnywhereItIsRefused)
{
    file.before = element(8, 0x60, "CS", "CT", false);
    const std::string bytes = file.bytes();
    for (std::size_t length = 132; length < bytes.size(); ++length) {
        const auto voxels = readVoxels(write("cut.dcm", bytes.substr(0, length)));
        ASSERT_FALSE(voxels.ok()) << length;
        ASSERT_EQ(ErrorCode::FILE_UNREADABLE, voxels.status.code) << voxels.status.text;
    }
}

TEST_F(ReadDicom, SlicesOfAnotherSizeAreNamed)
{
    write("1.dcm", file.bytes());
    file.rows = 2;
    file.setValues({1, 2, 3, 4, 5, 6, 7, 8});
    write("2.dcm", file.bytes());
    const auto voxels = readVoxels(path(""));
    EXPECT_EQ(ErrorCode::SIZE_MISMATCH, voxels.status.code);
    EXPECT_NE(std::string::npos, voxels.status.text.find("2.dcm has 4,2,1")) << voxels.status.text;
}

} // namespace ReadDicomTest
