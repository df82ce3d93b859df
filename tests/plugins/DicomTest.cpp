// DICOM files, made here element by element.

#ifdef OSGVOLUMIZER_HAVE_ITK

#include "DicomFiles.h"
#include "VolumeSums.h"

#include <osgVolumizer/VolumeGeometry.h>

#include <support/FolderTest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <filesystem>
#include <numeric>

namespace DicomTest {

using namespace osgVolumizer;
using Elements = DicomFile::Elements;
namespace fs = std::filesystem;

namespace {

class Dicom : public support::FolderTest
{
protected:
    void SetUp() override
    {
        FolderTest::SetUp();
        values.resize(12);
        std::iota(values.begin(), values.end(), -5);
        file.setValues(values);
    }
    std::string write(const std::string& name) const { return writeBytes(name, file.bytes()); }
    /// A slice of one value.
    void writeSlice(const std::string& name, const std::string& position, int value)
    {
        file.setPlace(position);
        file.setValues(std::vector<int>(12, value));
        write(name);
    }
    static osg::ref_ptr<VoxelSource> sourceOf(const std::string& name, const char* options = "")
    {
        const osg::ref_ptr<osgDB::Options> said = new osgDB::Options(options);
        const auto voxels = readVoxels(name, said);
        EXPECT_TRUE(voxels.ok()) << voxels.status.text;
        return voxels.ok() ? const_cast<VoxelSource*>((*voxels)->getSource()) : nullptr;
    }
    static std::vector<double> read(const std::string& name, VoxelType type,
                                    const char* options = "")
    {
        const osg::ref_ptr<VoxelSource> source = sourceOf(name, options);
        if (!source) return {};
        EXPECT_STREQ(voxelTypeName(type), voxelTypeName(source->describe().type));
        return valuesOf(*source);
    }
    /// The first value of each slice.
    static std::vector<double> slices(const std::string& name, const char* options = "")
    {
        const osg::ref_ptr<VoxelSource> source = sourceOf(name, options);
        if (!source) return {};
        const std::vector<double> all = valuesOf(*source);
        std::vector<double> first;
        for (std::size_t i = 0; i < all.size(); i += 12)
            first.push_back(all[i]);
        return first;
    }
    Status statusOf() const
    {
        const auto voxels = readVoxels(write("bad.dcm"));
        EXPECT_FALSE(voxels.ok());
        EXPECT_EQ(0u, voxels.status.text.find(path("bad.dcm"))) << voxels.status.text;
        return voxels.status;
    }

