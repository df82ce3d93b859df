#include "Error.h"

#include <osg/Notify>
#include <osg/ref_ptr>

#include <mutex>

namespace osgVolumizer {

namespace {

struct Channel
{
    std::mutex mutex;
    osg::ref_ptr<ErrorHandler> handler;
    Status last;
    std::string lastNotified;
};

/// Never destroyed: threads and static objects may still report while the process ends.
Channel& channel()
{
    static Channel* instance = new Channel;
    return *instance;
}

thread_local int callersThatReport = 0;

} // namespace

void setErrorHandler(ErrorHandler* handler)
{
    // The old handler is released outside the lock: its destructor may report.
    osg::ref_ptr<ErrorHandler> keep(handler);
    std::lock_guard<std::mutex> lock(channel().mutex);
    channel().handler.swap(keep);
}

Status getLastError()
{
    std::lock_guard<std::mutex> lock(channel().mutex);
    return channel().last;
}

void clearLastError()
{
    std::lock_guard<std::mutex> lock(channel().mutex);
    channel().last = Status();
    channel().lastNotified.clear();
}

void reportError(const Status& status)
{
    if (status.ok()) return;
    osg::ref_ptr<ErrorHandler> handler;
    bool repeated = false;
    {
        std::lock_guard<std::mutex> lock(channel().mutex);
        repeated = channel().lastNotified == status.text;
        channel().last = status;
        channel().lastNotified = status.text;
        handler = channel().handler;
    }
    if (!repeated)
        OSG_WARN << "osgVolumizer: " << status.text << " [" << errorName(status.code) << "]"
                 << std::endl;
    if (handler.valid()) (*handler)(status);
}

ReportedStatus reported(Status status)
{
    if (callersThatReport == 0) reportError(status);
    return ReportedStatus(std::move(status));
}

CallerReports::CallerReports()
{
    ++callersThatReport;
}

CallerReports::~CallerReports()
{
    --callersThatReport;
}

} // namespace osgVolumizer
