#pragma once

#include "../context/ContextResources.h"
#include "../context/TargetBuffers.h"

#include <osg/Program>

#include <map>
#include <utility>

namespace osgVolumizer {
namespace render {

/// Where values of rays are gathered. One a context, grown to the largest viewport seen.
struct RayBuffers : ContextPart
{
    FloatTarget target;
    std::map<std::pair<int, bool>, osg::ref_ptr<osg::Program>> programs; ///< by ray function, rgba

    void release(osg::GLExtensions& gl) override;
};

} // namespace render
} // namespace osgVolumizer
