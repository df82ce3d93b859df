#pragma once

#include <osgVolumizer/Error.h>

#include <mutex>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace support {

/// Collects what is reported while it lives, from any thread.
class Reports
{
public:
    Reports() { setErrorHandler(_collect.get()); }
    ~Reports() { setErrorHandler(nullptr); }
    Reports(const Reports&) = delete;
    Reports& operator=(const Reports&) = delete;

    /// Messages that hold some words.
    int count(const std::string& words) const
    {
        std::lock_guard<std::mutex> lock(_collect->mutex);
        int found = 0;
        for (const std::string& text : _collect->texts)
            found += text.find(words) != std::string::npos;
        return found;
    }
    std::size_t all() const
    {
        std::lock_guard<std::mutex> lock(_collect->mutex);
        return _collect->texts.size();
    }

private:
    struct Collect : ErrorHandler
    {
        void operator()(const Status& status) override
        {
            std::lock_guard<std::mutex> lock(mutex);
            texts.push_back(status.text);
        }
        mutable std::mutex mutex;
        std::vector<std::string> texts;
    };
    const osg::ref_ptr<Collect> _collect = new Collect;
};

} // namespace support
} // namespace osgVolumizer
