// HDF5 files of Imaris, BigDataViewer and others, against what was written to them.

#ifdef OSGVOLUMIZER_HAVE_HDF5

#include "Hdf5Files.h"

#include <osgVolumizer/Paging.h>
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/core/voxels/BrickTree.h>

#include <osgDB/ReadFile>
#include <osgDB/WriteFile>

#include <array>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <thread>

namespace Hdf5Test {

using namespace osgVolumizer;
using core::Box3i;
namespace fs = std::filesystem;

namespace {

class Hdf5 : public Hdf5FolderTest
{
protected:
    /// Compares all samples of a level with what `expected` says, all at once and in parts.
    template <class T>
    static void expectLevel(const Source& source, int level, int step,
                            const std::function<int(const glm::ivec3&)>& expected)
    {
        const glm::ivec3 size = core::BrickTree::levelSize(source.describe().size, level);
        const auto check = [&](const Box3i& region) {
            const std::vector<T> found = samples<T>(source, region, level, step);
            std::size_t i = 0, wrong = 0;
            for (int z = region.min.z; z < region.max.z; ++z)
                for (int y = region.min.y; y < region.max.y; ++y)
                    for (int x = region.min.x; x < region.max.x; ++x)
                        wrong += found[i++] != static_cast<T>(expected({x, y, z}));
            EXPECT_EQ(wrong, 0u) << "level " << level << ", step " << step << ", from "
                                 << region.min.x << "," << region.min.y << "," << region.min.z;
        };
        check({glm::ivec3(0), size});
        std::mt19937 random(1);
        for (int i = 0; i < 12; ++i) {
            Box3i region;
            for (int axis = 0; axis < 3; ++axis) {
                const int n = size[axis];
                region.min[axis] = std::uniform_int_distribution<>(0, n - 1)(random);
                region.max[axis] = std::uniform_int_distribution<>(region.min[axis] + 1, n)(random);
            }
            check(region);
        }
        check({size - 1, size});
    }

    static std::string imarisPath(int level, int step, int channel)
    {
        return "/DataSet/ResolutionLevel " + std::to_string(level) + "/TimePoint " +
               std::to_string(step) + "/Channel " + std::to_string(channel);
    }
    /// A level of an Imaris file, padded to pieces of 16.
    template <class T>
    static void writeImaris(Hdf5Writer& file, int level, int step, int channel,
                            const glm::ivec3& size)
    {
        const auto padded = [](int n) { return (n + 15) / 16 * 16; };
        const std::string group = imarisPath(level, step, channel);
        std::vector<T> all(std::size_t(padded(size.x)) * padded(size.y) * padded(size.z), 255);
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x)
                    all[(std::size_t(z) * padded(size.y) + y) * padded(size.x) + x] =
                        static_cast<T>(value(x, y, z, step + 10 * channel, level));
        file.dataset(group + "/Data",
                     {hsize_t(padded(size.z)), hsize_t(padded(size.y)), hsize_t(padded(size.x))},
                     all, Hdf5Writer::nativeType<T>(), {16, 16, 16}, H5Z_FILTER_DEFLATE);
        for (int axis = 0; axis < 3; ++axis)
            file.attribute(group, std::string("ImageSize") + "XYZ"[axis],
                           std::to_string(size[axis]));
    }
};

// Extremes of T, in the file as `type`.
template <class T>
void expectType(Hdf5FolderTest&, const std::string& path, hid_t type, VoxelType expected)
{
    const std::vector<T> values{std::numeric_limits<T>::lowest(),
                                std::numeric_limits<T>::max(),
                                T(0),
                                T(1),
                                T(100),
                                T(77),
                                T(3),
                                T(2)};
    {
        Hdf5Writer file(path);
        file.dataset("/a", {2, 2, 2}, values, type);
    }
    const auto voxels = readVoxels(path);
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_EQ((*voxels)->getType(), expected);
    ASSERT_EQ(voxelTypeSize((*voxels)->getType()), sizeof(T));
    std::vector<T> found(8);
    ASSERT_TRUE((*voxels)->getSource()->read({glm::ivec3(0), glm::ivec3(2)}, found.data()));
    EXPECT_EQ(found, values) << voxelTypeName(expected);
}

} // namespace

