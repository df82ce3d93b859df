#include "SharedStateSets.h"

#include <map>
#include <mutex>

namespace osgVolumizer {
namespace render {

namespace {

std::mutex& setsMutex()
{
    static std::mutex mutex;
    return mutex;
}

std::map<std::vector<std::uint64_t>, osg::ref_ptr<osg::StateSet>>& sets()
{
    static std::map<std::vector<std::uint64_t>, osg::ref_ptr<osg::StateSet>> map;
    return map;
}

} // namespace

osg::ref_ptr<osg::StateSet> sharedStateSet(const std::vector<std::uint64_t>& key,
                                           const std::function<osg::ref_ptr<osg::StateSet>()>& make)
{
    std::lock_guard<std::mutex> lock(setsMutex());
    osg::ref_ptr<osg::StateSet>& set = sets()[key];
    if (!set) set = make();
    return set;
}

void releaseSharedStateSets(osg::State* state)
{
    std::lock_guard<std::mutex> lock(setsMutex());
    for (const auto& set : sets())
        set.second->releaseGLObjects(state);
}

void resizeSharedStateSets(unsigned int maximum)
{
    std::lock_guard<std::mutex> lock(setsMutex());
    for (const auto& set : sets())
        set.second->resizeGLObjectBuffers(maximum);
}

} // namespace render
} // namespace osgVolumizer
