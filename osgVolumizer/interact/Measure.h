#pragma once

#include "../Error.h"
#include "../core/Export.h"

#include <osg/Matrixd>
#include <osg/Vec3d>

#include <vector>

/// Measures of places that were picked: in the frame and unit that the points are in, object or
/// world. Points that are not finite are refused (VALUE_INVALID).
namespace osgVolumizer {

class VolumeGeometry;
class Voxels;

/// Sum of the distances from each point to the next one.
OSGVOLUMIZER_EXPORT Result<double> polylineLength(const std::vector<osg::Vec3d>& points);
/// The angle at `apex` between the directions to two points, in radians, 0 to pi. Refuses
/// (VALUE_INVALID) points at the apex.
OSGVOLUMIZER_EXPORT Result<double> angleAt(const osg::Vec3d& apex, const osg::Vec3d& a,
                                           const osg::Vec3d& b);
/// The area of a polygon, closed from its last corner to its first. Refuses (VALUE_INVALID) fewer
/// than three corners, corners off the plane by more than 1e-6 of the polygon's size, and edges
/// that cross or touch others than their neighbours (with the index of one); TOO_LARGE for more
/// than 4096 corners.
OSGVOLUMIZER_EXPORT Result<double> polygonArea(const std::vector<osg::Vec3d>& corners);

/// The volume of a geometry's tetrahedra, in the units that `toWorld` leads to; overlaps count
/// twice.
OSGVOLUMIZER_EXPORT double tetraVolume(const VolumeGeometry& geometry,
                                       const osg::Matrixd& toWorld = osg::Matrixd());
/// The volume of the voxels, object units, whose samples have a value within [low, high] (of RGBA
/// voxels: alpha); with a geometry, of those whose middle lies in its region. Reads all bricks
/// that may have such values. VALUE_INVALID without voxels and for a range that is not one;
/// NOT_SUPPORTED for paged voxels, and for a geometry that is deformed.
OSGVOLUMIZER_EXPORT Result<double> valueVolume(const Voxels& voxels, double low, double high,
                                               const VolumeGeometry* geometry = nullptr);

} // namespace osgVolumizer
