#include <osgVolumizer/Paging.h>
#include <osgVolumizer/ReadVolume.h>
#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/VoxelSeries.h>
#include <osgVolumizer/WriteVoxels.h>

#include "../support/FolderTest.h"
#include "../support/Reports.h"

#include <atomic>
#include <stdexcept>
#include <thread>

namespace VoxelSeriesTest {

using namespace osgVolumizer;
using Source = osg::ref_ptr<VoxelSource>;

namespace {

// 8 x 9 x 10 bytes, of which number i is i + step.
osg::ref_ptr<MemoryVoxelSource> makeStep(int step, const glm::ivec3& size = {8, 9, 10})
{
    VoxelSource::Description d;
    d.size = size;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    EXPECT_TRUE(source->allocate(d));
    for (std::size_t i = 0; i < source->sizeInBytes(); ++i)
        static_cast<unsigned char*>(source->data())[i] = static_cast<unsigned char>(i + step);
    return source;
}

unsigned char firstOf(const VoxelSource& source, int step)
{
    unsigned char value = 0;
    const Status status = source.readStep(step, 0, {{0, 0, 0}, {1, 1, 1}}, &value);
    EXPECT_TRUE(status.ok()) << status.text;
    return value;
}

osg::ref_ptr<osgDB::Options> optionsOf(const std::string& text)
{
    return new osgDB::Options(text);
}

class VoxelSeriesFiles : public support::FolderTest
{
protected:
    void SetUp() override
    {
        FolderTest::SetUp();
        for (int step = 0; step < 3; ++step) {
            const osg::ref_ptr<MemoryVoxelSource> source = makeStep(10 * step);
            const std::string number = std::to_string(step);
            ASSERT_TRUE(writeVoxels(*source, path("v" + number + ".tif")).ok());
            writeBytes("v" + number + ".raw", std::string(static_cast<const char*>(source->data()),
                                                          source->sizeInBytes()));
        }
    }
    static Result<osg::ref_ptr<Voxels>> readSeries(const std::string& name)
    {
        return readVoxels(name, optionsOf("series=on spacing=2,3,4").get());
    }
};

} // namespace

TEST(VoxelSeries, StepsAreOpenedWhenTheyAreRead)
{
    std::vector<int> opened;
    const osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    ASSERT_TRUE(series->setSteps(4, [&](int step) {
        opened.push_back(step);
        return Result<Source>(makeStep(step));
    }));
    EXPECT_EQ(opened, std::vector<int>({0}));
    EXPECT_EQ(series->stepCount(), 4);
    EXPECT_EQ(series->levelCount(), 1);
    EXPECT_EQ(firstOf(*series, 2), 2);
    EXPECT_EQ(firstOf(*series, 0), 0);
    EXPECT_EQ(firstOf(*series, 2), 2);
    EXPECT_EQ(opened, std::vector<int>({0, 2}));
    unsigned char value = 0;
    for (const int step : {-1, 4})
        EXPECT_EQ(series->readStep(step, 0, {{0, 0, 0}, {1, 1, 1}}, &value).code,
                  ErrorCode::INDEX_OUT_OF_RANGE);
    const osg::ref_ptr<Voxels> voxels = new Voxels(series);
    EXPECT_TRUE(voxels->isPaged());
    EXPECT_EQ(voxels->getStepCount(), 4);
    EXPECT_EQ((*voxels->readPage(0, 3)).data[0], 3);
}

TEST(VoxelSeries, CoarserLevelsAreSamples)
{
    const glm::ivec3 size(130, 70, 3);
    const osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    ASSERT_TRUE(series->setSteps({makeStep(0, size), makeStep(5, size)}));
    ASSERT_EQ(series->levelCount(), 3);
    std::vector<unsigned char> values(65 * 35 * 2);
    ASSERT_TRUE(series->readStep(1, 1, {{0, 0, 0}, {65, 35, 2}}, values.data()).ok());
    EXPECT_EQ(values[0], static_cast<unsigned char>((1 * 70 + 1) * 130 + 1 + 5));
    EXPECT_EQ(values[65 + 3], static_cast<unsigned char>((1 * 70 + 3) * 130 + 7 + 5));
    EXPECT_EQ(values.back(), static_cast<unsigned char>((2 * 70 + 69) * 130 + 129 + 5));
}

TEST(VoxelSeries, ThoseInMemoryAreClosedAgain)
{
    PagingBudget budget = defaultPagingBudget();
    budget.memoryBytes = 4 << 20; // a quarter of it has room for two of 0.4 MB
    ASSERT_TRUE(setPagingBudget(budget));
    std::atomic<int> opened{0};
    const osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    ASSERT_TRUE(series->setSteps(9, [&](int step) {
        ++opened;
        return Result<Source>(makeStep(step, {80, 70, 80}));
    }));
    for (int i = 0; i < 3; ++i)
        for (const int step : {1, 2})
            EXPECT_EQ(firstOf(*series, step), step);
    EXPECT_EQ(opened, 3);
    for (int step = 3; step < 9; ++step)
        EXPECT_EQ(firstOf(*series, step), step);
    EXPECT_EQ(opened, 9);
    EXPECT_EQ(firstOf(*series, 1), 1);
    EXPECT_EQ(opened, 10);
    EXPECT_TRUE(setPagingBudget(defaultPagingBudget()));
}

TEST(VoxelSeries, ThreadsOpenAStepOnce)
{
    std::atomic<int> opened{0};
    const osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    ASSERT_TRUE(series->setSteps(3, [&](int step) {
        ++opened;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        return Result<Source>(makeStep(step));
    }));
    std::vector<std::thread> threads;
    for (int i = 0; i < 6; ++i)
        threads.emplace_back([&series, i]() { EXPECT_EQ(firstOf(*series, i % 3), i % 3); });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(opened, 3);
}

TEST(VoxelSeries, WhatDoesNotFitIsRefused)
{
    const support::Reports reports;
    const osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    EXPECT_EQ(Status(series->setSteps(0, [](int) { return Result<Source>(makeStep(0)); })).code,
              ErrorCode::VALUE_INVALID);
    EXPECT_EQ(Status(series->setSteps(2, {})).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(Status(series->setSteps(std::vector<Source>())).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(Status(series->setSteps({nullptr})).code, ErrorCode::FILE_UNREADABLE);
    EXPECT_EQ(series->stepCount(), 1);
    osg::ref_ptr<MemoryVoxelSource> floats = new MemoryVoxelSource;
    VoxelSource::Description d;
    d.size = {8, 9, 10};
    d.type = VoxelType::FLOAT32;
    ASSERT_TRUE(floats->allocate(d));
    ASSERT_TRUE(series->setSteps(6, [&](int step) -> Result<Source> {
        if (step == 1) return Result<Source>(makeStep(0, {8, 9, 11}));
        if (step == 2) return Result<Source>(floats);
        if (step == 3) throw std::runtime_error("the disk is dead");
        if (step == 4) return Status(ErrorCode::FILE_NOT_FOUND, "no such file");
        return Result<Source>(makeStep(0));
    }));
    const std::pair<int, const char*> refusals[] = {{1, "8,9,11 voxels, the first 8,9,10"},
                                                    {2, "of type float32"},
                                                    {3, "the disk is dead"},
                                                    {4, "no such file"}};
    float value[1] = {};
    for (const auto& [step, words] : refusals) {
        const Status status = series->readStep(step, 0, {{0, 0, 0}, {1, 1, 1}}, value);
        EXPECT_FALSE(status.ok());
        EXPECT_NE(status.text.find(words), std::string::npos) << status.text;
    }
    EXPECT_EQ(firstOf(*series, 5), 0);
}

TEST_F(VoxelSeriesFiles, FilesOfAPatternAreSteps)
{
    for (const std::string& name : {path("v%d.tif"), path("v%d.raw") + ".8,9,10,uint8"}) {
        const auto voxels = readSeries(name);
        ASSERT_TRUE(voxels.ok()) << voxels.status.text;
        ASSERT_EQ((*voxels)->getStepCount(), 3) << name;
        EXPECT_EQ((*voxels)->getSize(), osg::Vec3i(8, 9, 10));
        EXPECT_EQ((*voxels)->getSpacing(), osg::Vec3d(2, 3, 4));
        for (int step = 0; step < 3; ++step)
            EXPECT_EQ(firstOf(*(*voxels)->getSource(), step), 10 * step) << name;
        EXPECT_NE((*voxels)->getFileOptions().find("series=on"), std::string::npos);
        EXPECT_EQ((*voxels)->getFileName(), name);
    }
    // Without the option they are slices.
    EXPECT_EQ(ErrorCode::VALUE_INVALID, readSeries(path("v1.tif")).status.code);
    EXPECT_EQ(ErrorCode::FILE_NOT_FOUND, readSeries(path("w%d.tif")).status.code);
    EXPECT_EQ(ErrorCode::FILE_NOT_FOUND, readSeries(path("none")).status.code);
    EXPECT_EQ(ErrorCode::VALUE_INVALID,
              readVoxels(path("v%d.tif"), optionsOf("series=yes").get()).status.code);
}

TEST_F(VoxelSeriesFiles, FilesOfAFolderAreSteps)
{
    for (int step = 0; step < 3; ++step)
        std::filesystem::remove(path("v" + std::to_string(step) + ".raw"));
    const auto voxels = readSeries(folder().string());
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_EQ((*voxels)->getStepCount(), 3);
}

TEST_F(VoxelSeriesFiles, TheyArePlayedUnlessAStepIsAskedFor)
{
    const auto rateOf = [&](const std::string& options) {
        const auto volume = readVolume(path("v%d.tif"), optionsOf(options).get());
        EXPECT_TRUE(volume.ok()) << volume.status.text;
        return volume.ok() ? (*volume)->getTimeRate() : -1.0;
    };
    EXPECT_GT(rateOf("series=on"), 0.0);
    EXPECT_EQ(rateOf("series=on step=2"), 0.0);
    EXPECT_EQ(rateOf("series=on rate=2.5 blending=on"), 2.5);
}

} // namespace VoxelSeriesTest
