#pragma once

#include "../Export.h"
#include "../Status.h"
#include "Polygonize.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Faces of earlier frames, per view. They are used again when the tetra set, the clip boxes, the
/// parameters and all of the view that matters are unchanged; or, where the caller allows an angle
/// of slack, while the surfaces have turned by no more than that since they were made (the guide's
/// lazy evaluation: the faces are those of the older view, their surfaceDepths too).
///
/// A view matters as follows: with OBJECT or PRIMITIVE space and planes across the view, the
/// direction and length of the depth's gradient and, for the depths that are reported, its offset;
/// with voxel axes the axis and the side of the eye. Everything, where faces are culled to the
/// view, are spheres, depend on the view volume, or where the eye is between planes along an axis.
///
/// Any number of threads; different views do not wait for each other's polygonization. One view is
/// polygonized by one thread at a time.
class OSGVOLUMIZER_CORE_EXPORT FaceCache
{
public:
    using FacesPtr = std::shared_ptr<const PolygonizedFaces>;
    using ViewId = std::uint64_t;

    /// \param capacity of how many views faces are kept, > 0; the one that has not been asked for
    /// longest is forgotten first
    explicit FaceCache(std::size_t capacity = 16);
    ~FaceCache();

    /// \param viewId whatever identifies the view and the place in the graph
    /// \param tetraSet never null; immutable, so that the same pointer means the same tetrahedra
    /// \param slackAngle radians, >= 0
    /// \param polygonized tells whether this call did, unless null
    /// The faces stay as they are for as long as the pointer is held; their memory is used again
    /// for later frames when it is not.
    Result<FacesPtr> faces(ViewId viewId, const std::shared_ptr<const TetraSet>& tetraSet,
                           const std::vector<Box3d>& clipBoxes, const View& view,
                           const SamplingParameters& parameters, double slackAngle = 0.0,
                           bool* polygonized = nullptr);

private:
    struct Private;
    std::unique_ptr<Private> _private;
};

} // namespace core
} // namespace osgVolumizer
