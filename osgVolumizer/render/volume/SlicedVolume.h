#pragma once

#include "VolumeInstance.h"

#include "../../core/Status.h"
#include "../../core/ordering/DepthSchedule.h"

namespace osgVolumizer {
namespace render {

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

} // namespace render
} // namespace osgVolumizer
