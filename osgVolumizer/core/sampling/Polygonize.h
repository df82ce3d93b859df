#pragma once

#include "../Export.h"
#include "../Status.h"
#include "../geometry/Box.h"
#include "../geometry/FaceSet.h"
#include "../geometry/TetraSet.h"
#include "SamplingParameters.h"
#include "View.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace osgVolumizer {
namespace core {

class SurfaceFamily;

/// A run of faces, and the indices that they use.
struct FaceRange
{
    std::uint32_t firstFace = 0, faceCount = 0;
    std::uint32_t firstIndex = 0, indexCount = 0;
};

/// The result of polygonize(): faces per surface and brick, far to near.
struct PolygonizedFaces
{
    /// Records in the tetra set's format; positions are relative to
    /// SamplingParameters::outputOrigin. Faces run counter-clockwise about the direction from far
    /// to near, in the position frame.
    FaceSet faces;
    int surfaceCount =
        0;              ///< the number in use, after bounding; those that miss the set are left out
    int brickCount = 0; ///< clip boxes; 1 without
    /// Range of surface s (0 = farthest) and brick b: ranges[s * brickCount + b].
    std::vector<FaceRange> ranges;
    /// Depth of each surface (eye units; distance from the eye when SPHERICAL; position along the
    /// axis, in voxels, when AXIS_ALIGNED), descending in visibility.
    std::vector<double> surfaceDepths;
    /// Distance between neighbouring surfaces, in the units of surfaceDepths.
    double spacing = 0.0;
    /// PRIMITIVE only: per face, the thickness of its layer; elsewhere empty.
    std::vector<float> faceSpacings;
    /// AXIS_ALIGNED: 0, 1 or 2; else -1.
    int axis = -1;
    /// Planes: how depth grows with position (AXIS_ALIGNED: with voxel coordinates), so also their
    /// normal; zero for curved surfaces.
    glm::dvec3 gradient{0.0};

    const FaceRange& range(int surface, int brick) const
    {
        return ranges[static_cast<std::size_t>(surface) * static_cast<std::size_t>(brickCount) +
                      static_cast<std::size_t>(brick)];
    }
};

/// Cuts a tetra set into faces, view after view. Keeps what does not depend on the view, and all
/// its memory, so a view allocates nothing once the largest was seen. One thread at a time.
///
/// Watertight by construction: a face's points are made on edges, from the far end to the near end,
/// so tetrahedra that share an edge get the same bits; points on clip boxes are made on the
/// unclipped edges of the faces, so bricks that share them get the same bits (see RecordPolygon).
/// A vertex on a surface belongs to its far side, and a face in the common plane of two clip boxes
/// to the upper one.
class OSGVOLUMIZER_CORE_EXPORT Polygonizer
{
public:
    Polygonizer();
    ~Polygonizer();
    Polygonizer(Polygonizer&&) noexcept;
    Polygonizer& operator=(Polygonizer&&) noexcept;

    /// Validates and keeps the set, which must not change any more. On failure the old one stays.
    Status setTetraSet(std::shared_ptr<const TetraSet> tetraSet);
    const std::shared_ptr<const TetraSet>& tetraSet() const;
    /// In the voxel frame: applied to the explicit voxel coordinates where the format has them,
    /// else to the positions. None means one brick without clipping. On failure the old ones stay.
    Status setClipBoxes(const std::vector<Box3d>& clipBoxes);

    /// Expects a tetra set. VALUE_INVALID for parameters (see SamplingParameters::validate),
    /// SINGULAR_MATRIX, TOO_LARGE for more than 2^24 pairs of surface and brick: `out` is unchanged
    /// then. TOO_LARGE also for more than 2^32 vertices, or more than memory holds, which shows
    /// only on the way: `out` is empty then.
    ///
    /// OBJECT spreads the surfaces over the depths of the set, at the middles of equal layers, so
    /// that the sum of face areas times the spacing is a midpoint rule for the volume. VIEW_VOLUME
    /// spreads them over near to far (AXIS_ALIGNED: puts them at odd multiples of half the period),
    /// so that neighbouring sets meet the same surfaces. PRIMITIVE spreads them over each
    /// tetrahedron by itself; its faces are sorted into the layers of OBJECT. SPHERICAL in a
    /// parallel projection means planes.
    Status polygonize(const View& view, const SamplingParameters& parameters,
                      PolygonizedFaces& out);
    /// As OBJECT space, for a family of the caller's; mode, space, period and voxelSize are not
    /// used.
    Status polygonize(const SurfaceFamily& family, const SamplingParameters& parameters,
                      PolygonizedFaces& out);

    /// Multi-planar reformatting: the cross section with one plane of the position frame, per
    /// brick. Faces run counter-clockwise about the plane's normal.
    Status polygonizeMPR(const Plane& plane, const glm::dvec3& outputOrigin, PolygonizedFaces& out);
    /// The cross section with a polygon: simple, planar to 1e-6 of its size, convex or not, in the
    /// position frame. VALUE_INVALID for any other.
    Status polygonizeMPR(const std::vector<glm::dvec3>& polygon, const glm::dvec3& outputOrigin,
                         PolygonizedFaces& out);

private:
    struct Private;
    std::unique_ptr<Private> _private;
};

/// One call, nothing kept: see Polygonizer.
OSGVOLUMIZER_CORE_EXPORT Status polygonize(const TetraSet& tetraSet,
                                           const std::vector<Box3d>& clipBoxes, const View& view,
                                           const SamplingParameters& parameters,
                                           PolygonizedFaces& out);

} // namespace core
} // namespace osgVolumizer
