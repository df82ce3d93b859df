#pragma once

#include "Pick.h"

#include <osg/Vec3i>
#include <osg/Vec4d>

#include <vector>

namespace osgVolumizer {

/// A voxel that a line passes: the box about a sample, half a sample to each side. Positions,
/// filtered value and colour are those of the middle of the passage.
struct ProbedVoxel
{
    osg::Vec3i index;           ///< of the sample, in its level
    osg::Vec3d object, world;   ///< the same without a path to the world
    double distance = 0.0;      ///< from the start of the segment; object units
    double length = 0.0;        ///< of the passage; object units
    double raw = 0.0;           ///< the sample; of RGBA voxels, alpha; NaN where it is a hole
    double filtered = 0.0;      ///< interpolated as it is drawn, data units
    osg::Vec4d color;           ///< straight; opacity of a layer one opacity unit thick
    double transmittance = 1.0; ///< of everything in front, where light is composited; else 1
};

/// The voxels along a line, from its start to its end.
struct VoxelProbe
{
    std::vector<ProbedVoxel> voxels;
    int level = 0; ///< of paged voxels; 0 is the finest
};

struct ProbeOptions
{
    std::int64_t brick = -1; ///< that alone is looked at, of Voxels::getLayout(); -1: all
    std::int64_t maximumBytes = PickOptions::DEFAULT_BYTES; ///< as in PickOptions
    double simulationTime = 0.0;                            ///< seconds
    std::vector<osg::Vec4d> clipPlanes;                     ///< as in PickOptions
};

/// The voxels of a volume along a segment (object frame), inside its region; shown or not. None
/// where it misses. VALUE_INVALID for a segment without length or that is not finite, and without
/// voxels; INDEX_OUT_OF_RANGE for a brick that there is not.
OSGVOLUMIZER_EXPORT Result<VoxelProbe> probe(const VolumeGeometry& geometry,
                                             const VolumeAppearance& appearance,
                                             const osg::Vec3d& start, const osg::Vec3d& end,
                                             const ProbeOptions& options = {});
/// The same of a segment in the world frame and a path down to a VolumeGeometry below a
/// VolumeAppearance, such as an intersection has; ClipNodes in it cut, too. VALUE_INVALID for any
/// other path; SINGULAR_MATRIX where its transforms have no inverse.
OSGVOLUMIZER_EXPORT Result<VoxelProbe> probe(const osg::NodePath& path,
                                             const osg::Vec3d& worldStart,
                                             const osg::Vec3d& worldEnd,
                                             const ProbeOptions& options = {});

/// Where a segment goes through the boundary of a volume's region, by which sub-parts are told
/// apart.
struct CrossedFace
{
    unsigned tetrahedron = 0;         ///< behind the face
    unsigned vertices[3] = {0, 0, 0}; ///< of the face, counter-clockwise seen from outside
    double ratio = 0.0;               ///< along the segment
    osg::Vec3d point;                 ///< object frame
    bool enters = false;              ///< else it leaves
};

/// The boundary faces that a segment (object frame) goes through, in order. VALUE_INVALID for a
/// segment without length or that is not finite.
OSGVOLUMIZER_EXPORT Result<std::vector<CrossedFace>>
crossedFaces(const VolumeGeometry& geometry, const osg::Vec3d& start, const osg::Vec3d& end);

} // namespace osgVolumizer
