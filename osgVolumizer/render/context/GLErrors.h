#pragma once

#include <osg/GL>

namespace osgVolumizer {
namespace render {

/// Forgets GL errors of the past, so that the next one is of what is tried next.
inline void discardErrors()
{
    // A lost context reports errors without end.
    for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
    }
}

} // namespace render
} // namespace osgVolumizer
