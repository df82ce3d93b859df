#pragma once

#include "../../VolumeAppearance.h"

#include <osg/Node>

namespace osgVolumizer {
namespace render {

/// The nearest appearance in a path, from its end; null without one.
inline const VolumeAppearance* nearestAppearance(const osg::NodePath& path)
{
    for (auto node = path.rbegin(); node != path.rend(); ++node)
        if (const auto* appearance = dynamic_cast<const VolumeAppearance*>(*node))
            return appearance;
    return nullptr;
}

} // namespace render
} // namespace osgVolumizer
