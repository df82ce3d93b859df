#pragma once

#include "Error.h"

#include <osg/Geometry>
#include <osg/Vec3d>
#include <osg/ref_ptr>

#include <vector>

namespace osgVolumizer {

/// A strip along a line through a volume, such as a vessel or a jaw, for
/// VolumeSlice::setGeometry(): curved planar reformatting.
struct CurvedStrip
{
    osg::ref_ptr<osg::Geometry> inPlace; ///< object frame
    /// The same strip laid flat in the plane z = 0, without stretching it: x along the line, from 0
    /// to `length`, y along the direction, 0 where the line begins. Texture coordinates of unit 0
    /// are the places in the volume (object frame): setGeometry(unrolled, 0).
    osg::ref_ptr<osg::Geometry> unrolled;
    double length = 0.0; ///< across the direction, object units
};

/// Sweeps a line along a direction, by half of `width` (object units) to each side.
/// \param line object frame, two points or more, of which neighbours do not lie along the direction
/// VALUE_INVALID for fewer, for a direction without length, for a width outside [1e-18, 1e18], and
/// for what is not finite.
OSGVOLUMIZER_EXPORT Result<CurvedStrip> makeCurvedStrip(const std::vector<osg::Vec3d>& line,
                                                        const osg::Vec3d& direction, double width);

} // namespace osgVolumizer
