#include <osgVolumizer/Error.h>

#include <gtest/gtest.h>
#include <osg/Notify>
#include <osg/ref_ptr>

#include <atomic>
#include <thread>
#include <vector>

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
