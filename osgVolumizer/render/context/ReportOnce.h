#pragma once

#include "../../Error.h"

#include <mutex>
#include <set>

namespace osgVolumizer {
namespace render {

/// Reports what every frame would find again, each text once in the life of the process. Thread
/// safe.
inline void reportOnce(const Status& status)
{
    static std::mutex mutex;
    static std::set<std::string> known;
    {
        std::lock_guard<std::mutex> lock(mutex);
        if (status.ok() || known.size() > 1000 || !known.insert(status.text).second) return;
    }
    reportError(status);
}

} // namespace render
} // namespace osgVolumizer
