#pragma once

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

namespace osgVolumizer {
namespace test {

/// What is allocated in the scope of this is not reported as a leak. For libraries that leak, where
/// no name of theirs stands in the few frames that the sanitizer keeps.
class LeaksOfOthers
{
public:
#if defined(__SANITIZE_ADDRESS__)
    LeaksOfOthers()
    {
        __lsan_disable();
    }
    ~LeaksOfOthers()
    {
        __lsan_enable();
    }
#else
    LeaksOfOthers() {}
    ~LeaksOfOthers() {}
#endif
    LeaksOfOthers(const LeaksOfOthers&) = delete;
    LeaksOfOthers& operator=(const LeaksOfOthers&) = delete;
};

} // namespace test
} // namespace osgVolumizer
