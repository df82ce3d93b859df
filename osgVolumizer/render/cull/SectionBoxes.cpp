#include "SectionBoxes.h"

#include "../context/Matrices.h"
#include "../volume/PixelFootprint.h"
#include "BrickSelection.h"

#include <osgUtil/CullVisitor>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

namespace SectionBoxMeasures {

glm::dvec3 voxelAt(const core::PolygonSet& polygons, std::size_t face, std::size_t corner)
{
    const double* record = polygons.record(face, corner);
    return {record[0], record[1], record[2]};
}

glm::dvec3 acrossAt(const core::PolygonSet& polygons, std::size_t face)
{
    const double* across = polygons.record(face, 0) + slices::SliceFaces::ACROSS;
    return glm::abs(glm::dvec3(across[0], across[1], across[2]));
}

// Whether a convex polygon and a box lie on two sides of a plane that is upright on an axis.
bool isApart(const core::PolygonSet& polygons, std::size_t face, const core::Box3d& box,
             const glm::dvec3& axis)
{
    const double middle = glm::dot(axis, box.center());
    const double half = 0.5 * glm::dot(glm::abs(axis), box.size());
    double low = INFINITY, high = -INFINITY;
    for (std::size_t c = 0; c < polygons.size(face); ++c) {
        const double at = glm::dot(axis, voxelAt(polygons, face, c)) - middle;
        low = std::min(low, at);
        high = std::max(high, at);
    }
    return low > half || high < -half;
}

bool meets(const core::PolygonSet& polygons, std::size_t face, const core::Box3d& box)
{
    const std::size_t n = polygons.size(face);
    glm::dvec3 normal(0.0);
    const glm::dvec3 first = voxelAt(polygons, face, 0);
    for (std::size_t c = 2; c < n; ++c)
        normal +=
            glm::cross(voxelAt(polygons, face, c - 1) - first, voxelAt(polygons, face, c) - first);
    if (isApart(polygons, face, box, normal)) return false;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 unit(0.0);
        unit[axis] = 1.0;
        if (isApart(polygons, face, box, unit)) return false;
        for (std::size_t c = 0; c < n; ++c) {
            const glm::dvec3 edge =
                voxelAt(polygons, face, (c + 1) % n) - voxelAt(polygons, face, c);
            if (isApart(polygons, face, box, glm::cross(edge, unit))) return false;
        }
    }
    return true;
}

double areaOf(const core::PolygonSet& polygons, std::size_t face, bool ofVoxels)
{
    const auto at = [&](std::size_t c) {
        return ofVoxels ? voxelAt(polygons, face, c) : polygons.position(face, c);
    };
    glm::dvec3 sum(0.0);
    for (std::size_t c = 2; c < polygons.size(face); ++c)
        sum += glm::cross(at(c - 1) - at(0), at(c) - at(0));
    return glm::length(sum);
}

} // namespace SectionBoxMeasures

SectionBoxes::SectionBoxes(const slices::SliceFaces& faces, double thickness,
                           const glm::dmat4& frameToObject, const glm::dmat4& positionsToEye,
                           osgUtil::CullVisitor& visitor)
    : _faces(faces), _half(0.5 * thickness), _frameToObject(frameToObject), _visitor(visitor)
{
    using namespace SectionBoxMeasures;
    const glm::dmat2x3 edges = pixelEdges(positionsToEye, 1.0, visitor);
    const double unitsPerPixel = std::min(glm::length(edges[0]), glm::length(edges[1]));
    _seen.reserve(faces.polygons.faceCount());
    for (std::size_t f = 0; f < faces.polygons.faceCount(); ++f) {
        _seen.push_back(look(f, positionsToEye, unitsPerPixel, visitor));
        if (_seen.back().visible) _reach = glm::max(_reach, _half * acrossAt(faces.polygons, f));
    }
}

// Near and far may still move.
SectionBoxes::Seen SectionBoxes::look(std::size_t face, const glm::dmat4& positionsToEye,
                                      double unitsPerPixel, osgUtil::CullVisitor& visitor) const
{
    using namespace SectionBoxMeasures;
    const core::PolygonSet& polygons = _faces.polygons;
    const glm::dmat4 toClip = toGlm(*visitor.getProjectionMatrix()) * positionsToEye;
    bool beyond[5] = {true, true, true, true, true};
    double nearest = INFINITY;
    for (std::size_t c = 0; c < polygons.size(face); ++c) {
        const glm::dvec4 clip = toClip * glm::dvec4(polygons.position(face, c), 1.0);
        const double distances[5] = {clip.w + clip.x, clip.w - clip.x, clip.w + clip.y,
                                     clip.w - clip.y, clip.w};
        for (int side = 0; side < 5; ++side)
            beyond[side] = beyond[side] && distances[side] < 0.0;
        nearest = std::min(nearest, clip.w);
    }
    Seen seen;
    seen.visible = std::none_of(beyond, beyond + 5, [](bool b) { return b; });
    if (!seen.visible || !_faces.ownPlaces) return seen;
    const double ratio = areaOf(polygons, face, true) / areaOf(polygons, face, false);
    seen.pixelsPerVoxel = 1.0 / (unitsPerPixel * std::max(nearest, 0.0) * std::sqrt(ratio));
    if (!(seen.pixelsPerVoxel >= 0.0)) seen.pixelsPerVoxel = INFINITY;
    return seen;
}

template <class F>
bool SectionBoxes::findTouching(const core::Box3d& box, F&& f) const
{
    using namespace SectionBoxMeasures;
    bool found = false;
    _faces.boxes.visit(box.min - _reach, box.max + _reach, [&](int number, bool) {
        const auto face = static_cast<std::size_t>(number);
        if (found || !_seen[face].visible) return;
        const glm::dvec3 reach = _half * acrossAt(_faces.polygons, face);
        const core::Box3d wider{box.min - reach - 1e-3, box.max + reach + 1e-3};
        if (meets(_faces.polygons, face, wider)) found = f(face);
    });
    return found;
}

bool SectionBoxes::touches(const core::Box3d& box) const
{
    // A face may be far larger than the view.
    const core::Box3d wider{box.min - _reach, box.max + _reach};
    if (!_faces.ownPlaces && _visitor.isCulled(objectBounds(wider, _frameToObject))) return false;
    return findTouching(box, [](std::size_t) { return true; });
}

std::optional<double> SectionBoxes::pixelsPerVoxel(const core::Box3d& box) const
{
    if (!_faces.ownPlaces) return std::nullopt;
    double most = 0.0;
    (void)findTouching(box, [&](std::size_t face) {
        most = std::max(most, _seen[face].pixelsPerVoxel);
        return false;
    });
    return most;
}

} // namespace render
} // namespace osgVolumizer
