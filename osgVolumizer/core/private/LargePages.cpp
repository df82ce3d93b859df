#include "LargePages.h"

#if defined(__linux__)
#include <sys/mman.h>

#include <cstdint>
#endif

namespace osgVolumizer {
namespace core {

void adviseLargePages(void* from, std::size_t bytes)
{
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    constexpr std::uintptr_t PAGE = std::uintptr_t(1) << 21;
    const auto begin = reinterpret_cast<std::uintptr_t>(from);
    const std::uintptr_t first = (begin + PAGE - 1) & ~(PAGE - 1);
    const std::uintptr_t end = (begin + bytes) & ~(PAGE - 1);
    // Advice only: where it is not taken, all works as before.
    if (end > first) (void)madvise(reinterpret_cast<void*>(first), end - first, MADV_HUGEPAGE);
#else
    (void)from;
    (void)bytes;
#endif
}

} // namespace core
} // namespace osgVolumizer
