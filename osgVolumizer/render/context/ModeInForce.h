#pragma once

#include <osg/StateSet>

#include <vector>

namespace osgVolumizer {
namespace render {

/// Whether a mode is on below state sets, from the root down, as OSG decides: the last one counts,
/// unless an override stops it that it is not protected from.
inline bool isOn(const std::vector<const osg::StateSet*>& fromRoot, GLenum mode, bool byDefault)
{
    using osg::StateAttribute;
    bool on = byDefault, overridden = false;
    for (const osg::StateSet* set : fromRoot) {
        const StateAttribute::GLModeValue value = set->getMode(mode);
        if (value & StateAttribute::INHERIT) continue;
        if (overridden && !(value & StateAttribute::PROTECTED)) continue;
        on = (value & StateAttribute::ON) != 0;
        overridden = (value & StateAttribute::OVERRIDE) != 0;
    }
    return on;
}

} // namespace render
} // namespace osgVolumizer
