#pragma once

#include "Error.h"
#include "VolumeGeometry.h"
#include "core/geometry/Solids.h"

#include <osg/BoundingBox>
#include <osg/Vec3d>
#include <osg/ref_ptr>

#include <vector>

/// Solids of tetrahedra: regions that voxels fill, or meshes for VolumeGeometry::setScalars().
/// Positions and lengths are in the object frame. Neighbours share their vertices. The reason of a
/// refusal is returned, not reported.
///
/// Solids with curved faces are inscribed: their volumes converge from below, at second order in
/// the number of parts. All are refused where a length is not positive and finite, where a position
/// is not finite, and for fewer parts than stated (VALUE_INVALID), or where they would have more
/// than 2^24 tetrahedra (TOO_LARGE).
namespace osgVolumizer {

using GeometryResult = Result<osg::ref_ptr<VolumeGeometry>>;

/// \param slices around the axis, >= 3, one tetrahedron each
OSGVOLUMIZER_EXPORT GeometryResult createCone(const osg::Vec3d& base, const osg::Vec3d& apex,
                                              double radius, int slices = 32);
/// \param slices around the axis, >= 3
/// \param stacks along the axis, >= 1
OSGVOLUMIZER_EXPORT GeometryResult createCylinder(const osg::Vec3d& bottom, const osg::Vec3d& top,
                                                  double radius, int slices = 32, int stacks = 1);
/// Degrees of longitude and latitude: tetrahedra are thin near the poles.
/// \param slices around the z axis, >= 3
/// \param stacks from pole to pole, >= 2
OSGVOLUMIZER_EXPORT GeometryResult createSphere(const osg::Vec3d& center, double radius,
                                                int slices = 32, int stacks = 32);
/// Tetrahedra of nearly one size, 20 frequency^2 of them.
/// \param frequency parts of each edge of the icosahedron that is put on the sphere, >= 1
OSGVOLUMIZER_EXPORT GeometryResult createGeodesicSphere(const osg::Vec3d& center, double radius,
                                                        int frequency = 8);
/// What is left of a box around a sphere. VALUE_INVALID where the sphere touches the box.
/// \param divisions of each edge of the box, 1 to 512
OSGVOLUMIZER_EXPORT GeometryResult createBoxMinusSphere(const osg::BoundingBoxd& box,
                                                        const osg::Vec3d& center, double radius,
                                                        int divisions = 16);
/// A box with a hole drilled through it. VALUE_INVALID where the hole touches the sides of the box.
/// \param center any point on the axis of the hole
/// \param axis that the hole is along: 0, 1 or 2
/// \param divisions of each edge of the box across the axis, >= 1
/// \param stacks along the axis, >= 1
OSGVOLUMIZER_EXPORT GeometryResult createBoxMinusCylinder(const osg::BoundingBoxd& box,
                                                          const osg::Vec3d& center, int axis,
                                                          double radius, int divisions = 16,
                                                          int stacks = 1);

/// Tetrahedra, pyramids, prisms or hexahedra over shared vertices, which keep their numbers, so
/// that scalars per vertex may be set as they are. Each cell is cut into 1, 2, 3, or 5 to 6
/// tetrahedra. Refused as by core::CellSet::tessellate().
OSGVOLUMIZER_EXPORT GeometryResult createCells(const core::CellSet& cells);
/// A run of cells that share vertices, which keep their numbers. Refused as by core::makeStrip().
OSGVOLUMIZER_EXPORT GeometryResult createStrip(core::StripKind kind,
                                               const core::VertexArray& vertices,
                                               const std::vector<core::TetraSet::Index>& indices);

} // namespace osgVolumizer
