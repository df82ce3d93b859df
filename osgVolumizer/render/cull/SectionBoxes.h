#pragma once

#include "../../private/SliceFaces.h"
#include "../volume/TouchedBoxes.h"

#include <glm/mat4x4.hpp>

#include <memory>
#include <vector>

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {
namespace render {

/// The boxes that the faces of a slice touch, or a slab about them, as far as they are in the
/// frustum. For the time of one cull.
class SectionBoxes : public TouchedBoxes
{
public:
    /// \param thickness of the slab, object frame \param frameToObject from the voxel frame
    /// \param positionsToEye from the positions of the faces
    SectionBoxes(const slices::SliceFaces& faces, double thickness, const glm::dmat4& frameToObject,
                 const glm::dmat4& positionsToEye, osgUtil::CullVisitor& visitor);

    bool touches(const core::Box3d& box) const override;
    std::optional<double> pixelsPerVoxel(const core::Box3d& box) const override;

private:
    /// Of a face: what of the frustum it reaches, and how large it is there.
    struct Seen
    {
        bool visible = false;
        double pixelsPerVoxel = 0.0; ///< where it is nearest
    };

    Seen look(std::size_t face, const glm::dmat4& positionsToEye, double unitsPerPixel,
              osgUtil::CullVisitor& visitor) const;
    /// Calls f(face) for each that a box touches, until that returns true.
    template <class F>
    bool findTouching(const core::Box3d& box, F&& f) const;

    const slices::SliceFaces& _faces;
    const double _half;
    const glm::dmat4 _frameToObject;
    osgUtil::CullVisitor& _visitor;
    glm::dvec3 _reach{0.0}; ///< voxels on each side of the faces, at most
    std::vector<Seen> _seen;
};

} // namespace render
} // namespace osgVolumizer
