#include <osgVolumizer/Error.h>
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

#include <gtest/gtest.h>
#include <osg/Notify>
#include <osg/ref_ptr>

#include <atomic>
#include <functional>
#include <limits>
#include <thread>
#include <vector>

namespace ErrorTest {

using namespace osgVolumizer;

namespace {

class Collector : public ErrorHandler
{
public:
    void operator()(const Status& status) override
    {
        ++count;
        code = status.code;
    }
    std::atomic<int> count{0};
    std::atomic<ErrorCode> code{ErrorCode::NONE};
};

class NotifyCounter : public osg::NotifyHandler
{
public:
    void notify(osg::NotifySeverity, const char* message) override { text += message; }
    std::string text;
};

} // namespace

TEST(Error, ReachesHandlerLastErrorAndNotify)
{
    clearLastError();
    osg::ref_ptr<Collector> collector = new Collector;
    osg::ref_ptr<NotifyCounter> notify = new NotifyCounter;
    setErrorHandler(collector.get());
    osg::setNotifyHandler(notify.get());
    reportError({ErrorCode::TOO_LARGE, "first"});
    reportError({ErrorCode::TOO_LARGE, "first"});
    reportError(Status());
    osg::setNotifyHandler(new osg::StandardNotifyHandler);
    setErrorHandler(nullptr);
    EXPECT_EQ(2, collector->count);
    EXPECT_EQ(ErrorCode::TOO_LARGE, collector->code);
    EXPECT_EQ("first", getLastError().text);
    // One line, with the number's name.
    EXPECT_EQ("osgVolumizer: first [TOO_LARGE]\n", notify->text);
    clearLastError();
    EXPECT_TRUE(getLastError().ok());
}

TEST(Error, FromSeveralThreads)
{
    osg::ref_ptr<Collector> collector = new Collector;
    setErrorHandler(collector.get());
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([] {
            for (int i = 0; i < 100; ++i)
                reportError({ErrorCode::VALUE_INVALID, "the same"});
        });
    for (std::thread& thread : threads)
        thread.join();
    setErrorHandler(nullptr);
    EXPECT_EQ(400, collector->count);
}

// Every setter that can refuse, given something that it does.
TEST(Error, EverySetterReportsWhatItRefuses)
{
    constexpr double NOT_A_NUMBER = std::numeric_limits<double>::quiet_NaN();
    const osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    const osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    const osg::ref_ptr<Voxels> voxels = new Voxels;
    const osg::ref_ptr<LookupTable> table = new LookupTable;
    const osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    const osg::Vec3d vector(NOT_A_NUMBER, 1.0, 1.0);
    core::TetraSet noTetraSet;
    noTetraSet.indices = {0, 1, 2, 3};
    const std::vector<std::function<Status()>> setters{
        [&] { return appearance->setIsoValue(NOT_A_NUMBER); },
        [&] {
            return appearance->setMaterial({-1.0, 0.0, 0.0, 0.0});
        },
        [&] { return appearance->setAccumulationBits(7); },
        [&] { return appearance->setSamplingPeriod(vector); },
        [&] { return appearance->setMaximumSamples(0); },
        [&] { return appearance->setErrorTolerance(-1.0); },
        [&] { return appearance->setTargetFrameTime(-1.0); },
        [&] { return appearance->setOpacityUnit(-1.0); },
        [&] { return geometry->setTetraSet(noTetraSet); },
        [&] { return geometry->setSlackAngle(-1.0); },
        [&] { return voxels->setSource(source.get()); }, // which has no voxels
        [&] { return voxels->setSpacing(vector); },
        [&] { return voxels->setOrigin(vector); },
        [&] { return voxels->setRange(osg::Vec2d(1.0, 0.0)); },
        [&] {
            return voxels->setBrickSize({0, 1, 1});
        },
        [&] { return voxels->setOverlap(-1); },
        [&] { return table->setPoints({}, LookupTable::DATA_VALUES); },
        [&] { return table->setEntries({}); },
        [&] { return table->setRamp(NOT_A_NUMBER, 1.0); },
        [&] { return source->allocate({}); },
        [&] { return source->setExternal({}, nullptr); }};
    const osg::ref_ptr<Collector> collector = new Collector;
    setErrorHandler(collector.get());
    for (std::size_t i = 0; i < setters.size(); ++i) {
        clearLastError();
        const int before = collector->count;
        const Status status = setters[i]();
        EXPECT_FALSE(status.ok()) << i;
        EXPECT_EQ(collector->count, before + 1) << i;
        EXPECT_EQ(getLastError().text, status.text) << i;
        // A reader that says more of it gets the same, and reports it itself.
        const CallerReports reader;
        EXPECT_EQ(setters[i]().text, status.text) << i;
        EXPECT_EQ(collector->count, before + 1) << i;
    }
    setErrorHandler(nullptr);
    clearLastError();
}

} // namespace ErrorTest
