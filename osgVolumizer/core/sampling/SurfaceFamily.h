#pragma once

#include "../Export.h"
#include "../Status.h"
#include "../geometry/TetraSet.h"
#include "SamplingParameters.h"
#include "View.h"

#include <vector>

namespace osgVolumizer {
namespace core {

/// A family of surfaces that sample space: the level sets of a depth. User-defined families
/// implement this; const members are called from several threads.
class OSGVOLUMIZER_CORE_EXPORT SurfaceFamily
{
public:
    virtual ~SurfaceFamily() = default;
    /// Grows away from the viewer, in any unit. Faces are the level sets of its linear interpolant
    /// in each tetrahedron, so they meet at shared tetrahedron faces whatever it is.
    /// \param voxel the explicit voxel coordinates, or `position` again where there are none
    virtual double depth(const glm::dvec3& position, const glm::dvec3& voxel) const = 0;
    /// Wanted distance between surfaces, > 0, in the unit of depth().
    virtual double spacing() const = 0;
    /// The most that the interpolant may differ from depth(), in multiples of spacing(): tetrahedra
    /// are bisected until it does not. 0: depth() is linear in every tetrahedron.
    virtual double tolerance() const { return 0.0; }
};

/// Depths at which a family is sampled: layer k spans [farDepth - (k + 1) spacing,
/// farDepth - k spacing], its surface lies in the middle. Layer 0 is the farthest.
struct SurfaceLattice
{
    double farDepth = 0.0;
    double spacing = 1.0;
    int count = 0; ///< layers of the whole lattice, after bounding
};

/// The standard families of SamplingParameters, made ready for one tetra set and view. Depths are
/// measured from `anchorDepth`, the depth of the lower corner of the set's bounds, and all
/// coordinates are taken relative to that corner first: moving the scene by offsets that doubles
/// represent changes no bit of them.
struct OSGVOLUMIZER_CORE_EXPORT ViewFamily
{
    SamplingMode mode = SamplingMode::VIEWPORT_ALIGNED;
    int axis = -1;            ///< AXIS_ALIGNED: 0, 1 or 2
    glm::dvec3 corner{0.0};   ///< subtracted from positions (AXIS_ALIGNED: voxel coordinates)
    glm::dvec3 gradient{0.0}; ///< planes: depth relative to the anchor = dot(gradient, p - corner)
    glm::dmat3 toEye{1.0};    ///< SPHERICAL: linear part
    glm::dvec3 eye{0.0};      ///< SPHERICAL: the eye relative to `corner`
    double anchorDepth = 0.0; ///< added to relative depths for absolute ones
    double wantedSpacing = 1.0; ///< from the period
    /// AXIS_ALIGNED, eye beside the planes: depth of the eye relative to the anchor; surfaces are
    /// then ordered by their distance from it. NaN elsewhere.
    double eyeDepth = 0.0;
    double viewNear = 0.0, viewFar = 0.0; ///< VIEW_VOLUME: extent of the lattice, absolute

    static Result<ViewFamily> create(const TetraSet& tetraSet, const Box3d& bounds,
                                     const View& view, const SamplingParameters& parameters);

    bool linear() const { return mode != SamplingMode::SPHERICAL; }
    /// Depth relative to the anchor.
    double depth(const double* position, const double* voxel) const;
};

/// Spreads layers over [nearest, farthest] for OBJECT and PRIMITIVE space, or over the view volume.
OSGVOLUMIZER_CORE_EXPORT SurfaceLattice makeLattice(double nearest, double farthest, double spacing,
                                                    int maximum);

} // namespace core
} // namespace osgVolumizer
