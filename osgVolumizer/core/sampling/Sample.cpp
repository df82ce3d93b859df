#include "Sample.h"

#include "../geometry/Orientation.h"
#include "private/ClipRecords.h"
#include "private/Interpolate.h"
#include "private/TetraCases.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace osgVolumizer {
namespace core {

glm::dvec3 PolygonSet::normal(std::size_t face) const
{
    glm::dvec3 n(0.0);
    const glm::dvec3 a = position(face, 0);
    for (std::size_t i = 1; i + 1 < size(face); ++i)
        n += glm::cross(position(face, i) - a, position(face, i + 1) - a);
    return n;
}

void PolygonSet::append(const RecordPolygon& polygon)
{
    if (polygon.size() < 3) return;
    const int stride = format.stride();
    for (std::size_t i = 0; i < polygon.size(); ++i)
        values.insert(values.end(), polygon.record(i), polygon.record(i) + stride);
    faceOffsets.push_back(faceOffsets.back() + static_cast<std::uint32_t>(polygon.size()));
}

void PolygonSet::copyFace(std::size_t face, RecordPolygon& polygon) const
{
    polygon.reset(format.stride());
    for (std::size_t i = 0; i < size(face); ++i)
        std::copy(record(face, i), record(face, i) + format.stride(), polygon.append());
    polygon.close();
}

Status sample(const TetraSet& set, std::size_t tetrahedron, const SurfaceFamily& family,
              const std::vector<double>& depths, PolygonSet& out)
{
    if (tetrahedron >= set.tetraCount())
        return {ErrorCode::INDEX_OUT_OF_RANGE,
                "sample: tetrahedron " + std::to_string(tetrahedron) + " of " +
                    std::to_string(set.tetraCount()) + ".",
                static_cast<std::int64_t>(tetrahedron)};
    const VertexArray& vertices = set.vertices;
    const VertexFormat& format = vertices.format();
    TetraSet::Index t[4];
    std::copy_n(set.indices.begin() + static_cast<std::ptrdiff_t>(4 * tetrahedron), 4, t);
    if (orientationSign(vertices.position(t[0]), vertices.position(t[1]), vertices.position(t[2]),
                        vertices.position(t[3])) < 0)
        std::swap(t[0], t[1]);
    double depth[4];
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 p = vertices.position(t[i]);
        depth[i] =
            family.depth(p, format.voxelCoordinateSize == 3 ? vertices.voxelCoordinate(t[i]) : p);
        if (!std::isfinite(depth[i]))
            return {ErrorCode::VALUE_INVALID, "sample: the depth of a vertex is not finite.", t[i]};
    }
    RecordPolygon polygon;
    const int stride = format.stride();
    for (const double surface : depths) {
        unsigned mask = 0; // near side: smaller depth
        for (int i = 0; i < 4; ++i)
            mask |= depth[i] < surface ? 1u << i : 0u;
        const TetraCase& which = TETRA_CASES[mask];
        if (which.count == 0) continue;
        polygon.reset(stride);
        for (std::size_t c = 0; c < static_cast<std::size_t>(which.count); ++c) {
            const int from = which.farVertex[c], to = which.nearVertex[c];
            const double w = (surface - depth[from]) / (depth[to] - depth[from]);
            const double *p = vertices.record(t[from]), *q = vertices.record(t[to]);
            interpolate(p, q, w, static_cast<std::size_t>(stride), polygon.append());
        }
        polygon.close();
        out.append(polygon);
    }
    return {};
}

void clip(const PolygonSet& in, const Box3d& box, PolygonSet& out)
{
    const int field = in.format.voxelCoordinateSize == 3 ? in.format.voxelCoordinateOffset()
                                                         : in.format.positionOffset();
    RecordPolygon polygon;
    for (std::size_t f = 0; f < in.faceCount(); ++f) {
        in.copyFace(f, polygon);
        polygon.clipBox(field, box);
        out.append(polygon);
    }
}

void clip(const PolygonSet& in, const std::vector<Plane>& halfSpaces, PolygonSet& out)
{
    RecordPolygon polygon;
    for (std::size_t f = 0; f < in.faceCount(); ++f) {
        in.copyFace(f, polygon);
        for (const Plane& plane : halfSpaces)
            if (polygon.size() > 0) polygon.clipPlane(in.format.positionOffset(), plane);
        out.append(polygon);
    }
}

} // namespace core
} // namespace osgVolumizer
