#include "ContextRefusals.h"

#include <map>
#include <mutex>

namespace osgVolumizer {
namespace render {

namespace {

std::mutex& refusalMutex()
{
    static std::mutex mutex;
    return mutex;
}

// Bits of Refusal by context.
std::map<unsigned, unsigned>& refusals()
{
    static std::map<unsigned, unsigned> all;
    return all;
}

} // namespace

void refuse(unsigned contextId, Refusal what)
{
    std::lock_guard<std::mutex> lock(refusalMutex());
    refusals()[contextId] |= static_cast<unsigned>(what);
}

bool isRefused(unsigned contextId, Refusal what)
{
    std::lock_guard<std::mutex> lock(refusalMutex());
    const auto found = refusals().find(contextId);
    return found != refusals().end() && (found->second & static_cast<unsigned>(what));
}

void forgetRefusals(unsigned contextId)
{
    std::lock_guard<std::mutex> lock(refusalMutex());
    refusals().erase(contextId);
}

} // namespace render
} // namespace osgVolumizer
