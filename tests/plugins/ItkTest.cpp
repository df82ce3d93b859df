// NIfTI, NRRD, MetaImage and others: read, and written.

#ifdef OSGVOLUMIZER_HAVE_ITK

#include "VolumeSums.h"

#include <osgVolumizer/WriteVoxels.h>
#include <osgVolumizer/core/voxels/VoxelDispatch.h>

#include <support/FolderTest.h>

#include <glm/geometric.hpp>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <limits>

namespace ItkTest {

using namespace osgVolumizer;
namespace fs = std::filesystem;

namespace {

using Memory = osg::ref_ptr<MemoryVoxelSource>;

/// Skewed and left-handed.
VoxelSource::Description skewed(VoxelType type, int components)
{
    VoxelSource::Description d;
    d.size = {5, 4, 3};
    d.type = type;
    d.components = components;
    const glm::dmat3 steps(0.3, 0.1, 0, -0.2, 0.7, 0.05, 0.1, 0.2, -1.1);
    EXPECT_TRUE(io::place(d, steps, {-120.25, 33.1, 1e3 / 3}).ok());
    return d;
}

Memory numbered(const VoxelSource::Description& d)
{
    const Memory source = new MemoryVoxelSource;
    EXPECT_TRUE(source->allocate(d).ok());
    const auto count = std::size_t(core::sampleCount(d.size)) * std::size_t(d.components);
    std::vector<double> values(count);
    double low = 0.0, high = 0.0;
    voxelTypeRange(d.type, low, high);
    const bool integer = high > 1.0;
    for (std::size_t i = 0; i < count; ++i)
        values[i] = integer ? std::floor(low + (high - low) * double(i) / double(count - 1))
                            : (double(i) - 20.0) / 16.0;
    core::convertVoxels(values.data(), VoxelType::FLOAT64, source->data(), d.type, count);
    return source;
}

class Itk : public support::FolderTest
{
protected:
    static osg::ref_ptr<VoxelSource> sourceOf(const std::string& name, const char* options = "")
    {
        const osg::ref_ptr<osgDB::Options> said = new osgDB::Options(options);
        const auto voxels = readVoxels(name, said);
        EXPECT_TRUE(voxels.ok()) << voxels.status.text;
        return voxels.ok() ? const_cast<VoxelSource*>((*voxels)->getSource()) : nullptr;
    }
};

template <class T>
void put(std::string& bytes, std::size_t at, T value, bool big = false)
{
    if (big) core::swapBytes(&value, sizeof(T), 1);
    std::memcpy(&bytes[at], &value, sizeof(T));
}

/// A NIfTI-1 file of 2 x 3 x 2 samples of 16 bits.
struct Nifti
{
    std::string bytes = std::string(352, '\0');
    bool big = false;