TEST_F(Hdf5, EveryTypeInEveryByteOrder)
{
    const std::string file = path("types.h5");
    expectType<std::int8_t>(*this, file, H5T_STD_I8LE, VoxelType::INT8);
    expectType<std::uint8_t>(*this, file, H5T_STD_U8BE, VoxelType::UINT8);
    expectType<std::int16_t>(*this, file, H5T_STD_I16LE, VoxelType::INT16);
    expectType<std::int16_t>(*this, file, H5T_STD_I16BE, VoxelType::INT16);
    expectType<std::uint16_t>(*this, file, H5T_STD_U16LE, VoxelType::UINT16);
    expectType<std::uint16_t>(*this, file, H5T_STD_U16BE, VoxelType::UINT16);
    expectType<std::int32_t>(*this, file, H5T_STD_I32LE, VoxelType::INT32);
    expectType<std::int32_t>(*this, file, H5T_STD_I32BE, VoxelType::INT32);
    expectType<std::uint32_t>(*this, file, H5T_STD_U32LE, VoxelType::UINT32);
    expectType<std::uint32_t>(*this, file, H5T_STD_U32BE, VoxelType::UINT32);
    expectType<float>(*this, file, H5T_IEEE_F32LE, VoxelType::FLOAT32);
    expectType<float>(*this, file, H5T_IEEE_F32BE, VoxelType::FLOAT32);
}

TEST_F(Hdf5, WiderTypesAreRounded)
{
    const std::vector<double> values{-1e300, 0.1, 1e20, 2.0, 3.0, -4.5, 6.0, 7.0};
    const std::vector<std::int64_t> integers{-(std::int64_t(1) << 60), 1, 2, 3, 4, 5, 6, 7};
    {
        Hdf5Writer file(path("wide.h5"));
        file.dataset("/double", {2, 2, 2}, values, H5T_IEEE_F64BE);
        file.dataset("/long", {2, 2, 2}, integers);
    }
    const auto doubles = open("wide.h5", "dataset=/double");
    const auto longs = open("wide.h5", "dataset=/long");
    ASSERT_TRUE(doubles && longs);
    EXPECT_EQ(doubles->describe().type, VoxelType::FLOAT32);
    EXPECT_EQ(longs->describe().type, VoxelType::FLOAT32);
    const Box3i all{glm::ivec3(0), glm::ivec3(2)};
    const std::vector<float> a = samples<float>(*doubles, all), b = samples<float>(*longs, all);
    EXPECT_EQ(a[0], -std::numeric_limits<float>::infinity());
    for (std::size_t i = 1; i < 8; ++i)
        EXPECT_EQ(a[i], static_cast<float>(values[i]));
    for (std::size_t i = 0; i < 8; ++i)
        EXPECT_EQ(b[i], static_cast<float>(integers[i]));
}

