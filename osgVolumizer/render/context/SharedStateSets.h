#pragma once

#include <osg/StateSet>

#include <cstdint>
#include <functional>
#include <vector>

namespace osgVolumizer {
namespace render {

/// Keys of state sets that are not ProgramFeatures::key(), whose values stay below.
enum class SharedState : std::uint64_t
{
    SORT = std::uint64_t(1) << 63,
    FILL,
    CLEAR,
    SURFACE_DEPTHS,
    DEPTH,
    NEAREST_SLOT,
    FILL_REST,
    RANKED_SURFACES = SORT + 1000, ///< these and the following
    SORT_SLOTS = SORT + 2000,
    CAPTURED_SURFACES = SORT + 3000,
    REST_SURFACES = SORT + 4000,
    SECTIONS = SORT + 5000 ///< and more numbers
};

/// State sets that all volumes, views and contexts share, made when first asked for. Thread safe.
osg::ref_ptr<osg::StateSet>
sharedStateSet(const std::vector<std::uint64_t>& key,
               const std::function<osg::ref_ptr<osg::StateSet>()>& make);
inline osg::ref_ptr<osg::StateSet>
sharedStateSet(std::uint64_t key, const std::function<osg::ref_ptr<osg::StateSet>()>& make)
{
    return sharedStateSet(std::vector<std::uint64_t>{key}, make);
}
inline osg::ref_ptr<osg::StateSet>
sharedStateSet(SharedState key, const std::function<osg::ref_ptr<osg::StateSet>()>& make)
{
    return sharedStateSet(static_cast<std::uint64_t>(key), make);
}

/// Releases what they have in one context, or in all for null: a later context of the same number
/// has to link their programs again.
void releaseSharedStateSets(osg::State* state);
/// Makes room for more contexts before several of them draw at once: OSG's own growth on first use
/// is not thread safe.
void resizeSharedStateSets(unsigned int maximum);

} // namespace render
} // namespace osgVolumizer
