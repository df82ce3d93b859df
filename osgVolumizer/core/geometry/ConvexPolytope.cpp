#include "ConvexPolytope.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

constexpr double ON_PLANE = 1e-13;
constexpr std::uint32_t NO_NEXT = 0xffffffffu;

} // namespace

void ConvexPolytope::clear()
{
    vertices.clear();
    indices.clear();
    faceOffsets.assign(1, 0);
    faceTags.clear();
}

void ConvexPolytope::setBox(const Box3d& box)
{
    clear();
    if (!(box.min.x < box.max.x && box.min.y < box.max.y && box.min.z < box.max.z)) return;
    static constexpr std::uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                                  {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (int i = 0; i < 8; ++i)
        vertices.push_back(box.corner(i));
    for (int f = 0; f < 6; ++f) {
        indices.insert(indices.end(), faces[f], faces[f] + 4);
        faceOffsets.push_back(static_cast<std::uint32_t>(indices.size()));
        faceTags.push_back(f);
    }
}

void ConvexPolytope::assign(const ConvexPolytope& other)
{
    vertices.assign(other.vertices.begin(), other.vertices.end());
    indices.assign(other.indices.begin(), other.indices.end());
    faceOffsets.assign(other.faceOffsets.begin(), other.faceOffsets.end());
    faceTags.assign(other.faceTags.begin(), other.faceTags.end());
}

std::uint32_t ConvexPolytope::cut(std::uint32_t inside, std::uint32_t outside)
{
    for (const Cut& c : _cuts)
        if (c.inside == inside && c.outside == outside) return c.vertex;
    const double t = _distances[inside] / (_distances[inside] - _distances[outside]);
    const auto vertex = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back(vertices[inside] + t * (vertices[outside] - vertices[inside]));
    _distances.push_back(0.0);
    _cuts.push_back({inside, outside, vertex});
    return vertex;
}

void ConvexPolytope::clipFace(std::size_t face)
{
    const std::uint32_t first = faceOffsets[face], end = faceOffsets[face + 1];
    bool reachesInside = false;
    for (std::uint32_t i = first; i < end; ++i)
        reachesInside = reachesInside || _distances[indices[i]] > 0.0;
    if (!reachesInside) return;
    const std::size_t start = _indices.size();
    for (std::uint32_t i = first; i < end; ++i) {
        const std::uint32_t a = indices[i], b = indices[i + 1 == end ? first : i + 1];
        const double da = _distances[a], db = _distances[b];
        if (da >= 0.0) _indices.push_back(a);
        if (da > 0.0 && db < 0.0) _indices.push_back(cut(a, b));
        if (da < 0.0 && db > 0.0) _indices.push_back(cut(b, a));
    }
    // Where an edge runs in the plane, the closing face runs along it the other way.
    for (std::size_t i = start; i < _indices.size(); ++i) {
        const std::uint32_t a = _indices[i];
        const std::uint32_t b = _indices[i + 1 == _indices.size() ? start : i + 1];
        if (_distances[a] == 0.0 && _distances[b] == 0.0) {
            if (_next.size() < vertices.size()) _next.resize(vertices.size(), NO_NEXT);
            _next[b] = a;
        }
    }
    _offsets.push_back(static_cast<std::uint32_t>(_indices.size()));
    _tags.push_back(faceTags[face]);
}

void ConvexPolytope::closeWith(int tag)
{
    for (std::uint32_t start = 0; start < _next.size(); ++start) {
        if (_next[start] == NO_NEXT) continue;
        const std::size_t size = _indices.size();
        for (std::uint32_t v = start; v != NO_NEXT && _next[v] != NO_NEXT;) {
            _indices.push_back(v);
            const std::uint32_t next = _next[v];
            _next[v] = NO_NEXT;
            v = next < _next.size() ? next : NO_NEXT;
        }
        if (_indices.size() - size < 3) {
            _indices.resize(size);
            continue;
        }
        _offsets.push_back(static_cast<std::uint32_t>(_indices.size()));
        _tags.push_back(tag);
    }
}

void ConvexPolytope::compact()
{
    _next.assign(vertices.size(), NO_NEXT);
    for (const std::uint32_t i : indices)
        _next[i] = 0;
    std::uint32_t used = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (_next[i] == NO_NEXT) continue;
        vertices[used] = vertices[i];
        _next[i] = used++;
    }
    vertices.resize(used);
    for (std::uint32_t& i : indices)
        i = _next[i];
}

void ConvexPolytope::clip(const Plane& plane, int tag)
{
    if (empty()) return;
    _distances.clear();
    bool anyInside = false, anyOutside = false;
    for (const glm::dvec3& v : vertices) {
        const glm::dvec3 n = glm::abs(plane.normal * v);
        double d = plane.distance(v);
        if (std::abs(d) <= ON_PLANE * (n.x + n.y + n.z + std::abs(plane.offset))) d = 0.0;
        _distances.push_back(d);
        anyInside = anyInside || d > 0.0;
        anyOutside = anyOutside || d < 0.0;
    }
    if (!anyOutside && anyInside) return;
    if (!anyInside) {
        clear();
        return;
    }
    _cuts.clear();
    _indices.clear();
    _offsets.assign(1, 0);
    _tags.clear();
    _next.clear();
    for (std::size_t f = 0; f < faceCount(); ++f)
        clipFace(f);
    closeWith(tag);
    indices.swap(_indices);
    faceOffsets.swap(_offsets);
    faceTags.swap(_tags);
    compact();
}

double ConvexPolytope::volume() const
{
    if (empty()) return 0.0;
    const glm::dvec3 apex = vertices[indices[0]];
    double six = 0.0;
    for (std::size_t f = 0; f < faceCount(); ++f)
        six += glm::dot(faceNormal(f), vertices[indices[faceOffsets[f]]] - apex);
    return six / 6.0;
}

glm::dvec3 ConvexPolytope::faceNormal(std::size_t face) const
{
    const std::uint32_t first = faceOffsets[face];
    const glm::dvec3 a = vertices[indices[first]];
    glm::dvec3 n(0.0);
    for (std::uint32_t i = first + 1; i + 1 < faceOffsets[face + 1]; ++i)
        n += glm::cross(vertices[indices[i]] - a, vertices[indices[i + 1]] - a);
    return n;
}

} // namespace core
} // namespace osgVolumizer