TEST_F(Hdf5, EnumerationsAreTheirNumbers)
{
    const hid_t mask = H5Tenum_create(H5T_NATIVE_INT8); // as h5py writes bool
    for (const auto& [name, number] :
         {std::pair<const char*, std::int8_t>{"FALSE", 0}, {"TRUE", 1}})
        H5Tenum_insert(mask, name, &number);
    const std::vector<std::int8_t> values{0, 1, 1, 0, 1, 0, 0, 0};
    {
        Hdf5Writer file(path("mask.hdf5"));
        file.dataset("/mask", {2, 2, 2}, std::vector<std::int8_t>(), mask);
        const hid_t id = H5Dopen2(file.id(), "/mask", H5P_DEFAULT);
        EXPECT_GE(H5Dwrite(id, mask, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
        H5Dclose(id);
    }
    H5Tclose(mask);
    const auto source = open("mask.hdf5");
    ASSERT_TRUE(source);
    EXPECT_EQ(samples<std::int8_t>(*source, {glm::ivec3(0), glm::ivec3(2)}), values);
}

TEST_F(Hdf5, RegionsOfAPackedDataset)
{
    {
        Hdf5Writer file(path("packed.H5"));
        file.dataset("/volume", {30, 40, 50}, volume<std::uint16_t>(50, 40, 30), H5T_STD_U16BE,
                     {7, 16, 11}, H5Z_FILTER_DEFLATE);
        file.attribute("/volume", "element_size_um", std::vector<double>{2.0, 0.5, 0.25});
    }
    const auto voxels = read("packed.H5");
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_FALSE((*voxels)->isPaged());
    EXPECT_EQ((*voxels)->getSize(), osg::Vec3i(50, 40, 30));
    EXPECT_EQ((*voxels)->getSpacing(), osg::Vec3d(0.25, 0.5, 2.0));
    EXPECT_EQ((*voxels)->getOrigin(), osg::Vec3d());
    EXPECT_EQ((*voxels)->getRange(), osg::Vec2d(0, 250));
    const VoxelSource& source = *(*voxels)->getSource();
    EXPECT_EQ(source.levelCount(), 1);
    EXPECT_FALSE(source.valueRange({glm::ivec3(0), glm::ivec3(9)}));
    expectLevel<std::uint16_t>(source, 0, 0,
                               [](const glm::ivec3& p) { return value(p.x, p.y, p.z); });
    const auto said = read("packed.H5", "spacing=1,2,3 origin=4,5,6");
    ASSERT_TRUE(said.ok());
    EXPECT_EQ((*said)->getSpacing(), osg::Vec3d(1, 2, 3));
    EXPECT_EQ((*said)->getOrigin(), osg::Vec3d(4, 5, 6));
}

TEST_F(Hdf5, TheLargestVolumeOrTheOneThatIsNamed)
{
    {
        Hdf5Writer file(path("many.h5"));
        file.dataset("/a/small", {2, 3, 4}, volume<std::uint8_t>(4, 3, 2, 1));
        file.dataset("/b/large volume", {3, 4, 5}, volume<std::uint8_t>(5, 4, 3));
        file.dataset("/list", {1000}, std::vector<float>(1000));
        file.dataset("/picture", {100, 100}, std::vector<float>(10000));
        file.dataset("/five", {3, 3, 3, 3, 3}, std::vector<float>(243));
        file.dataset("/channels", {1, 2, 3, 4, 1}, volume<std::uint8_t>(4, 3, 2, 2));
    }
    const auto sizeBy = [this](const std::string& options) {
        const auto source = open("many.h5", options);
        return source ? source->describe().size : glm::ivec3(0);
    };
    EXPECT_EQ(sizeBy(""), glm::ivec3(5, 4, 3));
    EXPECT_EQ(sizeBy("dataset=\"/b/large volume\""), glm::ivec3(5, 4, 3));
    EXPECT_EQ(sizeBy("dataset=a/small"), glm::ivec3(4, 3, 2));
    const auto listed = listVolumes(path("many.h5"));
    ASSERT_TRUE(listed.ok()) << listed.status.text;
    std::vector<std::string> names;
    for (const VolumeEntry& entry : *listed)
        names.push_back((entry.chosen ? "*" : "") + entry.name);
    EXPECT_EQ((std::vector<std::string>{"/a/small", "*/b/large volume", "/channels"}), names);
    // Axes of one sample in front and behind are no time and no volume.
    const auto channels = open("many.h5", "dataset=/channels");
    ASSERT_TRUE(channels);
    EXPECT_EQ(channels->stepCount(), 1);
    expectLevel<std::uint8_t>(*channels, 0, 0,
                              [](const glm::ivec3& p) { return value(p.x, p.y, p.z, 2); });
}

TEST_F(Hdf5, AFourthAxisIsTime)
{
    std::vector<std::int16_t> all;
    for (int step = 0; step < 3; ++step) {
        const auto one = volume<std::int16_t>(90, 5, 6, step);
        all.insert(all.end(), one.begin(), one.end());
    }
    {
        Hdf5Writer file(path("time.h5"));
        file.dataset("/t", {3, 6, 5, 90}, all);
    }
    const auto voxels = read("time.h5");
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_TRUE((*voxels)->isPaged());
    EXPECT_EQ((*voxels)->getStepCount(), 3);
    const VoxelSource& source = *(*voxels)->getSource();
    ASSERT_EQ(source.levelCount(), 2);
    for (int step = 0; step < 3; ++step) {
        expectLevel<std::int16_t>(
            source, 0, step, [step](const glm::ivec3& p) { return value(p.x, p.y, p.z, step); });
        expectLevel<std::int16_t>(source, 1, step, [step](const glm::ivec3& p) {
            return value(2 * p.x + 1, std::min(2 * p.y + 1, 4), 2 * p.z + 1, step);
        });
    }
    char byte = 0;
    EXPECT_EQ(source.readStep(3, 0, {glm::ivec3(0), glm::ivec3(1)}, &byte).code,
              ErrorCode::INDEX_OUT_OF_RANGE);
    EXPECT_EQ(source.readStep(-1, 0, {glm::ivec3(0), glm::ivec3(1)}, &byte).code,
              ErrorCode::INDEX_OUT_OF_RANGE);
    EXPECT_EQ(source.readStep(0, 2, {glm::ivec3(0), glm::ivec3(1)}, &byte).code,
              ErrorCode::INDEX_OUT_OF_RANGE);
    EXPECT_EQ(source.readStep(0, 1, {glm::ivec3(0), {46, 1, 1}}, &byte).code,
              ErrorCode::INDEX_OUT_OF_RANGE);
}

// Levels as Imaris makes them: halves of the long axes first, odd sizes rounded down, and one that
// is no half at all.
TEST_F(Hdf5, ImarisWithItsLevelsChannelsAndSteps)
{
    const glm::ivec3 sizes[] = {{200, 130, 40}, {100, 65, 40}, {70, 40, 30}, {50, 32, 20}};
    {
        Hdf5Writer file(path("cells.ims"));
        for (int level = 0; level < 4; ++level)
            for (int step = 0; step < 2; ++step)
                for (int channel = 0; channel < 2; ++channel)
                    writeImaris<std::uint8_t>(file, level, step, channel, sizes[level]);
        const char* const low[] = {"-10.0", "0", "5"};
        const char* const high[] = {"90.0 ", "32.5", "45"};
        for (int axis = 0; axis < 3; ++axis) {
            file.attribute("/DataSetInfo/Image", "ExtMin" + std::to_string(axis), low[axis]);
            file.attribute("/DataSetInfo/Image", "ExtMax" + std::to_string(axis), high[axis]);
        }
    }
    const auto first = read("cells.ims"), second = read("cells.ims", "channel=1");
    ASSERT_TRUE(first.ok()) << first.status.text;
    ASSERT_TRUE(second.ok()) << second.status.text;
    EXPECT_EQ((*first)->getSize(), osg::Vec3i(200, 130, 40));
    EXPECT_EQ((*first)->getSpacing(), osg::Vec3d(0.5, 0.25, 1.0));
    EXPECT_EQ((*first)->getOrigin(), osg::Vec3d(-9.75, 0.125, 5.5));
    EXPECT_EQ((*first)->getStepCount(), 2);
    EXPECT_TRUE((*first)->isPaged());
    for (int channel = 0; channel < 2; ++channel) {
        const VoxelSource& source = *(channel ? *second : *first)->getSource();
        ASSERT_EQ(source.levelCount(), 3);
        for (int step = 0; step < 2; ++step) {
            const int which = step + 10 * channel;
            expectLevel<std::uint8_t>(source, 0, step, [which](const glm::ivec3& p) {
                return value(p.x, p.y, p.z, which);
            });
            expectLevel<std::uint8_t>(source, 1, step, [which](const glm::ivec3& p) {
                return value(p.x, p.y, 2 * p.z + 1, which, 1);
            });
            expectLevel<std::uint8_t>(source, 2, step, [which](const glm::ivec3& p) {
                return value(p.x, std::min(p.y, 31), 2 * p.z + 1, which, 3);
            });
        }
    }
    // A dataset that is named is read as such, with what fills its pieces.
    const auto plain = open("cells.ims", "dataset=\"" + imarisPath(3, 1, 0) + "/Data\"");
    ASSERT_TRUE(plain);
    EXPECT_EQ(plain->describe().size, glm::ivec3(64, 32, 32));
}

// Factors as they are said, whatever the sizes look like; 16-bit numbers without sign.
TEST_F(Hdf5, BigDataViewerWithItsMipmapsSetupsAndSteps)
{
    const glm::ivec3 sizes[] = {{150, 70, 9}, {75, 35, 9}, {50, 23, 9}, {37, 17, 4}};
    {
        Hdf5Writer file(path("embryo.h5"));
        for (const int setup : {2, 11})
            for (int step = 0; step < 2; ++step)
                for (int level = 0; level < 4; ++level) {
                    const glm::ivec3 s = sizes[level];
                    std::vector<std::uint16_t> values =
                        volume<std::uint16_t>(s.x, s.y, s.z, step + setup, level);
                    for (std::uint16_t& v : values)
                        v = std::uint16_t(v * 257);
                    std::vector<std::int16_t> bits(values.size());
                    std::memcpy(bits.data(), values.data(), 2 * values.size());
                    file.dataset("/t0000" + std::to_string(step) +
                                     (setup == 2 ? "/s02/" : "/s11/") + std::to_string(level) +
                                     "/cells",
                                 {hsize_t(s.z), hsize_t(s.y), hsize_t(s.x)}, bits, H5T_STD_I16LE,
                                 {4, 16, 16}, H5Z_FILTER_DEFLATE);
                }
        file.dataset("/s02/resolutions", {4, 3},
                     std::vector<double>{1, 1, 1, 2, 2, 1, 3, 3, 1, 4, 4, 2});
    }
    for (const int setup : {2, 11}) {
        const auto voxels = read("embryo.h5", setup == 2 ? "" : "channel=11");
        ASSERT_TRUE(voxels.ok()) << voxels.status.text;
        EXPECT_EQ((*voxels)->getType(), VoxelType::UINT16);
        EXPECT_EQ((*voxels)->getSize(), osg::Vec3i(150, 70, 9));
        const VoxelSource& source = *(*voxels)->getSource();
        ASSERT_EQ(source.stepCount(), 2);
        ASSERT_EQ(source.levelCount(), 3);
        for (int step = 0; step < 2; ++step) {
            const int which = step + setup;
            expectLevel<std::uint16_t>(source, 0, step, [which](const glm::ivec3& p) {
                return 257 * value(p.x, p.y, p.z, which);
            });
            expectLevel<std::uint16_t>(source, 1, step, [which](const glm::ivec3& p) {
                return 257 * value(p.x, p.y, std::min(2 * p.z + 1, 8), which, 1);
            });
            expectLevel<std::uint16_t>(source, 2, step, [which](const glm::ivec3& p) {
                return 257 * value(std::min(p.x, 36), std::min(p.y, 16), std::min(2 * p.z + 1, 3),
                                   which, 3);
            });
        }
    }
}

TEST_F(Hdf5, WhatTakesHalfOfTheBudgetIsPaged)
{
    {
        Hdf5Writer file(path("large.h5"));
        file.dataset("/large", {65, 130, 129}, volume<std::uint8_t>(129, 130, 65));
    }
    const PagingBudget before = getPagingBudget();
    PagingBudget small = before;
    small.memoryBytes = 1 << 20;
    EXPECT_FALSE((*read("large.h5"))->isPaged());
    ASSERT_TRUE(setPagingBudget(small));
    const auto voxels = read("large.h5");
    ASSERT_TRUE(setPagingBudget(before));
    ASSERT_TRUE(voxels.ok());
    EXPECT_TRUE((*voxels)->isPaged());
    const VoxelSource& source = *(*voxels)->getSource();
    ASSERT_EQ(source.levelCount(), 3);
    expectLevel<std::uint8_t>(source, 2, 0, [](const glm::ivec3& p) {
        const auto at = [](int i, int last) { return std::min(4 * i + 2, last); };
        return value(at(p.x, 128), at(p.y, 129), at(p.z, 64));
    });
}

TEST_F(Hdf5, AFileMayBeDeletedAndCopiesShareIt)
{
    {
        Hdf5Writer file(path("gone.h5"));
        file.dataset("/v", {8, 8, 8}, volume<std::uint8_t>(8, 8, 8));
    }
    auto source = open("gone.h5");
    ASSERT_TRUE(source);
    const osg::ref_ptr<VoxelSource> copy =
        dynamic_cast<VoxelSource*>(source->clone(osg::CopyOp::DEEP_COPY_ALL));
    ASSERT_TRUE(copy);
    source = nullptr;
    fs::remove(path("gone.h5"));
    EXPECT_EQ(samples<std::uint8_t>(*copy, {glm::ivec3(0), glm::ivec3(8)}),
              volume<std::uint8_t>(8, 8, 8));
}

TEST_F(Hdf5, ThreadsReadSideBySide)
{
    for (int i = 0; i < 2; ++i) {
        Hdf5Writer file(path("threads" + std::to_string(i) + ".h5"));
        file.dataset("/v", {60, 60, 60}, volume<std::uint16_t>(60, 60, 60, i), H5T_NATIVE_UINT16,
                     {16, 16, 16}, H5Z_FILTER_DEFLATE);
    }
    const osg::ref_ptr<VoxelSource> shared = open("threads0.h5");
    ASSERT_TRUE(shared);
    std::array<std::size_t, 4> wrong{};
    const auto work = [&](std::size_t thread) {
        std::mt19937 random(unsigned(thread) + 1);
        std::uniform_int_distribution<> at(0, 44);
        for (int i = 0; i < 60; ++i) {
            // Half of them open files of their own, and close them, meanwhile.
            const auto own = thread % 2 ? read("threads1.h5")
                                        : Result<osg::ref_ptr<Voxels>>(osg::ref_ptr<Voxels>());
            if (!own.ok()) ++wrong[thread];
            const VoxelSource& source = *own ? *(*own)->getSource() : *shared;
            const glm::ivec3 min(at(random), at(random), at(random));
            std::vector<std::uint16_t> found(16 * 16 * 16);
            if (!source.read({min, min + 16}, found.data()).ok()) ++wrong[thread];
            for (int k = 0; k < 16 * 16 * 16; ++k)
                wrong[thread] += found[std::size_t(k)] != value(min.x + k % 16, min.y + k / 16 % 16,
                                                                min.z + k / 256, int(thread % 2));
        }
    };
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < wrong.size(); ++i)
        threads.emplace_back(work, i);
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, (std::array<std::size_t, 4>{}));
}

