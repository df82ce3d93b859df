#pragma once

#include "../Error.h"
#include "../core/Export.h"

#include <osg/Drawable>
#include <osg/Node>
#include <osg/Vec3d>
#include <osg/Vec4d>
#include <osg/ref_ptr>

#include <cstdint>
#include <optional>
#include <vector>

namespace osg {
class Camera;
}

/// Picking finds where a user sees a volume, on the CPU, exactly: the integral of what is drawn
/// with the settings in force, not of its samples. Along a segment that is
///   - COMPOSITE: where the opacity gathered from its start reaches VolumeAppearance's pick
///   opacity;
///   - ISOSURFACE: the first crossing of the iso-value;
///   - MAXIMUM and MINIMUM: the first place of that value, where its opacity is that of a pick;
///   - AVERAGE and SUM: likewise, the middle of what of the volume is on the segment.
/// Where the opacity does not get there nothing is found, though a tint may be seen. A volume that
/// paints others is not found. Holes count as what is drawn of them: the lowest value of the range,
/// or nothing where there are only holes. Places are good to a tenth of a sample.
///
/// OSG's own intersectors find volumes by it: osgUtil::LineSegmentIntersector, RayIntersector,
/// PolytopeIntersector (the nearest sample's cell inside that shows anything; to a cell) and groups
/// of them, and with them everything that is built on osgUtil::IntersectionVisitor. An intersection
/// has the volume as its drawable, the number of the tetrahedron as its primitive, and the
/// gradient, towards the eye, as its normal. ClipNodes above a volume cut it (OSG's own geometry is
/// found behind them). A visitor without a frame stamp sees the time step of the last frame.
///
/// What is kept for it, besides memory of the source: bricks and pages that were read last, 256 MiB
/// of each Voxels, and 8 bytes for each 512 of their samples. Everything here may be called from
/// several threads between changes of the scene; lookup tables may change meanwhile.
namespace osgVolumizer {

class VolumeAppearance;
class VolumeGeometry;

struct PickOptions
{
    /// Bound on the samples of paged voxels that a pick reads: of more, along the segment, it takes
    /// a coarser level. Pages that show nothing, as far as their source knows, do not count.
    static constexpr std::int64_t DEFAULT_BYTES = std::int64_t(64) << 20;

    double opacity = 0.0; ///< that has to be reached; 0: the appearance's
    std::int64_t maximumBytes = DEFAULT_BYTES;
    double simulationTime = 0.0; ///< seconds; says which time step is seen
    /// Half-spaces (object frame) outside which nothing is seen: x, y, z, w times (point, 1) >= 0.
    std::vector<osg::Vec4d> clipPlanes;
};

/// Where a segment meets what is seen of a volume. The object frame is that of the geometry.
struct PickHit
{
    double ratio = 0.0;       ///< along the segment: 0 at its start, 1 at its end
    osg::Vec3d point;         ///< object frame
    osg::Vec3d normal;        ///< object frame, length 1, towards the start
    osg::Vec3d voxel;         ///< voxel frame
    double value = 0.0;       ///< of the data or scalars there, interpolated; of RGBA voxels, alpha
    int level = 0;            ///< of paged voxels, that it was found in; 0 is the finest
    unsigned tetrahedron = 0; ///< of the geometry's tetra set
};

/// Where a segment (object frame) meets what is seen of a geometry with an appearance, which need
/// not be above it; nothing where it does not. VALUE_INVALID for a segment
/// without length or that is not finite, and for an opacity outside [0, 1).
OSGVOLUMIZER_EXPORT Result<std::optional<PickHit>>
pickVolume(const VolumeGeometry& geometry, const VolumeAppearance& appearance,
           const osg::Vec3d& start, const osg::Vec3d& end, const PickOptions& options = {});

/// What is seen under a pixel: of a volume or of any other drawable.
struct PixelPick
{
    osg::Vec3d point;       ///< world frame
    osg::Vec3d normal;      ///< world frame, length 1, or 0 where there is none
    double ratio = 0.0;     ///< 0 at the near plane, 1 at the far plane, along the line of sight
    osg::NodePath nodePath; ///< from the camera down; for as long as the scene stays
    osg::ref_ptr<osg::Drawable> drawable;
    bool isVolume = false;
};

/// The world point under a window position of a camera, in pixels of its viewport, (0,0) at its
/// lower left corner: of surfaces, opaque or not, and of volumes the one in front. Nothing where
/// there is none. VALUE_INVALID for positions that are not finite, and without a viewport;
/// SINGULAR_MATRIX for a camera whose matrices have no inverse.
OSGVOLUMIZER_EXPORT Result<std::optional<PixelPick>> zpick(osg::Camera& camera, double x, double y,
                                                           osg::Node::NodeMask mask = ~0u);

/// The planes of the ClipNodes in a path that are on at its end, in the frame of that: what
/// intersectors cut volumes by. Planes with a place in the eye frame are none of a scene, and left
/// out.
OSGVOLUMIZER_EXPORT std::vector<osg::Vec4d> clipPlanesAbove(const osg::NodePath& path);
/// The nearest VolumeAppearance in a path, from its end; null without one.
OSGVOLUMIZER_EXPORT const VolumeAppearance* appearanceOf(const osg::NodePath& path);
/// The volume that a path ends with; null where it ends with none.
OSGVOLUMIZER_EXPORT const VolumeGeometry* geometryOf(const osg::NodePath& path);

} // namespace osgVolumizer
