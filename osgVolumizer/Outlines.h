#pragma once

#include "core/Export.h"
#include "core/geometry/Outlines.h"

#include <osg/Geometry>
#include <osg/MatrixTransform>
#include <osg/ref_ptr>

namespace osgVolumizer {

class VolumeGeometry;
class Voxels;

/// Drawing aids: white lines, not lit, to be put where the volume is. What a PolygonMode of lines
/// or points above a volume shows is both of them.

/// The edges of a geometry's tetrahedra, object frame.
OSGVOLUMIZER_EXPORT osg::ref_ptr<osg::Node> createTetraOutlines(const VolumeGeometry& geometry);
/// The edges of the bricks of voxels, origin + spacing * voxel; of paged voxels, of the coarsest
/// level's.
OSGVOLUMIZER_EXPORT osg::ref_ptr<osg::Node> createBrickOutlines(const Voxels& voxels);
/// The edges of faces, such as core::polygonize() makes, in their frame.
OSGVOLUMIZER_EXPORT osg::ref_ptr<osg::Geometry> createFaceOutlines(const core::FaceSet& faces);

/// Lines as they are, in their frame.
OSGVOLUMIZER_EXPORT osg::ref_ptr<osg::Geometry> createLines(const core::LineSet& lines);
/// The clip boxes that createBrickOutlines() shows, voxel frame.
OSGVOLUMIZER_EXPORT std::vector<core::Box3d> brickOutlines(const Voxels& voxels);

} // namespace osgVolumizer
