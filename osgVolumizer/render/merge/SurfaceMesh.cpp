#include "SurfaceMesh.h"

#include "../context/LeafState.h"

#include "TrianglesOfGeometry.h"

#include <osg/Program>
#include <osg/TriangleIndexFunctor>
#include <osgUtil/StateGraph>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <typeinfo>

namespace osgVolumizer {
namespace render {

namespace {

bool hasVertexShader(const osgUtil::StateGraph* graph)
{
    for (; graph; graph = graph->_parent) {
        const osg::StateSet* set = graph->getStateSet();
        if (!set) continue;
        if (set->getAttribute(osg::StateAttribute::VERTEXPROGRAM)) return true;
        const auto* program =
            static_cast<const osg::Program*>(set->getAttribute(osg::StateAttribute::PROGRAM));
        if (program && program->getNumShaders() > 0) return true;
    }
    return false;
}

bool isTriangles(GLenum mode)
{
    switch (mode) {
    case GL_TRIANGLES:
    case GL_TRIANGLE_STRIP:
    case GL_TRIANGLE_FAN:
    case GL_QUADS:
    case GL_QUAD_STRIP:
    case GL_POLYGON:
        return true;
    default:
        return false;
    }
}

bool canBeDrawnByIndex(const osg::Geometry& geometry)
{
    if (geometry.getDrawCallback() || geometry.getNumPrimitiveSets() == 0) return false;
    const auto* vertices = dynamic_cast<const osg::Vec3Array*>(geometry.getVertexArray());
    if (!vertices || vertices->empty()) return false;
    for (const auto& primitives : geometry.getPrimitiveSetList())
        if (!isTriangles(primitives->getMode()) || primitives->getNumInstances() > 0) return false;
    osg::Geometry::ArrayList arrays;
    geometry.getArrayList(arrays);
    for (const auto& array : arrays)
        if (array && array->getBinding() == osg::Array::BIND_PER_PRIMITIVE_SET) return false;
    return true;
}

struct CollectTriangles
{
    std::vector<unsigned>* indices = nullptr;
    void operator()(unsigned a, unsigned b, unsigned c)
    {
        if (a != b && b != c && a != c) indices->insert(indices->end(), {a, b, c});
    }
};

} // namespace

std::unique_ptr<SurfaceMesh> SurfaceMesh::of(const ForeignLeaf& foreign)
{
    const osgUtil::RenderLeaf& leaf = foreign.leaf();
    const osg::Drawable* drawable = leaf.getDrawable();
    if (typeid(*drawable) != typeid(osg::Geometry)) return nullptr;
    const auto& geometry = static_cast<const osg::Geometry&>(*drawable);
    if (!canBeDrawnByIndex(geometry) || hasVertexShader(leaf._parent)) return nullptr;

    std::unique_ptr<SurfaceMesh> mesh(new SurfaceMesh);
    mesh->_geometry = &geometry;
    osg::TriangleIndexFunctor<CollectTriangles> collect;
    collect.indices = &mesh->_indices;
    geometry.accept(collect);
    const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
    for (unsigned index : mesh->_indices)
        if (index >= vertices.size()) return nullptr;

    mesh->project(vertices, leaf);
    BoxInView& view = mesh->_view;
    if (mesh->_behindEye) view.screen = foreign.view().screen;
    if (!std::isfinite(view.depth.nearDepth) || !std::isfinite(view.depth.farDepth)) return nullptr;
    // GL computes depths in float: what is flat and parallel to the view still has a range.
    const double slack =
        2e-6 * std::max(std::abs(view.depth.nearDepth), std::abs(view.depth.farDepth));
    view.depth.nearDepth -= slack;
    view.depth.farDepth += slack;
    mesh->_slack = static_cast<float>(slack);
    return mesh;
}

// Finds depths and device coordinates of all vertices, and their bounds.
void SurfaceMesh::project(const osg::Vec3Array& vertices, const osgUtil::RenderLeaf& leaf)
{
    const double infinity = std::numeric_limits<double>::infinity();
    _view.screen = {glm::dvec2(infinity), glm::dvec2(-infinity)};
    _view.depth = {infinity, -infinity};
    const osg::Matrixd toClip = *leaf._modelview * usualProjection(leaf);
    const osg::Matrixd& toEye = *leaf._modelview;
    _depths.resize(vertices.size());
    _devices.resize(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const osg::Vec3d p(vertices[i]);
        const double depth =
            -(p.x() * toEye(0, 2) + p.y() * toEye(1, 2) + p.z() * toEye(2, 2) + toEye(3, 2));
        const osg::Vec4d clip = osg::Vec4d(p, 1.0) * toClip;
        _depths[i] = static_cast<float>(depth);
        _behindEye = _behindEye || !(clip.w() > 0.0);
        const glm::dvec2 device(clip.x() / clip.w(), clip.y() / clip.w());
        _devices[i] = glm::vec2(device);
        _view.screen.min = glm::min(_view.screen.min, device);
        _view.screen.max = glm::max(_view.screen.max, device);
        _view.depth.nearDepth = std::min(_view.depth.nearDepth, depth);
        _view.depth.farDepth = std::max(_view.depth.farDepth, depth);
    }
}

double SurfaceMesh::coverEstimate() const
{
    constexpr int CELLS = 12;
    const glm::dvec2 size = glm::max(_view.screen.max - _view.screen.min, glm::dvec2(1e-12));
    const glm::dvec2 cells = double(CELLS) / size;
    std::array<double, CELLS * CELLS> areas{};
    const auto add = [&](const glm::dvec2& place, double area) {
        const glm::dvec2 cell = (place - _view.screen.min) * cells;
        const int x = std::clamp(static_cast<int>(cell.x), 0, CELLS - 1);
        const int y = std::clamp(static_cast<int>(cell.y), 0, CELLS - 1);
        areas[static_cast<std::size_t>(y * CELLS + x)] += area;
    };
    for (std::size_t i = 0; i + 2 < _indices.size(); i += 3) {
        const glm::dvec2 a(_devices[_indices[i]]), b(_devices[_indices[i + 1]]),
            c(_devices[_indices[i + 2]]);
        const glm::dvec2 u = b - a, v = c - a;
        // Four like triangles, each at its middle.
        const double quarter = 0.125 * std::abs(u.x * v.y - u.y * v.x);
        const glm::dvec2 middle = (a + b + c) / 3.0;
        add(middle, quarter);
        add(0.5 * (middle + a), quarter);
        add(0.5 * (middle + b), quarter);
        add(0.5 * (middle + c), quarter);
    }
    return *std::max_element(areas.begin(), areas.end()) * cells.x * cells.y;
}

bool SurfaceMesh::touches(const VolumeOutline& outline) const
{
    if (outline.everywhere || _behindEye) return outline.depth.overlaps(_view.depth);
    for (std::size_t i = 0; i + 2 < _indices.size(); i += 3)
        if (touches(outline, &_indices[i])) return true;
    return false;
}

// Separating axes: those of the screen, the triangle's edges, and the edges of the box, among which
// are those of its hull.
bool SurfaceMesh::touches(const VolumeOutline& outline, const unsigned* triangle) const
{
    float nearest = std::numeric_limits<float>::max(), farthest = -nearest;
    glm::dvec2 corners[3];
    for (int i = 0; i < 3; ++i) {
        nearest = std::min(nearest, _depths[triangle[i]]);
        farthest = std::max(farthest, _depths[triangle[i]]);
        corners[i] = _devices[triangle[i]];
    }
    if (!outline.depth.overlaps({nearest - _slack, farthest + _slack})) return false;
    const auto separates = [&](const glm::dvec2& axis) {
        double low[2], high[2];
        const auto project = [&axis](const glm::dvec2* points, int count, double& min,
                                     double& max) {
            min = max = glm::dot(points[0], axis);
            for (int i = 1; i < count; ++i) {
                const double at = glm::dot(points[i], axis);
                min = std::min(min, at);
                max = std::max(max, at);
            }
        };
        project(corners, 3, low[0], high[0]);
        project(outline.corners, 8, low[1], high[1]);
        const double margin = glm::dot(outline.margin, glm::abs(axis));
        return high[0] < low[1] - margin || low[0] > high[1] + margin;
    };
    const auto normal = [](const glm::dvec2& edge) { return glm::dvec2(-edge.y, edge.x); };
    if (separates({1.0, 0.0}) || separates({0.0, 1.0})) return false;
    for (int i = 0; i < 3; ++i)
        if (separates(normal(corners[(i + 1) % 3] - corners[i]))) return false;
    for (int i = 0; i < 8; ++i)
        for (int axis = 1; axis < 8; axis <<= 1)
            if (!(i & axis) && separates(normal(outline.corners[i | axis] - outline.corners[i])))
                return false;
    return true;
}

std::vector<SurfaceMesh::Indices>
SurfaceMesh::split(const std::vector<core::DepthInterval>& farToNear) const
{
    struct Triangle
    {
        std::size_t first;
        float nearDepth, farDepth, middle;
    };
    std::vector<Triangle> triangles;
    triangles.reserve(triangleCount());
    for (std::size_t i = 0; i + 2 < _indices.size(); i += 3) {
        const float a = _depths[_indices[i]], b = _depths[_indices[i + 1]],
                    c = _depths[_indices[i + 2]];
        triangles.push_back(
            {i, std::min({a, b, c}) - _slack, std::max({a, b, c}) + _slack, (a + b + c) / 3.0f});
    }
    std::stable_sort(triangles.begin(), triangles.end(),
                     [](const Triangle& a, const Triangle& b) { return a.middle > b.middle; });
    std::vector<std::vector<unsigned>> lists(farToNear.size());
    for (const Triangle& t : triangles) {
        const auto first = std::partition_point(
            farToNear.begin(), farToNear.end(),
            [&t](const core::DepthInterval& d) { return d.nearDepth > t.farDepth; });
        for (auto i = first; i != farToNear.end() && i->farDepth >= t.nearDepth; ++i) {
            std::vector<unsigned>& list = lists[static_cast<std::size_t>(i - farToNear.begin())];
            const unsigned* corners = &_indices[t.first];
            list.insert(list.end(), corners, corners + 3);
        }
    }
    std::vector<Indices> result;
    for (std::vector<unsigned>& list : lists)
        result.push_back(std::make_shared<const std::vector<unsigned>>(std::move(list)));
    return result;
}

osg::ref_ptr<osg::Drawable> SurfaceMesh::drawable(Indices indices) const
{
    return new TrianglesOfGeometry(_geometry, std::move(indices));
}

} // namespace render
} // namespace osgVolumizer