    Nifti(bool bigEndian = false) : big(bigEndian)
    {
        put<std::int32_t>(bytes, 0, 348, big);
        setSize({3, 2, 3, 2, 1, 1, 1, 1});
        setType(4, 16);
        for (int i = 0; i < 4; ++i)
            put<float>(bytes, std::size_t(76 + 4 * i), float(i ? i : 1), big); // spacing 1, 2, 3
        put<float>(bytes, 108, 352.0f, big);
        std::memcpy(&bytes[344], "n+1", 3);
        for (int i = 0; i < 12; ++i) {
            bytes += "  ";
            put<std::int16_t>(bytes, bytes.size() - 2, std::int16_t(i - 3), big);
        }
    }
    void setSize(const std::vector<int>& dims)
    {
        for (std::size_t i = 0; i < dims.size(); ++i)
            put<std::int16_t>(bytes, 40 + 2 * i, std::int16_t(dims[i]), big);
    }
    void setType(int code, int bits)
    {
        put<std::int16_t>(bytes, 70, std::int16_t(code), big);
        put<std::int16_t>(bytes, 72, std::int16_t(bits), big);
    }
    void setSform(const std::vector<float>& rows)
    {
        put<std::int16_t>(bytes, 254, 1, big);
        for (std::size_t i = 0; i < 12; ++i)
            put<float>(bytes, 280 + 4 * i, rows[i], big);
    }
};

void expectPlace(const VoxelSource& source, const glm::dvec3& voxel, const glm::dvec3& expected,
                 double tolerance)
{
    const glm::dvec3 found = io::placeOf(source.describe(), voxel);
    EXPECT_LT(glm::distance(found, expected), tolerance)
        << found.x << ' ' << found.y << ' ' << found.z;
}

TEST_F(Itk, WhatIsWrittenIsReadBackToTheBit)
{
    for (const char* name : {"a.nrrd", "a.nhdr", "a.nii", "a.nii.gz", "a.mha", "a.mhd"})
        for (const VoxelType type : {VoxelType::INT8, VoxelType::UINT8, VoxelType::INT16,
                                     VoxelType::UINT16, VoxelType::INT32, VoxelType::UINT32,
                                     VoxelType::HALF, VoxelType::FLOAT32, VoxelType::FLOAT64})
            for (const int components : {1, 4}) {
                SCOPED_TRACE(std::string(name) + ' ' + voxelTypeName(type) + ' ' +
                             std::to_string(components));
                const Memory source = numbered(skewed(type, components));
                const Status written = writeVoxels(*source, path(name));
                ASSERT_TRUE(written.ok()) << written.text;
                const auto found = sourceOf(path(name));
                ASSERT_TRUE(found);
                const VoxelSource::Description d = found->describe();
                EXPECT_EQ(d.type, type == VoxelType::HALF ? VoxelType::FLOAT32 : type);
                EXPECT_EQ(d.components, components);
                EXPECT_EQ(d.size, source->describe().size);
                EXPECT_EQ(valuesOf(*found), valuesOf(*source));
                const bool nifti = std::string(name).find(".nii") != std::string::npos;
                for (const glm::dvec3& voxel : {glm::dvec3(0), glm::dvec3(4, 3, 2)})
                    expectPlace(*found, voxel, io::placeOf(source->describe(), voxel),
                                nifti ? 1e-4 : 1e-9); // 120 mm in float32
                for (const auto& entry : fs::directory_iterator(folder()))
                    EXPECT_EQ(entry.path().string().find(".part"), std::string::npos)
                        << entry.path();
            }
}

TEST_F(Itk, SamplesBesideAHeaderReplaceNoOtherFile)
{
    const Memory source = numbered(skewed(VoxelType::INT16, 1));
    for (const std::string name : {"a.mhd", "a.nhdr"}) {
        writeBytes("a.raw", "of somebody");
        ASSERT_TRUE(writeVoxels(*source, path(name)).ok());
        EXPECT_EQ(fs::file_size(path("a.raw")), 11u);
        EXPECT_EQ(fs::file_size(path(name + ".raw")), 120u);
        ASSERT_TRUE(writeVoxels(*source, path(name)).ok()); // its own
        EXPECT_EQ(valuesOf(*sourceOf(path(name))), valuesOf(*source));
        fs::remove(path(name));
        const Status status = writeVoxels(*source, path(name));
        EXPECT_EQ(status.code, ErrorCode::FILE_UNREADABLE);
        EXPECT_NE(status.text.find("there already"), std::string::npos) << status.text;
        EXPECT_FALSE(fs::exists(path(name)));
        EXPECT_EQ(fs::file_size(path(name + ".raw")), 120u);
    }
}

TEST_F(Itk, LongVolumesAreNifti2)
{
    VoxelSource::Description d;
    d.size = {40000, 1, 2};
    const Memory source = numbered(d);
    ASSERT_TRUE(writeVoxels(*source, path("a.nii")).ok());
    const auto found = sourceOf(path("a.nii"));
    ASSERT_TRUE(found);
    EXPECT_EQ(found->describe().size, d.size);
    EXPECT_EQ(valuesOf(*found), valuesOf(*source));
}

TEST_F(Itk, NothingIsLeftOfAFileThatCannotBeWritten)
{
    class Failing : public MemoryVoxelSource
    {
    public:
        Status read(const core::Box3i& region, void* to) const override
        {
            if (region.min.z > 0) return {ErrorCode::FILE_UNREADABLE, "slice 1 is gone"};
            return MemoryVoxelSource::read(region, to);
        }
    };
    const osg::ref_ptr<Failing> source = new Failing;
    ASSERT_TRUE(source->allocate(skewed(VoxelType::UINT8, 1)).ok());
    for (const char* name : {"a.nrrd", "a.nii.gz", "a.mhd"}) {
        const Status status = writeVoxels(*source, path(name));
        EXPECT_EQ(status.code, ErrorCode::FILE_UNREADABLE);
        EXPECT_EQ(status.text, path(name) + ": slice 1 is gone");
    }
    EXPECT_TRUE(fs::is_empty(folder()));
    EXPECT_EQ(writeVoxels(*source, path("no/a.nrrd")).code, ErrorCode::FILE_UNREADABLE);
}

TEST_F(Itk, ANiftiLiesWhereItsSformSays)
{
    for (const bool big : {false, true}) {
        Nifti file(big);
        file.setSform({2, 0.5f, 0, -10, 0, -3, 0.25f, 20, 0.125f, 0, 4, -30}); // skewed, RAS
        const auto source = sourceOf(writeBytes("a.nii", file.bytes));
        ASSERT_TRUE(source);
        EXPECT_EQ(source->describe().type, VoxelType::INT16);
        EXPECT_EQ(valuesOf(*source)[0], -3);
        EXPECT_EQ(valuesOf(*source)[11], 8);
        expectPlace(*source, {0, 0, 0}, {10, -20, -30}, 1e-9);
        expectPlace(*source, {1, 0, 0}, {8, -20, -29.875}, 1e-9);
        expectPlace(*source, {0, 1, 0}, {9.5, -17, -30}, 1e-9);
        expectPlace(*source, {0, 0, 1}, {10, -20.25, -26}, 1e-9);
        file.bytes[123] = 3; // micrometres
        const auto small = sourceOf(writeBytes("a.nii", file.bytes));
        ASSERT_TRUE(small);
        expectPlace(*small, {0, 0, 0}, {0.01, -0.02, -0.03}, 1e-12);
    }
}

TEST_F(Itk, AnSformThatSpansNoVolumeIsNotTaken)
{
    Nifti file;
    file.setSform(std::vector<float>(12, 0.0f));
    const auto opened = [&](const std::string& told) {
        const Notices notices;
        const auto source = sourceOf(writeBytes("a.nii", file.bytes));
        EXPECT_EQ(notices.text().empty(), told.empty()) << notices.text();
        EXPECT_TRUE(notices.has(told)) << notices.text();
        return source;
    };
    const auto bare = opened("lies where its spacing says");
    ASSERT_TRUE(bare);
    expectPlace(*bare, {0.5, 1, 0.5}, {0, 0, 0}, 1e-6);
    put<std::int16_t>(file.bytes, 252, 1);
    put<float>(file.bytes, 268, 5.0f);
    const auto turned = opened("lies where its qform says");
    ASSERT_TRUE(turned);
    expectPlace(*turned, {0, 1, 1}, {-5, -2, 3}, 1e-6);
    // A single slice needs no third axis.
    file.setSize({2, 3, 4, 1, 1, 1, 1, 1});
    file.setSform({0, 2, 0, 1, 2, 0, 0, 1, 0, 0, 0, 1});
    const auto slice = opened("");
    ASSERT_TRUE(slice);
    expectPlace(*slice, {1, 0, 0}, {-1, -3, 1}, 1e-6);
    EXPECT_EQ(slice->describe().spacing, glm::dvec3(2, 2, 3));
}

TEST_F(Itk, ANiftiWithoutSformLiesByItsQuaternion)
{
    Nifti file;
    put<std::int16_t>(file.bytes, 252, 1);
    put<float>(file.bytes, 256 + 8, float(std::sqrt(0.5))); // a quarter turn around z
    put<float>(file.bytes, 268, 5.0f);
    put<float>(file.bytes, 76, -1.0f); // left-handed
    const auto source = sourceOf(writeBytes("a.nii", file.bytes));
    ASSERT_TRUE(source);
    expectPlace(*source, {0, 0, 0}, {-5, 0, 0}, 1e-6);
    expectPlace(*source, {1, 0, 0}, {-5, -1, 0}, 1e-6); // RAS: +y
    expectPlace(*source, {0, 1, 0}, {-3, 0, 0}, 1e-6);  // RAS: -x
    expectPlace(*source, {0, 0, 1}, {-5, 0, -3}, 1e-6);
    put<std::int16_t>(file.bytes, 252, 0); // nothing: around the origin
    const auto around = sourceOf(writeBytes("a.nii", file.bytes));
    ASSERT_TRUE(around);
    expectPlace(*around, {0.5, 1, 0.5}, {0, 0, 0}, 1e-6);
    expectPlace(*around, {1.5, 1, 0.5}, {1, 0, 0}, 1e-6);
}

TEST_F(Itk, NiftiValuesAreScaled)
{
    Nifti file;
    put<float>(file.bytes, 112, 2.0f);
    put<float>(file.bytes, 116, 100.0f);
    const auto whole = sourceOf(writeBytes("a.nii", file.bytes));
    ASSERT_TRUE(whole);
    EXPECT_EQ(whole->describe().type, VoxelType::UINT8); // 94 ... 116
    EXPECT_EQ(valuesOf(*whole)[11], 116);
    put<float>(file.bytes, 112, 0.5f);
    const auto half = sourceOf(writeBytes("a.nii", file.bytes));
    ASSERT_TRUE(half);
    EXPECT_EQ(half->describe().type, VoxelType::FLOAT32);
    EXPECT_EQ(valuesOf(*half)[0], 98.5);
}

TEST_F(Itk, NiftiHasTimeStepsVectorsAndColours)
{
    Nifti file;
    file.setSize({4, 2, 1, 3, 2, 1, 1, 1});
    const auto steps = sourceOf(writeBytes("a.nii", file.bytes));
    ASSERT_TRUE(steps);
    EXPECT_EQ(steps->stepCount(), 2);
    EXPECT_EQ(valuesOf(*steps)[6], 3);
    file.setSize({5, 2, 1, 3, 1, 2, 1, 1});
    Notices notices;
    const auto vector = sourceOf(writeBytes("a.nii", file.bytes));
    ASSERT_TRUE(vector);
    EXPECT_TRUE(notices.has("of 2 numbers per sample")) << notices.text();
    EXPECT_EQ(valuesOf(*vector)[5], 2);
    EXPECT_EQ(valuesOf(*sourceOf(path("a.nii"), "channel=1"))[5], 8);
    const auto listed = listVolumes(path("a.nii"));
    ASSERT_TRUE(listed.ok()) << listed.status.text;
    ASSERT_EQ(listed->size(), 1u);
    EXPECT_EQ((*listed)[0].channels, 2);
    EXPECT_EQ((*listed)[0].size, osg::Vec3i(2, 1, 3));
    EXPECT_TRUE((*listed)[0].chosen);
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("channel=2");
    EXPECT_EQ(readVoxels(path("a.nii"), options).status.code, ErrorCode::INDEX_OUT_OF_RANGE);
    file.setSize({3, 4, 2, 1, 1, 1, 1, 1});
    file.setType(128, 24);
    file.bytes.replace(
        352, 24, std::string("\x64\x64\x64\xff\0\0\0\xff\0\0\0\xff", 12) + std::string(12, '\1'));
    const auto colours = sourceOf(writeBytes("a.nii", file.bytes));
    ASSERT_TRUE(colours);
    EXPECT_EQ(valuesOf(*colours), (std::vector<double>{100, 54, 182, 18, 1, 1, 1, 1}));
}

TEST_F(Itk, WideIntegersBecomeAsNarrowAsTheyAre)
{
    Nifti file;
    file.setType(1024, 64);
    file.bytes.resize(352);
    for (int i = 0; i < 12; ++i) {
        file.bytes += std::string(8, ' ');
        put<std::int64_t>(file.bytes, file.bytes.size() - 8, i - 3);
    }
    EXPECT_EQ(sourceOf(writeBytes("a.nii", file.bytes))->describe().type, VoxelType::INT8);
    put<std::int64_t>(file.bytes, 352, std::int64_t(1) << 40);
    const auto wide = sourceOf(writeBytes("a.nii", file.bytes));
    EXPECT_EQ(wide->describe().type, VoxelType::FLOAT64);
    EXPECT_EQ(valuesOf(*wide)[0], double(std::int64_t(1) << 40));
}

TEST_F(Itk, AnalyzeIsAPairOfFiles)
{
    Nifti file;
    std::memset(&file.bytes[344], 0, 4);
    put<float>(file.bytes, 108, 0.0f);
    writeBytes("a.hdr", file.bytes.substr(0, 348));
    writeBytes("a.img", file.bytes.substr(352));
    for (const char* name : {"a.hdr", "a.img"}) {
        const auto source = sourceOf(path(name));
        ASSERT_TRUE(source) << name;
        EXPECT_EQ(valuesOf(*source)[0], -3);
        EXPECT_EQ(source->describe().spacing, glm::dvec3(1, 2, 3));
    }
    // SPM's scale, as nibabel takes it, and transform.
    put<float>(file.bytes, 112, 0.5f);
    writeBytes("a.hdr", file.bytes.substr(0, 348));
    {
        const Notices notices;
        EXPECT_EQ(valuesOf(*sourceOf(path("a.hdr")))[0], -1.5);
        EXPECT_EQ(notices.text(), "");
    }
    put<float>(file.bytes, 112, std::numeric_limits<float>::quiet_NaN());
    writeBytes("a.hdr", file.bytes.substr(0, 348));
    writeBytes("a.mat", "");
    const Notices notices;
    EXPECT_EQ(valuesOf(*sourceOf(path("a.img")))[0], -3);
    EXPECT_TRUE(notices.has("a.mat is not applied")) << notices.text();
}

TEST_F(Itk, ANrrdLiesWhereItSaysInEverySpace)
{
    const auto placed = [&](const std::string& space) {
        const auto source = sourceOf(
            writeBytes("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 3\nspace: " + space +
                                     "\nsizes: 2 1 2\nspace directions: (2,0.5,0) (0,3,0) (0,1,4)\n"
                                     "kinds: domain domain domain\nencoding: raw\n"
                                     "space origin: (10,20,30)\n\n\1\2\3\4"));
        EXPECT_TRUE(source);
        EXPECT_EQ(valuesOf(*source), (std::vector<double>{1, 2, 3, 4}));
        return io::placeOf(source->describe(), {1, 0, 1});
    };
    EXPECT_LT(glm::distance(placed("left-posterior-superior"), {12, 21.5, 34}), 1e-9);
    EXPECT_LT(glm::distance(placed("right-anterior-superior"), {-12, -21.5, 34}), 1e-9);
    for (const char* space : {"left-anterior-superior", "Left-Anterior-Superior", "LAS", "las"})
        EXPECT_LT(glm::distance(placed(space), {12, -21.5, 34}), 1e-9) << space;
    EXPECT_LT(glm::distance(placed("ras"), {-12, -21.5, 34}), 1e-9);
}

TEST_F(Itk, ANrrdWithTimeLiesWhereItSaysInEverySpace)
{
    const auto placed = [&](const std::string& space) {
        const auto source = sourceOf(
            writeBytes("a.nrrd", "NRRD0004\ntype: uint8\ndimension: 4\nspace: " + space +
                                     "\nsizes: 2 1 1 2\nspace directions: (2,0,0,0) (0,3,0,0) "
                                     "(0,0,4,0) (0,0,0,1)\nencoding: raw\n"
                                     "space origin: (10,20,30,0)\n\n\1\2\3\4"));
        EXPECT_TRUE(source);
        EXPECT_EQ(source->stepCount(), 2);
        return io::placeOf(source->describe(), {1, 0, 0});
    };
    for (const char* space : {"left-posterior-superior-time", "LPST"})
        EXPECT_LT(glm::distance(placed(space), {12, 20, 30}), 1e-9) << space;
    for (const char* space : {"right-anterior-superior-time", "RAST"})
        EXPECT_LT(glm::distance(placed(space), {-12, -20, 30}), 1e-9) << space;
    for (const char* space : {"left-anterior-superior-time", "LAST"})
        EXPECT_LT(glm::distance(placed(space), {12, -20, 30}), 1e-9) << space;
}

TEST_F(Itk, OtherUnitsOfLengthBecomeMillimetres)
{
    const std::string nrrd = "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 2 1 2\nencoding: raw\n";
    const auto step = [&](const std::string& name, const std::string& bytes) {
        const auto source = sourceOf(writeBytes(name, bytes));
        EXPECT_TRUE(source);
        return source ? io::placeOf(source->describe(), {1, 0, 1}) : glm::dvec3(0.0);
    };
    const auto spaced = [&](const std::string& unit) {
        const std::string quoted = " \"" + unit + "\"";
        return step("a.nrrd", nrrd + "space: LPS\nspace units:" + quoted + quoted + quoted +
                                  "\nspace directions: (2,0,0) (0,2,0) (0,0,3)\n"
                                  "space origin: (5,6,7)\n\n\1\2\3\4");
    };
    EXPECT_LT(glm::distance(spaced("mm"), {7, 6, 10}), 1e-9);
    EXPECT_LT(glm::distance(spaced("cm"), {70, 60, 100}), 1e-9);
    EXPECT_LT(glm::distance(spaced("m"), {7000, 6000, 10000}), 1e-9);
    for (const char* unit : {"um", "\xc2\xb5m", "Microns", "micrometer"})
        EXPECT_LT(glm::distance(spaced(unit), {0.007, 0.006, 0.01}), 1e-9) << unit;
    const glm::dvec3 bare = step("b.nrrd", nrrd + "units: \"um\" \"um\" \"um\"\nspacings: 2 2 3\n"
                                                  "centerings: node node node\n\n\1\2\3\4");
    EXPECT_LT(glm::distance(bare, {0.002, 0, 0.003}), 1e-9);
    const std::string meta = "ObjectType = Image\nNDims = 3\nDimSize = 2 1 2\nOffset = 5 6 7\n"
                             "ElementSpacing = 2 2 3\nElementType = MET_UCHAR\n";
    const std::string data = "ElementDataFile = LOCAL\n\1\2\3\4";
    EXPECT_LT(
        glm::distance(step("a.mha", meta + "DistanceUnits = um\n" + data), {0.007, 0.006, 0.01}),
        1e-9);
    EXPECT_LT(glm::distance(step("b.mha", meta + "DistanceUnits = cm\n" + data), {70, 60, 100}),
              1e-9);
}

TEST_F(Itk, TheUnitOfMicroscopesIsTold)
{
    std::string head(1024, '\0');
    const std::int32_t size[] = {2, 1, 2, 0};
    for (std::size_t i = 0; i < 4; ++i)
        put<std::int32_t>(head, 4 * i, size[i]);
    for (std::size_t i = 0; i < 3; ++i) {
        put<std::int32_t>(head, 28 + 4 * i, size[i]);
        put<float>(head, 40 + 4 * i, float(3 * size[i]));
        put<float>(head, 52 + 4 * i, 90.0f);
        put<std::int32_t>(head, 64 + 4 * i, std::int32_t(i) + 1);
    }
    head.replace(208, 8, std::string("MAP \x44\x44\0\0", 8));
    const Notices notices;
    const auto source = sourceOf(writeBytes("a.mrc", head + "\1\2\3\4"));
    ASSERT_TRUE(source);
    EXPECT_EQ(source->describe().spacing, glm::dvec3(3));
    EXPECT_TRUE(notices.has("its unit of length is the \xc3\xa5ngstr\xc3\xb6m")) << notices.text();
}

TEST_F(Itk, DamagedFilesAreRefusedBeforeThereIsMemory)
{
    const auto refused = [&](const std::string& name, const std::string& bytes) {
        const auto voxels = readVoxels(writeBytes(name, bytes));
        EXPECT_FALSE(voxels.ok()) << name;
        EXPECT_EQ(voxels.status.text.find(path(name)), 0u) << voxels.status.text;
        return voxels.status.code;
    };
    const ErrorCode bad = ErrorCode::FILE_UNREADABLE;
    Nifti file;
    file.setSize({3, 30000, 30000, 300, 1, 1, 1, 1});
    EXPECT_EQ(refused("a.nii", file.bytes), bad);
    EXPECT_EQ(refused("a.nii", file.bytes.substr(0, 300)), bad);
    file = Nifti();
    EXPECT_EQ(refused("b.nii", file.bytes.substr(0, file.bytes.size() - 1)), bad);
    file.setSize({3, 2, -3, 2, 1, 1, 1, 1});
    EXPECT_EQ(refused("a.nii", file.bytes), ErrorCode::VALUE_INVALID);
    file.setSize({9, 2, 3, 2, 1, 1, 1, 1});
    EXPECT_EQ(refused("a.nii", file.bytes), ErrorCode::VALUE_INVALID);
    file = Nifti();
    file.setType(1536, 128);
    EXPECT_EQ(refused("a.nii", file.bytes), ErrorCode::NOT_SUPPORTED);
    const std::string nrrd = "NRRD0004\ntype: float\ndimension: 3\nsizes: 9000 9000 900\n";
    EXPECT_EQ(refused("a.nrrd", nrrd + "encoding: raw\n\nxxxx"), bad);
    EXPECT_EQ(refused("a.nrrd", nrrd + "encoding: gzip\n\nxxxx"), bad);
    EXPECT_EQ(refused("a.nrrd", "NRRD0004\nno such field\n\n"), bad);
    const std::string meta = "ObjectType = Image\nNDims = 3\nDimSize = 9000 9000 900\n"
                             "ElementType = MET_SHORT\n";
    EXPECT_EQ(refused("a.mha", meta + "ElementDataFile = LOCAL\nxxxx"), bad);
    EXPECT_EQ(refused("a.mhd", meta + "ElementDataFile = gone.raw\n"), bad);
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("dataset=2");
    EXPECT_EQ(readVoxels(writeBytes("a.nii", Nifti().bytes), options).status.code,
              ErrorCode::VALUE_INVALID);
}

TEST_F(Itk, CutAnywhereANiftiIsRefused)
{
    const std::string bytes = Nifti().bytes;
    for (std::size_t length = 1; length < bytes.size(); ++length) {
        const auto voxels = readVoxels(writeBytes("cut.nii", bytes.substr(0, length)));
        ASSERT_EQ(voxels.status.code, ErrorCode::FILE_UNREADABLE) << length;
    }
}

/// As nibabel reads it; the position and steps of its affine, turned to LPS.
struct Known
{
    const char* name;
    glm::ivec3 size;
    int steps;
    double sum, weighted;
    glm::dvec3 position, x, y, z;
};

const std::string NIBABEL = "/usr/lib/python3/dist-packages/nibabel/tests/data/";

const Known KNOWN[] = {
    // clang-format off
    {"anatomical.nii", {33, 41, 25}, 1, 284166082, 144821623278,
     {-32, 40, -16}, {2, 0, 0}, {0, -2, 0}, {0, 0, 2}},
    {"functional.nii", {17, 21, 3}, 20, 77913290.362923622, 39770527336.374702,
     {-32, 40, 0}, {4, 0, 0}, {0, -4, 0}, {0, 0, 8}},
    {"reoriented_anat_moved.nii", {21, 26, 22}, 1, 32739769.449157715, 17204892697.188293,
     {35.2979, 47.9776, -27.5994}, {-4, 0, 0}, {0, -4, 0}, {0, 0, 4}},
    {"example4d.nii.gz", {128, 96, 24}, 2, 101985356, 52210230202,
     {-117.855, 35.7229, -7.2488}, {2, 0, 0}, {0, -1.97371, 0.323208}, {0, 0.355528, 2.17108}},
    {"example_nifti2.nii.gz", {32, 20, 12}, 2, 6926802, 3531239064,
     {-117.855, 35.7229, -7.2488}, {2, 0, 0}, {0, -1.97371, 0.323208}, {0, 0.355528, 2.17108}},
    {"standard.nii.gz", {4, 5, 7}, 1, 7650, 556920,
     {0, 0, 0}, {-1, 0, 0}, {0, -3, 0}, {0, 0, 2}},
    {"test.mgz", {3, 4, 5}, 2, -15.556573834968731, -1235.4065245371312,
     {13, 11.5, -11.5}, {-1, -2, 3}, {-2, -3, 1}, {-3, -1, 2}},
    // clang-format on
};

TEST(ItkTable, FilesOfNibabelAreReadAsItReadsThem)
{
    std::error_code ignored;
    if (!fs::is_directory(NIBABEL, ignored)) {
        std::cout << NIBABEL << " is missing (Debian: python3-nibabel): nothing was compared\n";
        return;
    }
    for (const Known& file : KNOWN) {
        SCOPED_TRACE(file.name);
        const auto voxels = readVoxels(NIBABEL + file.name);
        ASSERT_TRUE(voxels.ok()) << voxels.status.text;
        const VolumeSums sums = sumsOf(*(*voxels)->getSource());
        EXPECT_EQ(sums.size, file.size);
        EXPECT_EQ(sums.steps, file.steps);
        EXPECT_NEAR(sums.sum, file.sum, 1e-8 * std::abs(file.sum));
        EXPECT_NEAR(sums.weighted, file.weighted, 1e-8 * std::abs(file.weighted));
        EXPECT_LT(glm::distance(sums.position, file.position), 1e-3);
        EXPECT_LT(glm::distance(sums.axes[0], file.x), 1e-5);
        EXPECT_LT(glm::distance(sums.axes[1], file.y), 1e-5);
        EXPECT_LT(glm::distance(sums.axes[2], file.z), 1e-5);
    }
    // Holes are no numbers.
    EXPECT_TRUE(readVoxels(NIBABEL + "resampled_anat_moved.nii").ok());
    // A table of connections.
    const auto cifti = readVoxels(NIBABEL + "row_major.dconn.nii");
    EXPECT_EQ(cifti.status.code, ErrorCode::NOT_SUPPORTED);
    EXPECT_NE(cifti.status.text.find("it is no volume"), std::string::npos);
    // Headers whose samples are not there.
    for (const char* name : {"analyze.hdr", "nifti1.hdr", "nifti2.hdr"})
        EXPECT_EQ(readVoxels(NIBABEL + name).status.code, ErrorCode::FILE_NOT_FOUND) << name;
    // MINC 2 by ITK: its place in RAS becomes LPS. As nibabel reads the same in MINC 1.
    const auto minc = readVoxels(NIBABEL + "minc2_1_scale.mnc");
    ASSERT_TRUE(minc.ok()) << minc.status.text;
    const VolumeSums sums = sumsOf(*(*minc)->getSource());
    EXPECT_EQ(sums.size, glm::ivec3(20, 20, 10));
    EXPECT_NEAR(sums.sum, 836.51683334270274, 1e-5);
    EXPECT_LT(glm::distance(sums.position, {20, 20, -10}), 1e-9);
    EXPECT_LT(glm::distance(sums.axes[1], {0, -2, 0}), 1e-9);
}

} // namespace

} // namespace ItkTest

#endif
