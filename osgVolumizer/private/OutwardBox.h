#pragma once

#include "../core/geometry/Box.h"

#include <osg/BoundingBox>

#include <cmath>

namespace osgVolumizer {

/// A box as floats, which are nowhere inside it. Expects one that is not empty.
inline osg::BoundingBox outwardBox(const core::Box3d& box)
{
    osg::BoundingBox result;
    for (int axis = 0; axis < 3; ++axis) {
        result._min[axis] = std::nextafter(static_cast<float>(box.min[axis]), -INFINITY);
        result._max[axis] = std::nextafter(static_cast<float>(box.max[axis]), INFINITY);
    }
    return result;
}

} // namespace osgVolumizer