TEST_F(Hdf5, ScenesReferToFileAndDataset)
{
    {
        Hdf5Writer file(path("scene.h5"));
        file.dataset("/the other", {3, 4, 5}, volume<std::uint8_t>(5, 4, 3, 1));
        file.dataset("/large", {4, 5, 6}, volume<std::uint8_t>(6, 5, 4));
        writeImaris<std::uint8_t>(file, 0, 0, 0, {20, 20, 20});
        writeImaris<std::uint8_t>(file, 0, 0, 1, {20, 20, 20});
    }
    const auto other = read("scene.h5", "dataset='/the other' range=1,7");
    const auto channel = read("scene.h5", "channel=1");
    ASSERT_TRUE(other.ok()) << other.status.text;
    ASSERT_TRUE(channel.ok()) << channel.status.text;
    EXPECT_EQ((*other)->getFileOptions(), "range=1,7 dataset=\"/the other\"");
    EXPECT_EQ((*channel)->getFileOptions(), "channel=1");
    for (const char* scene : {"scene.osgt", "scene.osgb", "scene.osgx"}) {
        for (const auto& [voxels, size, step] : {std::tuple(other->get(), glm::ivec3(5, 4, 3), 1),
                                                 std::tuple(channel->get(), glm::ivec3(20), 10)}) {
            const osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
            appearance->setVoxels(voxels);
            ASSERT_TRUE(osgDB::writeObjectFile(*appearance, path(scene)));
            const osg::ref_ptr<osg::Object> object = osgDB::readRefObjectFile(path(scene));
            const auto* copy = dynamic_cast<const VolumeAppearance*>(object.get());
            ASSERT_TRUE(copy && copy->getVoxels() && copy->getVoxels()->valid()) << scene;
            EXPECT_EQ(copy->getVoxels()->getFileOptions(), voxels->getFileOptions());
            EXPECT_EQ(samples<std::uint8_t>(*copy->getVoxels()->getSource(), {glm::ivec3(0), size}),
                      volume<std::uint8_t>(size.x, size.y, size.z, step))
                << scene;
        }
    }
}

