#pragma once

#include "VolumeInstance.h"

#include "../core/Status.h"
#include "../core/ordering/DepthSchedule.h"

namespace osgVolumizer {
namespace render {

/// The faces that a volume's segments are drawn from: for each interval (far to near) and brick
/// (far to near) the faces that look at the eye of (geometry ∩ clip box ∩ interval ∩ beyond the
/// near plane). A convex body covers each pixel with exactly one of them, and behind opaque
/// geometry the depth test drops it before it is shaded.
std::shared_ptr<const VolumeMesh> slabMesh(const VolumeInstance& volume, const core::View& view,
                                           const std::vector<core::DepthInterval>& farToNear);

/// The faces of a volume's sampling surfaces in one view; made once, or taken from an earlier frame
/// of an unchanged view; drawn interval by interval.
class SlicedVolume
{
public:
    /// \param viewAligned takes planes perpendicular to the view whatever the appearance asks for:
    /// the only family that other things can be merged with
    Status polygonize(const VolumeInstance& volume, const core::View& view, bool viewAligned);
    /// Distance between surfaces, and the frame direction along which it is counted.
    double spacing() const { return _slices->spacing; }
    glm::dvec3 surfaceNormal() const { return _surfaceNormal; }
    bool spherical() const { return _spherical; }
    /// Whether there were no faces of an earlier frame.
    bool polygonized() const { return _polygonized; }
    /// The faces of the surfaces in an interval, brick by brick, far to near. The interval is
    /// half-open at its near end.
    std::shared_ptr<const VolumeMesh> mesh(const VolumeInstance& volume,
                                           const core::DepthInterval& interval) const;
    /// The faces of all surfaces.
    std::shared_ptr<const VolumeMesh> mesh(const VolumeInstance& volume) const;

private:
    std::shared_ptr<const VolumeMesh> makeMesh(const VolumeInstance& volume, int firstSurface,
                                               int lastSurface) const;

    std::shared_ptr<const core::PolygonizedFaces> _slices;
    glm::dvec3 _surfaceNormal{0.0};
    bool _spherical = false, _polygonized = false;
};

/// The whole of a volume of one brick as one triangle over the viewport, in device coordinates, for
/// a shader that finds the ray's part of the volume itself. See ProgramFeatures::slotCount.
std::shared_ptr<const VolumeMesh> screenMesh(const VolumeInstance& volume);

} // namespace render
} // namespace osgVolumizer
