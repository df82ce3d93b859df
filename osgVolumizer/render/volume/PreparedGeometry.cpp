#include "PreparedGeometry.h"

#include "../../Voxels.h"
#include "../../core/geometry/TetraMesh.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

// The affine map position -> voxel coordinate that explicit voxel coordinates state, if it is one
// for the whole set: taken from the largest tetrahedron and checked at every vertex.
std::optional<glm::dmat4> globalVoxelMap(const core::TetraSet& set)
{
    const core::VertexArray& v = set.vertices;
    double best = 0.0;
    glm::dmat4 map(1.0);
    for (std::size_t t = 0; t < set.tetraCount(); ++t) {
        const auto* i = &set.indices[4 * t];
        const glm::dvec3 p0 = v.position(i[0]), q0 = v.voxelCoordinate(i[0]);
        const glm::dmat3 p(v.position(i[1]) - p0, v.position(i[2]) - p0, v.position(i[3]) - p0);
        const glm::dmat3 q(v.voxelCoordinate(i[1]) - q0, v.voxelCoordinate(i[2]) - q0,
                           v.voxelCoordinate(i[3]) - q0);
        const double volume = std::abs(glm::determinant(p));
        if (!(volume > best)) continue;
        best = volume;
        const glm::dmat3 linear = q * glm::inverse(p);
        map = glm::dmat4(linear);
        map[3] = glm::dvec4(q0 - linear * p0, 1.0);
    }
    if (!(best > 0.0) || !(std::abs(glm::determinant(glm::dmat3(map))) > 0.0)) return std::nullopt;
    core::Box3d extent;
    for (std::size_t k = 0; k < v.size(); ++k)
        extent.expand(v.voxelCoordinate(k));
    const glm::dvec3 size = extent.size();
    const double tolerance = 1e-9 * std::max({size.x, size.y, size.z, 1e-300});
    for (std::size_t k = 0; k < v.size(); ++k) {
        const glm::dvec3 d =
            glm::dvec3(map * glm::dvec4(v.position(k), 1.0)) - v.voxelCoordinate(k);
        if (!(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}) <= tolerance))
            return std::nullopt;
    }
    return map;
}

glm::dmat4 voxelsToObject(const Voxels& voxels)
{
    const osg::Vec3d o = voxels.getOrigin(), s = voxels.getSpacing();
    return glm::scale(glm::translate(glm::dmat4(1.0), glm::dvec3(o.x(), o.y(), o.z())),
                      glm::dvec3(s.x(), s.y(), s.z()));
}

// Unlike glm::inverse, leaves the last row exactly what it is.
glm::dmat4 affineInverse(const glm::dmat4& m)
{
    const glm::dmat3 linear = glm::inverse(glm::dmat3(m));
    glm::dmat4 result(linear);
    result[3] = glm::dvec4(-(linear * glm::dvec3(m[3])), 1.0);
    return result;
}

// The tetra set with positions mapped, and voxel coordinates dropped or kept.
core::TetraSet mapped(const core::TetraSet& set, const glm::dmat4& map, bool keepVoxelCoordinates)
{
    const core::VertexFormat& from = set.vertices.format();
    const core::VertexFormat format = core::VertexFormat::user(
        keepVoxelCoordinates ? from.voxelCoordinateSize : 0, from.colorSize, from.userSize);
    core::TetraSet result;
    result.indices = set.indices;
    result.vertices = core::VertexArray(format);
    result.vertices.resize(set.vertices.size());
    for (std::size_t i = 0; i < set.vertices.size(); ++i) {
        const double* in = set.vertices.record(i);
        double* out = result.vertices.record(i);
        if (format.voxelCoordinateSize > 0) std::copy_n(in, 3, out);
        std::copy_n(in + from.colorOffset(), from.colorSize, out + format.colorOffset());
        std::copy_n(in + from.userOffset(), from.userSize, out + format.userOffset());
        result.vertices.setPosition(i, glm::dvec3(map * glm::dvec4(set.vertices.position(i), 1.0)));
    }
    return result;
}

// Of the longest side of a box; 1 where there is none.
double powerOfTwoAbout(const glm::dvec3& size)
{
    const double longest = std::max({size.x, size.y, size.z});
    return longest > 0.0 ? std::exp2(std::round(std::log2(longest))) : 1.0;
}

double meanEdgeOf(const core::TetraSet& set)
{
    constexpr double CUBED = 8.485281374238571; // of the edge, over the volume: 6 sqrt(2)
    const double edge =
        std::cbrt(CUBED * core::volume(set) / static_cast<double>(set.tetraCount()));
    return edge > 0.0 ? edge : 1.0;
}

// The index of the axis that a normal lies along, or -1.
int axisOf(const glm::dvec3& n)
{
    for (int a = 0; a < 3; ++a)
        if (n[a] != 0.0 && n[(a + 1) % 3] == 0.0 && n[(a + 2) % 3] == 0.0) return a;
    return -1;
}

// Bounds take care of axis-aligned half-spaces; of the others only those that cut the box matter.
void splitRegion(PreparedGeometry& prepared, const core::Box3d& voxelExtent)
{
    prepared.regionBox = intersection(prepared.regionBox, voxelExtent);
    if (!prepared.region) return;
    for (const core::Plane& plane : prepared.region->planes) {
        bool cuts = axisOf(plane.normal) < 0;
        if (cuts) {
            cuts = false;
            for (int i = 0; i < 8; ++i)
                cuts = cuts || plane.distance(prepared.regionBox.corner(i)) < 0.0;
        }
        if (cuts) prepared.obliquePlanes.push_back(plane);
    }
}

} // namespace

std::shared_ptr<const PreparedGeometry>
prepareGeometry(const core::TetraSet& set, const Voxels* voxels, bool scalars, int fieldShader)
{
    auto result = std::make_shared<PreparedGeometry>();
    if (set.vertices.format().userSize > 0) result->fieldShader = fieldShader;
    if (scalars) voxels = nullptr;
    result->scalars = scalars;
    const bool explicitCoordinates = !scalars && set.vertices.format().voxelCoordinateSize == 3;
    std::optional<glm::dmat4> objectToVoxel;
    if (explicitCoordinates)
        objectToVoxel = globalVoxelMap(set);
    else if (voxels)
        objectToVoxel = affineInverse(voxelsToObject(*voxels));
    result->voxelFrame = objectToVoxel.has_value();
    if (objectToVoxel) {
        result->frameToObject =
            explicitCoordinates ? affineInverse(*objectToVoxel) : voxelsToObject(*voxels);
        result->tetras = mapped(set, *objectToVoxel, false);
    } else {
        const core::Box3d box = set.bounds();
        result->unitsPerFrame = powerOfTwoAbout(box.size());
        const glm::dvec3 scale(result->unitsPerFrame);
        result->frameToObject = glm::scale(glm::translate(glm::dmat4(1.0), box.center()), scale);
        result->tetras = mapped(
            set, glm::translate(glm::scale(glm::dmat4(1.0), 1.0 / scale), -box.center()), !scalars);
    }
    result->meanEdge = meanEdgeOf(result->tetras);
    result->bounds = result->tetras.bounds();
    result->regionBox = result->bounds;
    if (result->voxelFrame && voxels) {
        result->region = core::convexRegion(result->tetras);
        splitRegion(*result, voxels->getLayout().extent());
    }
    return result;
}

} // namespace render
} // namespace osgVolumizer