    DicomFile file;
    std::vector<int> values; ///< -5 ... 6
};

std::vector<double> scaled(const std::vector<int>& values, double slope, double intercept)
{
    std::vector<double> v;
    for (const int i : values)
        v.push_back(slope * i + intercept);
    return v;
}

glm::dvec3 placed(const VoxelSource& source, const glm::dvec3& voxel)
{
    return io::placeOf(source.describe(), voxel);
}

TEST_F(Dicom, SignedValuesInEveryByteOrder)
{
    file.setBits(16, 16, 15, true);
    for (const char* syntax :
         {DicomFile::EXPLICIT_LITTLE, DicomFile::IMPLICIT_LITTLE, DicomFile::EXPLICIT_BIG}) {
        file.syntax = syntax;
        EXPECT_EQ(scaled(values, 1, 0), read(write("a.dcm"), VoxelType::INT16)) << syntax;
    }
}

TEST_F(Dicom, RescaledToCalibratedValues)
{
    file.setBits(16, 16, 15, true);
    file.text(0x00281052, "DS", "-1024");
    file.text(0x00281053, "DS", "1");
    EXPECT_EQ(scaled(values, 1, -1024), read(write("ct.dcm"), VoxelType::INT16));
    file.setBits(16, 12, 11, true);
    EXPECT_EQ(scaled(values, 1, -1024), read(write("ct12.dcm"), VoxelType::INT16));
    file.text(0x00281053, "DS", "0.5 ");
    EXPECT_EQ(scaled(values, 0.5, -1024), read(write("half.dcm"), VoxelType::FLOAT32));
    // Values that only a wide type holds.
    file.setBits(16, 16, 15, true);
    file.text(0x00281053, "DS", "100000");
    EXPECT_EQ(scaled(values, 100000, -1024), read(write("wide.dcm"), VoxelType::FLOAT32));
    file.text(0x00281053, "DS", "10000");
    EXPECT_EQ(scaled(values, 10000, -1024), read(write("wide.dcm"), VoxelType::INT32));
}

TEST_F(Dicom, EachSliceHasARescaleOfItsOwn)
{
    for (int i = 0; i < 3; ++i) {
        file.text(0x00281053, "DS", std::to_string(i + 1));
        file.text(0x00281052, "DS", std::to_string(-i));
        writeSlice(std::to_string(i), "0\\0\\" + std::to_string(i), 100);
    }
    EXPECT_EQ(slices(path("")), (std::vector<double>{100, 199, 298}));
}

TEST_F(Dicom, BitsAroundTheStoredOnesDoNotCount)
{
    // 12 bits in the upper part of 16, with an overlay in the lowest.
    std::vector<int> shifted;
    std::vector<double> expected;
    for (int i = 0; i < 12; ++i) {
        shifted.push_back((300 * i) << 4 | 9);
        expected.push_back(300 * i);
    }
    file.setValues(shifted);
    file.setBits(16, 12, 15, false);
    EXPECT_EQ(expected, read(write("a.dcm"), VoxelType::UINT16));
    // Signed, in the lower part, with something above.
    for (int i = 0; i < 12; ++i) {
        shifted[std::size_t(i)] = ((i - 6) & 0xfff) | 0x3000;
        expected[std::size_t(i)] = i - 6;
    }
    file.setValues(shifted);
    file.setBits(16, 12, 11, true);
    EXPECT_EQ(expected, read(write("b.dcm"), VoxelType::INT16));
}

TEST_F(Dicom, EveryWidth)
{
    file.setBits(8, 8, 7, false);
    file.setValues(values);
    std::vector<double> expected;
    for (const int v : values)
        expected.push_back(v & 255);
    EXPECT_EQ(expected, read(write("a.dcm"), VoxelType::UINT8));
    file.setBits(32, 32, 31, true);
    file.setValues({1 << 30, -5, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
    EXPECT_EQ((std::vector<double>{1 << 30, -5, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}),
              read(write("b.dcm"), VoxelType::INT32));
}

TEST_F(Dicom, FramesAreSlices)
{
    file.setSize(2, 3);
    file.text(0x00280008, "IS", "2");
    file.setBits(16, 16, 15, true);
    file.text(0x00280030, "DS", "0.8\\0.5"); // between rows first
    file.text(0x00180050, "DS", "2.5");
    const auto source = sourceOf(write("a.dcm"));
    ASSERT_TRUE(source);
    EXPECT_EQ(glm::ivec3(2, 3, 2), source->describe().size);
    EXPECT_EQ(glm::dvec3(0.5, 0.8, 2.5), source->describe().spacing);
    EXPECT_EQ(scaled(values, 1, 0), valuesOf(*source));
    // A film: frames follow each other in time.
    file.words(0x00280009, "AT", {0x0018, 0x1063});
    file.text(0x00181063, "DS", "40");
    const auto film = sourceOf(write("film.dcm"));
    ASSERT_TRUE(film);
    EXPECT_EQ(film->describe().size.z, 1);
    EXPECT_EQ(film->stepCount(), 2);
    EXPECT_EQ(scaled(values, 1, 0), valuesOf(*film));
}

TEST_F(Dicom, ASeriesIsSortedAlongThePatient)
{
    file.text(0x00280030, "DS", "1\\1");
    // Names, instances and places in three different orders; files without extension.
    const std::tuple<const char*, const char*, double, int> all[] = {
        {"IM1", "3", 30.0, 2}, {"IM2", "1", 27.0, 1}, {"IM10", "2", 24.0, 0}};
    for (const auto& [name, instance, z, order] : all) {
        file.text(0x00200013, "IS", instance);
        writeSlice(name, "-100\\-90\\" + std::to_string(z), 100 * order);
    }
    const auto source = sourceOf(path(""));
    ASSERT_TRUE(source);
    EXPECT_EQ(glm::dvec3(1, 1, 3), source->describe().spacing);
    EXPECT_EQ(placed(*source, {0, 0, 0}), glm::dvec3(-100, -90, 24));
    EXPECT_EQ(slices(path("")), (std::vector<double>{0, 100, 200}));
    // The option string has the last word.
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("spacing=2,2,2");
    EXPECT_EQ(osg::Vec3d(2, 2, 2), (*readVoxels(path(""), options.get()))->getSpacing());
}

TEST_F(Dicom, AxesPointWhereTheHeaderSays)
{
    const auto axes = [&](const std::string& orientation) {
        file.setPlace("1\\2\\3", orientation);
        const auto source = sourceOf(write("a.dcm"));
        return source ? source->describe().axes : glm::dmat3(0.0);
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

TEST_F(Dicom, ASliceIsAsThickAsItsHeaderSays)
{
    file.text(0x00280030, "DS", "0.5\\0.5");
    file.text(0x00180050, "DS", "3");
    const auto one = readVoxels(write("a.dcm"));
    ASSERT_TRUE(one.ok()) << one.status.text;
    EXPECT_EQ((*one)->getSize().z(), 1);
    EXPECT_EQ((*one)->getSpacing(), osg::Vec3d(0.5, 0.5, 3.0));
    const osg::BoundingBox box = VolumeGeometry::createBox(**one)->getBoundingBox();
    EXPECT_EQ(box.zMin(), -1.5f);
    EXPECT_EQ(box.zMax(), 1.5f);
}

TEST_F(Dicom, ASliceOfASeriesIsToldToBeOne)
{
    const auto heard = [&](const std::string& name) {
        const Notices notices;
        EXPECT_TRUE(readVoxels(name).ok());
        return notices.text();
    };
    const std::string first = write("a.dcm");
    EXPECT_EQ(heard(first), "");
    file.text(0x0020000e, "UI", "1.2.34");
    write("b.dcm");
    writeBytes("c.txt", "no slice");
    EXPECT_EQ(heard(first), ""); // of another series
    file.text(0x0020000e, "UI", "1.2.3");
    write("d.dcm");
    const std::string text = heard(first);
    EXPECT_NE(text.find(first), std::string::npos) << text;
    EXPECT_NE(text.find("folder"), std::string::npos) << text;
    fs::remove(path("b.dcm"));
    fs::remove(path("c.txt"));
    EXPECT_EQ(heard(path("")), "");
}

TEST_F(Dicom, SequencesAreSkippedWhateverTheirForm)
{
    file.setBits(16, 16, 15, true);
    const Elements inner = {{0x00280010, {"US", DicomFile::number16(999)}}};
    file.sequence(0x00081110, {inner});
    EXPECT_EQ(scaled(values, 1, 0), read(write("a.dcm"), VoxelType::INT16));
    // Of undefined length, as are its items.
    const std::string item = DicomFile::number16(0xfffe) + DicomFile::number16(0xe000);
    const std::string undefined = DicomFile::number32(0xffffffffu);
    const std::string head = DicomFile::number16(8) + DicomFile::number16(0x1140) + "SQ" +
                             DicomFile::number16(0) + undefined;
    const std::string element = DicomFile::number16(0x28) + DicomFile::number16(0x10) + "US" +
                                DicomFile::number16(2) + DicomFile::number16(999);
    const auto end = [](int tag) {
        return DicomFile::number16(0xfffe) + DicomFile::number16(tag) + DicomFile::number32(0);
    };
    std::string bytes = file.bytes();
    const std::size_t at = bytes.find(DicomFile::number16(0x20) + DicomFile::number16(0xe) + "UI");
    ASSERT_NE(at, std::string::npos);
    bytes.insert(at, head + item + undefined + element + end(0xe00d) + end(0xe0dd));
    EXPECT_EQ(scaled(values, 1, 0), read(writeBytes("b.dcm", bytes), VoxelType::INT16));
}

TEST_F(Dicom, BadFilesAreRefusedByName)
{
    const DicomFile good = file;
    file.setSize(0, 3);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, statusOf().code);
    file = good;
    file.text(0x00280008, "IS", "-1");
    EXPECT_EQ(ErrorCode::VALUE_INVALID, statusOf().code);
    file = good;
    file.setBits(16, 16, 20, false);
    EXPECT_EQ(ErrorCode::VALUE_INVALID, statusOf().code);
    file = good;
    file.text(0x00281053, "DS", "0");
    EXPECT_EQ(ErrorCode::VALUE_INVALID, statusOf().code);
    file = good;
    file.setSize(60000, 60000); // more than there is
    const Status huge = statusOf();
    EXPECT_EQ(ErrorCode::FILE_UNREADABLE, huge.code);
    EXPECT_NE(std::string::npos, huge.text.find("has 24 bytes")) << huge.text;
    EXPECT_NE(std::string::npos, huge.text.find("need 7200000000")) << huge.text;
    file = good;
    file.syntax = "1.2.840.10008.1.2.4.50";
    file.elements.erase(0x7fe00010);
    const std::string item = DicomFile::number16(0xfffe) + DicomFile::number16(0xe000);
    const std::string fragments = DicomFile::number16(0x7fe0) + DicomFile::number16(0x10) + "OB" +
                                  DicomFile::number16(0) + DicomFile::number32(0xffffffffu) + item +
                                  DicomFile::number32(0) + item + DicomFile::number32(8) +
                                  "no JPEG!" + DicomFile::number16(0xfffe) +
                                  DicomFile::number16(0xe0dd) + DicomFile::number32(0);
    const auto jpeg = readVoxels(writeBytes("jpeg.dcm", file.bytes() + fragments));
    EXPECT_EQ(ErrorCode::FILE_UNREADABLE, jpeg.status.code);
    EXPECT_NE(std::string::npos, jpeg.status.text.find("cannot be decoded (JPEG Baseline"))
        << jpeg.status.text;
}

TEST_F(Dicom, WhatHasNoImageIsToldByItsKind)
{
    file.elements.clear();
    file.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.481.5");
    file.text(0x00080060, "CS", "RTPLAN");
    const Status plan = statusOf();
    EXPECT_EQ(plan.code, ErrorCode::NOT_SUPPORTED);
    EXPECT_NE(plan.text.find("has no image: it is of the kind \"RT Plan Storage\""),
              std::string::npos)
        << plan.text;
    file.text(0x00080016, "UI", "1.2.840.10008.1.3.10"); // DICOMDIR
    EXPECT_NE(statusOf().text.find("open its folder"), std::string::npos);
    // Beside slices it does not matter.
    write("plan.dcm");
    fs::remove(path("bad.dcm"));
    file = DicomFile();
    writeSlice("1.dcm", "0\\0\\0", 1);
    writeSlice("2.dcm", "0\\0\\1", 2);
    const Notices notices;
    EXPECT_EQ(slices(path("")), (std::vector<double>{1, 2}));
    EXPECT_TRUE(notices.has("1 files are left out")) << notices.text();
}

TEST_F(Dicom, CutAnywhereItIsRefused)
{
    const std::string bytes = file.bytes();
    for (std::size_t length = 132; length < bytes.size(); ++length) {
        const auto voxels = readVoxels(writeBytes("cut.dcm", bytes.substr(0, length)));
        ASSERT_FALSE(voxels.ok()) << length;
        // Where elements are cut off whole, it is a file without an image.
        ASSERT_TRUE(voxels.status.code == ErrorCode::FILE_UNREADABLE ||
                    voxels.status.code == ErrorCode::NOT_SUPPORTED ||
                    voxels.status.code == ErrorCode::VALUE_INVALID)
            << voxels.status.text;
    }
}

TEST_F(Dicom, ChosenAmongSeveralSeries)
{
    const auto series = [this](int number, const char* uid, const char* description, int count) {
        file.text(0x0020000e, "UI", uid);
        file.text(0x00200011, "IS", std::to_string(number));
        file.text(0x0008103e, "LO", description);
        for (int i = 0; i < count; ++i)
            writeSlice(std::to_string(number) + "_" + std::to_string(i),
                       "0\\0\\" + std::to_string(i), 100 * number + i);
    };
    series(7, "1.2.3.77", "thick", 2);
    series(2, "1.2.3.45", "Thorax 1.0", 3);
    series(4, "1.2.3.46", "thick", 2);
    {
        const Notices notices;
        EXPECT_EQ(slices(path("")), (std::vector<double>{200, 201, 202}));
        EXPECT_TRUE(notices.has("of 3 series the largest is taken, 1 \"Thorax 1.0\""))
            << notices.text();
    }
    const Notices quiet;
    EXPECT_EQ(slices(path(""), "dataset=3"), (std::vector<double>{700, 701}));
    EXPECT_EQ(slices(path(""), "dataset=1.2.3.46"), (std::vector<double>{400, 401}));
    EXPECT_EQ(slices(path(""), "dataset=.77"), (std::vector<double>{700, 701}));
    EXPECT_EQ(slices(path(""), "dataset='Thorax 1.0'"), (std::vector<double>{200, 201, 202}));
    EXPECT_EQ(quiet.text(), "");
    // A number that the list does not have is a SeriesNumber, and never the end of a number.
    EXPECT_EQ(slices(path(""), "dataset=7"), (std::vector<double>{700, 701}));
    EXPECT_EQ(slices(path(""), "dataset=46"), (std::vector<double>{400, 401}));
    EXPECT_EQ(slices(path(""), "dataset=2"), (std::vector<double>{400, 401}));
    EXPECT_EQ(quiet.text(), "");
    for (const char* bad : {"dataset=6", "dataset=thick", "dataset=9.9", "dataset=0"}) {
        const osg::ref_ptr<osgDB::Options> options = new osgDB::Options(bad);
        const auto voxels = readVoxels(path(""), options);
        EXPECT_EQ(voxels.status.code, ErrorCode::VALUE_INVALID) << bad;
        EXPECT_NE(voxels.status.text.find("2 \"thick\" (1.2.3.46)"), std::string::npos)
            << voxels.status.text;
    }
    const auto all = listVolumes(path(""));
    ASSERT_TRUE(all.ok()) << all.status.text;
    ASSERT_EQ(all->size(), 3u);
    EXPECT_EQ((*all)[0].name, "1");
    EXPECT_TRUE((*all)[0].chosen);
    EXPECT_FALSE((*all)[1].chosen);
    EXPECT_EQ((*all)[0].text, "CT, Thorax 1.0, 3 slices of 1,1,1 mm, 1.2.3.45");
    EXPECT_EQ((*all)[2].size, osg::Vec3i(4, 3, 2));
    EXPECT_EQ((*all)[2].type, VoxelType::UINT16);
}

TEST_F(Dicom, ScoutsAreSetAside)
{
    for (int i = 0; i < 4; ++i)
        writeSlice(std::to_string(i), "0\\0\\" + std::to_string(i), i);
    file.setPlace("0\\0\\0", "1\\0\\0\\0\\0\\-1"); // from the front
    write("scout");
    file.setSize(3, 4);
    write("other");
    const Notices notices;
    EXPECT_EQ(slices(path("")), (std::vector<double>{0, 1, 2, 3}));
    EXPECT_TRUE(notices.has("2 pictures of another size or orientation")) << notices.text();
}

TEST_F(Dicom, MissingSlicesAreFilledWhereTheyBelong)
{
    for (const int z : {0, 1, 3, 4})
        writeSlice(std::to_string(z), "0\\0\\" + std::to_string(z), 100 * z);
    const Notices notices;
    const auto source = sourceOf(path(""));
    ASSERT_TRUE(source);
    EXPECT_EQ(source->describe().size.z, 5);
    EXPECT_EQ(source->describe().spacing.z, 1.0);
    EXPECT_EQ(slices(path("")), (std::vector<double>{0, 100, 200, 300, 400}));
    EXPECT_TRUE(notices.has("2 mm between the slices at 1 mm and 3 mm")) << notices.text();
}

TEST_F(Dicom, UnevenSlicesAreResampledToTheirPlaces)
{
    // What grows linearly stays so.
    int i = 0;
    for (const char* z : {"10", "11", "12.25", "13.5", "15"})
        writeSlice(std::to_string(i++), std::string("0\\0\\") + z,
                   static_cast<int>(std::lround(1000 * std::stod(z))));
    const Notices notices;
    const auto source = sourceOf(path(""));
    ASSERT_TRUE(source);
    EXPECT_TRUE(notices.has("not evenly spaced")) << notices.text();
    EXPECT_EQ(source->describe().spacing.z, 1.25); // the median
    const std::vector<double> found = slices(path(""));
    ASSERT_EQ(found.size(), 5u);
    for (std::size_t k = 0; k < 5; ++k)
        EXPECT_NEAR(found[k], 1000 * placed(*source, {0, 0, double(k)}).z, 0.5) << k;
}

TEST_F(Dicom, RoundedPlacesAreEven)
{
    for (int i = 0; i < 5; ++i)
        writeSlice(std::to_string(i), "0\\0\\" + std::to_string(std::lround(62.5 * i)) + "e-2", i);
    const Notices notices;
    EXPECT_EQ(slices(path("")), (std::vector<double>{0, 1, 2, 3, 4}));
    EXPECT_EQ(notices.text(), "");
}

TEST_F(Dicom, ATiltedGantryIsASkewedAxis)
{
    const double tilt = std::tan(0.3);
    file.text(0x00280030, "DS", "0.75\\0.5");
    for (int i = 0; i < 4; ++i)
        writeSlice(std::to_string(i),
                   "-20\\" + std::to_string(3.0 * tilt * i) + "\\" + std::to_string(3.0 * i), i);
    const Notices notices;
    const auto source = sourceOf(path(""));
    ASSERT_TRUE(source);
    EXPECT_EQ(notices.text(), "");
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 expected(-20.0 + 0.5 * 2, 3.0 * tilt * i + 0.75 * 3, 3.0 * i);
        EXPECT_LT(glm::distance(placed(*source, {2, 3, i}), expected), 1e-5) << i;
    }
}

TEST_F(Dicom, SlicesOfOnePlaceAreTimeSteps)
{
    for (int i = 0; i < 3; ++i)
        for (int t = 0; t < 2; ++t) {
            file.text(0x00181060, "DS", std::to_string(50 * t)); // trigger time
            file.text(0x00200013, "IS", std::to_string(10 * i + 5 - t));
            writeSlice(std::to_string(i) + std::to_string(t), "0\\0\\" + std::to_string(i),
                       100 * t + i);
        }
    const auto source = sourceOf(path(""));
    ASSERT_TRUE(source);
    EXPECT_EQ(source->stepCount(), 2);
    EXPECT_EQ(slices(path("")), (std::vector<double>{0, 1, 2, 100, 101, 102}));
}

TEST_F(Dicom, TimeStepsThatLackASliceAreLeftOut)
{
    const auto series = [this](const std::string& key, const auto& instanceOf) {
        for (int t = 0; t < 3; ++t)
            for (int i = 0; i < 3; ++i) {
                if (key == "trigger") file.text(0x00181060, "DS", std::to_string(50 * t));
                if (key == "position") file.text(0x00200100, "IS", std::to_string(3 - t));
                if (key == "time") file.text(0x00080032, "TM", "10000" + std::to_string(t));
                file.text(0x00200013, "IS", std::to_string(instanceOf(t, i)));
                writeSlice(std::to_string(i) + std::to_string(t), "0\\0\\" + std::to_string(i),
                           100 * t + i);
            }
        file.elements.erase(0x00181060);
        file.elements.erase(0x00200100);
        file.elements.erase(0x00080032);
    };
    const auto expectSteps = [this](const std::string& lost, const std::vector<double>& expected) {
        fs::remove(path(lost));
        const Notices notices;
        EXPECT_EQ(slices(path("")), expected);
        EXPECT_TRUE(notices.has("1 of 3 time steps lack slices")) << notices.text();
    };
    const auto byStep = [](int t, int i) { return 3 * t + i + 1; };
    const auto byPlace = [](int t, int i) { return 3 * i + t + 1; };
    const std::vector<double> withoutFirst = {100, 101, 102, 200, 201, 202};
    for (const char* key : {"trigger", "time", "none"}) {
        SCOPED_TRACE(key);
        series(key, byStep);
        expectSteps("20", withoutFirst);
        series(key, byPlace);
        expectSteps("20", withoutFirst);
        series(key, byStep);
        expectSteps("01", {0, 1, 2, 200, 201, 202});
    }
    series("position", byStep);
    expectSteps("11", {200, 201, 202, 0, 1, 2});
    // Where nothing tells steps apart: the first of each place.
    series("none", [](int, int) { return 1; });
    fs::remove(path("11"));
    const Notices notices;
    EXPECT_EQ(slices(path("")), (std::vector<double>{0, 1, 2}));
    EXPECT_TRUE(notices.has("5 are left out")) << notices.text();
}

TEST_F(Dicom, StepsAreInTheOrderOfTheirAcquisition)
{
    for (int i = 0; i < 3; ++i)
        for (int t = 0; t < 2; ++t) {
            file.text(0x00080022, "DA", t ? "20240101" : "20240102"); // past midnight
            file.text(0x00080032, "TM", t ? "235959" : "000001.5");
            writeSlice(std::to_string(i) + std::to_string(t), "0\\0\\" + std::to_string(i),
                       100 * t + i);
        }
    EXPECT_EQ(slices(path("")), (std::vector<double>{100, 101, 102, 0, 1, 2}));
}

TEST_F(Dicom, PlacesOfAStepCanBeALittleOff)
{
    file.text(0x00280030, "DS", "1\\1");
    for (int i = 0; i < 3; ++i)
        for (int t = 0; t < 3; ++t) {
            file.text(0x00200100, "IS", std::to_string(t + 1));
            writeSlice(std::to_string(i) + std::to_string(t),
                       "0\\0\\" + std::to_string(2 * i + 0.004 * t), 100 * t + i);
        }
    const auto source = sourceOf(path(""));
    ASSERT_TRUE(source);
    EXPECT_EQ(source->stepCount(), 3);
    EXPECT_EQ(source->describe().size.z, 3);
}

TEST_F(Dicom, StationsAreVolumesOfTheirOwn)
{
    file.text(0x00280030, "DS", "1\\1");
    for (int station = 0; station < 2; ++station)
        for (int i = 0; i < 3 + station; ++i)
            writeSlice(std::to_string(station) + std::to_string(i),
                       std::to_string(250 * station) + "\\0\\" + std::to_string(2 * i),
                       100 * station + i);
    {
        const Notices notices;
        EXPECT_EQ(slices(path("")), (std::vector<double>{100, 101, 102, 103}));
        EXPECT_TRUE(notices.has("of 2 volumes that lie beside each other")) << notices.text();
        EXPECT_TRUE(notices.has("the largest is taken, 2;")) << notices.text();
    }
    const Notices notices;
    EXPECT_EQ(slices(path(""), "dataset=1"), (std::vector<double>{0, 1, 2}));
    EXPECT_EQ(notices.text(), "");
    EXPECT_EQ(slices(path(""), "dataset=1.2.3"), (std::vector<double>{100, 101, 102, 103}));
    const auto all = listVolumes(path(""));
    ASSERT_TRUE(all.ok()) << all.status.text;
    ASSERT_EQ(all->size(), 2u);
    EXPECT_TRUE((*all)[1].chosen);
    EXPECT_NE((*all)[0].text.find("part 1 of 2"), std::string::npos) << (*all)[0].text;
}

TEST_F(Dicom, CopiesOfAFileAreLeftOut)
{
    for (int i = 0; i < 3; ++i) {
        file.text(0x00080018, "UI", "1.2.3.4." + std::to_string(i));
        writeSlice(std::to_string(i), "0\\0\\" + std::to_string(i), i);
        if (i < 2) write("copy" + std::to_string(i));
    }
    const Notices notices;
    EXPECT_EQ(slices(path("")), (std::vector<double>{0, 1, 2}));
    EXPECT_TRUE(notices.has("2 files are copies")) << notices.text();
}

TEST_F(Dicom, OneSliceFarFromAllIsSetAside)
{
    for (const int z : {0, 1, 2, 3, 90})
        writeSlice(std::to_string(z), "0\\0\\" + std::to_string(z), z);
    const Notices notices;
    EXPECT_EQ(slices(path("")), (std::vector<double>{0, 1, 2, 3}));
    EXPECT_TRUE(notices.has("the slice at 90 mm is set aside")) << notices.text();
}

TEST_F(Dicom, DistancesThatDriftAreMadeEven)
{
    // Each within rounding, but half of them longer.
    std::vector<double> at;
    for (int i = 0; i < 60; ++i) {
        at.push_back(i < 30 ? i : 30 + 1.018 * (i - 30));
        writeSlice((i < 10 ? "0" : "") + std::to_string(i), "0\\0\\" + std::to_string(at.back()),
                   static_cast<int>(std::lround(1000 * at.back())));
    }
    const Notices notices;
    const auto source = sourceOf(path(""));
    ASSERT_TRUE(source);
    EXPECT_TRUE(notices.has("not evenly spaced")) << notices.text();
    const std::vector<double> found = slices(path(""));
    for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(found[k], 1000 * placed(*source, {0, 0, double(k)}).z, 25.0) << k;
}

TEST_F(Dicom, PaddingIsTheLowestOfWhatIsNone)
{
    file.setBits(16, 16, 15, true);
    file.text(0x00281052, "DS", "-1000");
    file.text(0x00281053, "DS", "1");
    file.words(0x00280120, "SS", {-2000});
    file.setValues({-2000, -2000, 5, 6, 7, 8, 9, 10, 11, 12, 13, -2000});
    EXPECT_EQ(read(write("a.dcm"), VoxelType::INT16),
              (std::vector<double>{-995, -995, -995, -994, -993, -992, -991, -990, -989, -988, -987,
                                   -995}));
    // A range; the same of all slices.
    file.setBits(16, 16, 15, false);
    file.words(0x00280120, "US", {65000});
    file.words(0x00280121, "US", {65535});
    file.setPlace("0\\0\\0");
    file.setValues({65000, 65001, 65535, 20, 20, 20, 20, 20, 20, 20, 20, 64999});
    fs::create_directory(path("1"));
    write("1/a");
    writeSlice("1/b", "0\\0\\1", 10);
    const std::vector<double> both = read(path("1"), VoxelType::INT32);
    ASSERT_EQ(both.size(), 24u);
    EXPECT_EQ(std::vector<double>(both.begin(), both.begin() + 4),
              (std::vector<double>{-990, -990, -990, -980}));
    EXPECT_EQ(both[11], 63999);
    // Where values were changed by compression, one is not enough.
    file.text(0x00282110, "CS", "01");
    file.elements.erase(0x00280121);
    file.setValues(std::vector<int>(12, 65000));
    EXPECT_EQ(read(write("c.dcm"), VoxelType::UINT16)[0], 64000);
    // Nothing else.
    file.text(0x00282110, "CS", "");
    EXPECT_EQ(read(write("b.dcm"), VoxelType::UINT16), std::vector<double>(12, 0.0));
}

TEST_F(Dicom, FramesThatAFileCannotHaveAreRefused)
{
    file.text(0x00280008, "IS", "1048576");
    const Status plain = statusOf();
    EXPECT_EQ(plain.code, ErrorCode::FILE_UNREADABLE);
    EXPECT_NE(plain.text.find("has 24 bytes of pixels, which need 25165824"), std::string::npos)
        << plain.text;
    file.syntax = "1.2.840.10008.1.2.4.90";
    const Status packed = statusOf();
    EXPECT_EQ(packed.code, ErrorCode::FILE_UNREADABLE);
    EXPECT_NE(packed.text.find("even compressed 8388608"), std::string::npos) << packed.text;
}

TEST_F(Dicom, FramesOfNuclearMedicineLieWhereTheirDetectorSays)
{
    file.setSize(2, 2);
    file.text(0x00280008, "IS", "3");
    file.text(0x00280030, "DS", "4\\4");
    file.text(0x00180050, "DS", "5");
    file.text(0x00180088, "DS", "-5");
    file.sequence(0x00540022, {{{0x00200032, {"DS", "-10\\-20\\50"}},
                                {0x00200037, {"DS", "1\\0\\0\\0\\1\\0"}}}});
    file.setValues({1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3});
    const auto down = sourceOf(write("a.dcm"));
    ASSERT_TRUE(down);
    EXPECT_EQ(placed(*down, {0, 0, 0}), glm::dvec3(-10, -20, 40));
    EXPECT_EQ(placed(*down, {0, 0, 2}), glm::dvec3(-10, -20, 50));
    EXPECT_EQ(valuesOf(*down)[0], 3);
    file.words(0x00540080, "US", {2, 1, 3}); // which slice each is
    EXPECT_EQ(valuesOf(*sourceOf(write("b.dcm")))[4], 1);
}

TEST_F(Dicom, SegmentsAreTheirNumbers)
{
    file.text(0x00080016, "UI", "1.2.840.10008.5.1.4.1.1.66.4");
    file.setSize(4, 2);
    file.setBits(1, 1, 0, false);
    file.text(0x00280008, "IS", "4");
    const auto sequence = [](const Elements& item) {
        return std::pair<std::string, std::string>("SQ", DicomFile::encodeItems({item}));
    };
    std::vector<Elements> frames;
    for (const auto& [segment, z] : {std::pair(1, 0), {1, 2}, {7, 2}, {7, 8}})
        frames.push_back(
            {{0x00209113, sequence({{0x00200032, {"DS", "0\\0\\" + std::to_string(z)}}})},
             {0x0062000a, sequence({{0x0062000b, {"US", DicomFile::number16(segment)}}})}});
    file.sequence(0x52009230, frames);
    file.elements[0x7fe00010] = {"OB", std::string("\x01\x0f\x18\x80", 4)};
    const Notices notices;
    const auto source = sourceOf(write("a.dcm"));
    ASSERT_TRUE(source);
    EXPECT_EQ(notices.text(), "");
    EXPECT_EQ(source->describe().spacing.z, 2.0);
    EXPECT_EQ(source->describe().type, VoxelType::UINT8);
    // Where no frame is there is nothing.
    EXPECT_EQ(valuesOf(*source),
              (std::vector<double>{1, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 7, 7, 0, 0, 0, 0, 0, 0, 0,
                                   0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 7}));
    // Fractions of several are no labels.
    file.setBits(8, 8, 7, false);
    file.elements[0x7fe00010] = {"OB", std::string(32, '\1')};
    file.sequence(0x00620002, {{{0x00620004, {"US", DicomFile::number16(1)}}},
                               {{0x00620004, {"US", DicomFile::number16(7)}}}});
    const Status fractions = statusOf();
    EXPECT_EQ(fractions.code, ErrorCode::NOT_SUPPORTED);
    EXPECT_NE(fractions.text.find("segments of fractions"), std::string::npos) << fractions.text;
}

TEST_F(Dicom, DarkIsDenseInMonochrome1)
{
    file.text(0x00280004, "CS", "MONOCHROME1");
    file.setBits(16, 12, 11, false);
    file.setValues({0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 4095});
    const std::vector<double> all = read(write("a.dcm"), VoxelType::UINT16);
    ASSERT_EQ(all.size(), 12u);
    EXPECT_EQ(all[0], 4095);
    EXPECT_EQ(all[1], 4094);
    EXPECT_EQ(all[11], 0);
    // Calibrated values are what they are.
    file.text(0x00281053, "DS", "2");
    EXPECT_EQ(read(write("a.dcm"), VoxelType::UINT16)[1], 2);
}

TEST_F(Dicom, AModalityTableIsApplied)
{
    file.setBits(8, 8, 7, false);
    file.setValues({0, 10, 11, 12, 13, 200, 10, 10, 10, 10, 10, 10});
    std::string descriptor, data;
    for (const int v : {3, 10, 16})
        descriptor += DicomFile::number16(v);
    for (const int v : {1000, 2500, 40000})
        data += DicomFile::number16(v);
    file.sequence(0x00283000, {{{0x00283002, {"US", descriptor}}, {0x00283006, {"OW", data}}}});
    const std::vector<double> all = read(write("a.dcm"), VoxelType::UINT16);
    EXPECT_EQ(std::vector<double>(all.begin(), all.begin() + 6),
              (std::vector<double>{1000, 1000, 2500, 40000, 40000, 40000}));
}

TEST_F(Dicom, ADoseHasItsScaleAndPlaces)
{
    file.text(0x00080060, "CS", "RTDOSE");
    file.setSize(2, 2);
    file.text(0x00280008, "IS", "3");
    file.text(0x3004000e, "DS", "0.25");
    file.setValues({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12});
    file.setPlace("-10\\-20\\30");
    for (const char* offsets : {"0\\2.5\\5", "30\\32.5\\35"}) {
        file.text(0x3004000c, "DS", offsets);
        const auto source = sourceOf(write("a.dcm"));
        ASSERT_TRUE(source);
        EXPECT_EQ(placed(*source, {1, 1, 2}), glm::dvec3(-9, -19, 35)) << offsets;
        EXPECT_EQ(valuesOf(*source)[11], 3.0);
    }
    file.text(0x3004000c, "DS", "0\\-2.5\\-5"); // downwards
    const auto source = sourceOf(write("a.dcm"));
    ASSERT_TRUE(source);
    EXPECT_EQ(placed(*source, {0, 0, 2}), glm::dvec3(-10, -20, 30));
    EXPECT_EQ(valuesOf(*source)[0], 9 * 0.25);
}

TEST_F(Dicom, PetValuesAreUptakes)
{
    file.text(0x00080060, "CS", "PT");
    file.text(0x00541001, "CS", "BQML");
    file.text(0x00541102, "CS", "START");
    file.text(0x00101030, "DS", "70");
    file.text(0x00080031, "TM", "001000.00");
    const Elements drug = {{0x00181072, {"TM", "234000"}}, // half an hour before, and midnight
                           {0x00181074, {"DS", "4e8"}},
                           {0x00181075, {"DS", "3600"}}};
    file.sequence(0x00540016, {drug});
    file.text(0x00281053, "DS", "2.5");
    file.setValues(std::vector<int>(12, 1000));
    const double expected = 2.5 * 1000 * 70 * 1000 / (4e8 * std::exp2(-0.5));
    {
        const Notices notices;
        EXPECT_NEAR(read(write("a.dcm"), VoxelType::FLOAT32)[0], expected, 1e-6 * expected);
        EXPECT_EQ(notices.text(), "");
    }
    file.text(0x00101030, "DS", "");
    {
        const Notices notices;
        EXPECT_EQ(read(write("a.dcm"), VoxelType::FLOAT32)[0], 2500);
        EXPECT_TRUE(notices.has("no SUV: the weight of the patient")) << notices.text();
    }
    file.text(0x00541001, "CS", "GML"); // SUV already
    const Notices notices;
    EXPECT_EQ(read(write("a.dcm"), VoxelType::FLOAT32)[0], 2500);
    EXPECT_EQ(notices.text(), "");
}

TEST_F(Dicom, PetTimesHaveDates)
{
    file.text(0x00080060, "CS", "PT");
    file.text(0x00541001, "CS", "BQML");
    file.text(0x00541102, "CS", "START");
    file.text(0x00101030, "DS", "70");
    file.text(0x00281053, "DS", "2.5");
    file.setValues(std::vector<int>(12, 1000));
    // Decay over `hours`; below 0: as stored, since `why`.
    const auto expectDecay = [&](const std::string& given, double halfLife, double hours,
                                 const char* why = "") {
        const bool dated = given.size() > 6;
        file.sequence(0x00540016,
                      {{{dated ? 0x00181078u : 0x00181072u, {dated ? "DT" : "TM", given}},
                        {0x00181074, {"DS", "4e8"}},
                        {0x00181075, {"DS", std::to_string(halfLife)}}}});
        const double expected =
            hours < 0 ? 2500.0 : 2500.0 * 70000.0 / (4e8 * std::exp2(-3600.0 * hours / halfLife));
        const Notices notices;
        EXPECT_NEAR(read(write("a.dcm"), VoxelType::FLOAT32)[0], expected, 1e-6 * expected)
            << given;
        EXPECT_TRUE(notices.has(why)) << notices.text();
        EXPECT_EQ(notices.text().empty(), hours >= 0) << notices.text();
    };
    file.text(0x00080021, "DA", "20240301");
    file.text(0x00080031, "TM", "101500");
    expectDecay("20240228091500", 282276.0, 49); // over a leap day
    expectDecay("20240228091500.000000+0100", 282276.0, 49);
    expectDecay("20240301101600", 6588.0, -1, "the scan is earlier than the injection");
    expectDecay("20240229091500", 6588.0, -1, "more than 10 half lives");
    expectDecay("091500", 6588.0, 1);
    expectDecay("101600", 6588.0, -1, "more than 12 hours");
    // Pictures of before: their series was stored anew.
    file.text(0x00080022, "DA", "20240301");
    file.text(0x00080032, "TM", "100000");
    file.text(0x00080031, "TM", "143000");
    expectDecay("20240301090000", 6588.0, 1);
    file.text(0x00080032, "TM", "150000"); // a later bed position
    expectDecay("20240301133000", 6588.0, 1);
}

TEST_F(Dicom, APetSeriesIsScaledAsAWhole)
{
    file.text(0x00080060, "CS", "PT");
    file.text(0x00541001, "CS", "BQML");
    file.text(0x00541102, "CS", "START");
    file.text(0x00101030, "DS", "70");
    file.text(0x00080031, "TM", "110000");
    const Elements drug = {
        {0x00181072, {"TM", "090000"}}, {0x00181074, {"DS", "4e8"}}, {0x00181075, {"DS", "3600"}}};
    file.sequence(0x00540016, {drug});
    for (int i = 0; i < 3; ++i) {
        file.text(0x00080032, "TM", "10" + std::to_string(i) + "000"); // from 10 on
        writeSlice(std::to_string(i), "0\\0\\" + std::to_string(i), 1000);
    }
    for (const double v : slices(path("")))
        EXPECT_NEAR(v, 1000 * 70000 / (4e8 * 0.5), 1e-6);
    file.text(0x00101030, "DS", "");
    writeSlice("2", "0\\0\\2", 1000);
    const Notices notices;
    EXPECT_EQ(slices(path("")), (std::vector<double>{1000, 1000, 1000}));
    EXPECT_TRUE(notices.has("no SUV: the weight of the patient")) << notices.text();
}

TEST_F(Dicom, FramesOfAnEnhancedFileLieWhereTheyAre)
{
    file.setSize(2, 2);
    file.text(0x00280008, "IS", "3");
    file.setValues({20, 21, 22, 23, 0, 1, 2, 3, 10, 11, 12, 13});
    const auto sequence = [](const Elements& item) {
        return std::pair<std::string, std::string>("SQ", DicomFile::encodeItems({item}));
    };
    file.sequence(
        0x52009229,
        {{{0x00289110, sequence({{0x00180050, {"DS", "2"}}, {0x00280030, {"DS", "0.5\\0.25"}}})},
          {0x00209116, sequence({{0x00200037, {"DS", "0\\1\\0\\0\\0\\-1"}}})}}});
    std::vector<Elements> frames;
    for (const int i : {2, 0, 1}) { // the normal points to -x
        const std::string position = std::to_string(50 - 2 * i) + "\\-7\\8";
        const Elements scale = {{0x00281052, {"DS", std::to_string(100 * i)}},
                                {0x00281053, {"DS", "1"}}};
        frames.push_back({{0x00209113, sequence({{0x00200032, {"DS", position}}})},
                          {0x00289145, sequence(scale)}});
    }
    file.sequence(0x52009230, frames);
    const auto source = sourceOf(write("a.dcm"));
    ASSERT_TRUE(source);
    EXPECT_EQ(valuesOf(*source),
              (std::vector<double>{0, 1, 2, 3, 110, 111, 112, 113, 220, 221, 222, 223}));
    EXPECT_LT(glm::distance(placed(*source, {1, 1, 2}), glm::dvec3(46, -6.75, 7.5)), 1e-12);
}

TEST_F(Dicom, ColoursBecomeTheirLuminance)
{
    file.setBits(8, 8, 7, false);
    file.word(0x00280002, 3);
    file.setSize(2, 2);
    file.text(0x00280004, "CS", "RGB");
    file.setValues({100, 100, 100, 255, 0, 0, 0, 255, 0, 0, 0, 255});
    const std::vector<double> expected = {100, 54, 182, 18}; // Rec. 709, rounded
    file.word(0x00280006, 0);
    EXPECT_EQ(read(write("a.dcm"), VoxelType::UINT8), expected);
    EXPECT_EQ(read(path("a.dcm"), VoxelType::UINT8, "channel=0"),
              (std::vector<double>{100, 255, 0, 0}));
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("channel=3");
    EXPECT_EQ(readVoxels(path("a.dcm"), options).status.code, ErrorCode::INDEX_OUT_OF_RANGE);
    EXPECT_EQ((*listVolumes(path("a.dcm")))[0].channels, 3);
    file.word(0x00280006, 1); // colour by colour
    file.setValues({100, 255, 0, 0, 100, 0, 255, 0, 100, 0, 0, 255});
    EXPECT_EQ(read(write("a.dcm"), VoxelType::UINT8), expected);
}

TEST_F(Dicom, APaletteIsApplied)
{
    file.setBits(8, 8, 7, false);
    file.text(0x00280004, "CS", "PALETTE COLOR");
    file.setSize(2, 2);
    file.setValues({0, 1, 2, 1});
    for (const DicomFile::Tag tag : {0x00281101u, 0x00281102u, 0x00281103u})
        file.words(tag, "US", {4, 0, 8});
    for (const DicomFile::Tag tag : {0x00281201u, 0x00281202u, 0x00281203u})
        file.elements[tag] = {"OW", std::string("\x05\x64\xc8\0", 4)};
    const auto source = sourceOf(write("a.dcm"));
    ASSERT_TRUE(source);
    EXPECT_EQ(valuesOf(*source), (std::vector<double>{5, 100, 200, 100}));
    file.words(0x00281102, "US", {3, 0, 8}); // not as long as the table is
    EXPECT_EQ(statusOf().code, ErrorCode::NOT_SUPPORTED);
}

} // namespace

} // namespace DicomTest

#endif