TEST_F(Hdf5, SeriesAndThePseudoLoader)
{
    for (int step = 0; step < 3; ++step) {
        Hdf5Writer file(path("v" + std::to_string(step) + ".h5"));
        file.dataset("/large", {9, 9, 9}, std::vector<std::uint8_t>(729));
        file.dataset("/v", {4, 5, 6}, volume<std::uint8_t>(6, 5, 4, step));
    }
    for (const char* name : {"v%d.h5", "", "v#.h5"}) { // the second is the folder
        const auto voxels = read(name, "series=on dataset=/v");
        ASSERT_TRUE(voxels.ok()) << voxels.status.text;
        ASSERT_EQ((*voxels)->getStepCount(), 3);
        for (int step = 0; step < 3; ++step)
            EXPECT_EQ(
                samples<std::uint8_t>(*(*voxels)->getSource(), {glm::ivec3(0), {6, 5, 4}}, 0, step),
                volume<std::uint8_t>(6, 5, 4, step));
    }
    EXPECT_EQ(read("").status.code, ErrorCode::FILE_NOT_FOUND); // of images
    const osg::ref_ptr<osgDB::Options> options = new osgDB::Options("dataset=/v");
    const osg::ref_ptr<osg::Node> node =
        osgDB::readRefNodeFile(path("v1.h5.volume"), options.get());
    const auto* appearance = dynamic_cast<const VolumeAppearance*>(node.get());
    ASSERT_TRUE(appearance);
    EXPECT_EQ(appearance->getVoxels()->getSize(), osg::Vec3i(6, 5, 4));
}

} // namespace Hdf5Test

#endif
