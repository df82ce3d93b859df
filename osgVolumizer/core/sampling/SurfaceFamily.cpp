#include "SurfaceFamily.h"

#include "ViewHelpers.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace core {

namespace {

constexpr double UNKNOWN = std::numeric_limits<double>::quiet_NaN();

glm::dvec3 voxelCorner(const TetraSet& set)
{
    Box3d box;
    for (const TetraSet::Index i : set.indices)
        box.expand(set.vertices.voxelCoordinate(i));
    return box.min;
}

/// Largest distance from the eye of a corner of the view volume's far plane.
double farthestCorner(const glm::dmat4& projection, double farDepth)
{
    if (!std::isfinite(farDepth)) return farDepth;
    const glm::dmat4 inverse = glm::inverse(projection);
    double r = farDepth;
    for (int i = 0; i < 4; ++i) {
        const glm::dvec4 p = inverse * glm::dvec4(i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, 1.0, 1.0);
        const double distance = glm::length(glm::dvec3(p) / p.w);
        if (std::isfinite(distance)) r = std::max(r, distance);
    }
    return r;
}

Status planes(ViewFamily& f, const View& view, const SamplingParameters& parameters)
{
    f.gradient = view.depthGradient();
    f.anchorDepth = glm::dot(f.gradient, f.corner) - view.toEye[3][2];
    // Along the view normal, measured in voxel coordinates divided by the period, one layer has
    // thickness 1: the spacing is the length of the depth's gradient in those coordinates.
    f.wantedSpacing = glm::length(f.gradient * parameters.voxelSize * parameters.periodVoxel);
    return {};
}

Status axisPlanes(ViewFamily& f, const TetraSet& set, const Box3d& bounds, const View& view,
                  const SamplingParameters& parameters)
{
    const Result<ViewAxis> closest = closestAxis(view, bounds.center(), parameters.voxelSize);
    if (!closest) return closest.status;
    const Result<glm::dvec4> eye = eyePosition(view);
    const bool explicitVoxels = set.vertices.format().voxelCoordinateSize == 3;
    f.axis = closest->axis;
    if (explicitVoxels) f.corner = voxelCorner(set);
    f.gradient[f.axis] = closest->sign;
    f.anchorDepth = closest->sign * f.corner[f.axis];
    f.wantedSpacing = parameters.periodVoxel[f.axis];
    if (eye->w != 0.0) {
        const glm::dvec3 voxel = (glm::dvec3(*eye) - bounds.min) / parameters.voxelSize;
        f.eyeDepth = closest->sign * voxel[f.axis];
    }
    return {};
}

Status spheres(ViewFamily& f, const Box3d& bounds, const View& view,
               const SamplingParameters& parameters)
{
    const Result<glm::dvec4> eye = eyePosition(view);
    if (!eye) return eye.status;
    f.toEye = glm::dmat3(view.toEye);
    f.eye = glm::dvec3(*eye) - f.corner;
    const Result<glm::dvec3> ray = viewDirectionAt(view, bounds.center());
    glm::dvec3 outwards = glm::normalize(f.toEye * *ray);
    // Gradient of the distance from the eye at the middle of the set, in the position frame.
    const glm::dvec3 gradient = glm::transpose(f.toEye) * outwards;
    f.wantedSpacing = glm::length(gradient * parameters.voxelSize * parameters.periodVoxel);
    return {};
}

} // namespace

Result<ViewFamily> ViewFamily::create(const TetraSet& set, const Box3d& bounds, const View& view,
                                      const SamplingParameters& parameters)
{
    if (Status s = parameters.validate(); !s) return s;
    if (const Result<glm::dmat4> inverse = fromEye(view); !inverse) return inverse.status;
    const Result<glm::dvec4> eye = eyePosition(view);
    if (!eye) return eye.status;

    ViewFamily f;
    f.corner = bounds.min;
    f.eyeDepth = UNKNOWN;
    // Spheres about an eye at infinity are planes.
    f.mode = parameters.mode == SamplingMode::SPHERICAL && eye->w == 0.0
                 ? SamplingMode::VIEWPORT_ALIGNED
                 : parameters.mode;
    Status status;
    switch (f.mode) {
    case SamplingMode::VIEWPORT_ALIGNED:
        status = planes(f, view, parameters);
        break;
    case SamplingMode::AXIS_ALIGNED:
        status = axisPlanes(f, set, bounds, view, parameters);
        break;
    case SamplingMode::SPHERICAL:
        status = spheres(f, bounds, view, parameters);
        break;
    }
    if (!status) return status;
    if (parameters.space == SamplingSpace::VIEW_VOLUME && f.mode != SamplingMode::AXIS_ALIGNED) {
        const Result<NearFar> range = nearFar(view.projection);
        if (!range) return range.status;
        const double farDepth = f.mode == SamplingMode::SPHERICAL
                                    ? farthestCorner(view.projection, range->farDepth)
                                    : range->farDepth;
        f.viewNear = range->nearDepth;
        f.viewFar = farDepth;
    }
    if (!(f.wantedSpacing > 0.0) || !std::isfinite(f.wantedSpacing) ||
        !std::isfinite(f.anchorDepth))
        return Status(ErrorCode::VALUE_INVALID,
                      "SamplingParameters: the distance between surfaces is " +
                          std::to_string(f.wantedSpacing) + " in this view.");
    return f;
}

double ViewFamily::depth(const double* position, const double* voxel) const
{
    const double* p = mode == SamplingMode::AXIS_ALIGNED ? voxel : position;
    const glm::dvec3 q(p[0] - corner.x, p[1] - corner.y, p[2] - corner.z);
    if (mode != SamplingMode::SPHERICAL)
        return gradient.x * q.x + gradient.y * q.y + gradient.z * q.z;
    return glm::length(toEye * (q - eye));
}

SurfaceLattice makeLattice(double nearest, double farthest, double spacing, int maximum)
{
    SurfaceLattice lattice;
    const double extent = farthest - nearest;
    lattice.farDepth = farthest;
    lattice.spacing = spacing;
    lattice.count = 1;
    if (!(extent > 0.0)) return lattice;
    // Rounding noise in the extent must not add a layer.
    const double layers = std::ceil(extent / spacing * (1.0 - 1e-9));
    lattice.count = layers >= maximum ? maximum : std::max(1, static_cast<int>(layers));
    lattice.spacing = extent / lattice.count;
    return lattice;
}

} // namespace core
} // namespace osgVolumizer
