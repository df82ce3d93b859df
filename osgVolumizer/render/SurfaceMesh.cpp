#include "SurfaceMesh.h"

#include "ContextResources.h"

#include <osg/Program>
#include <osg/TriangleIndexFunctor>
#include <osgUtil/StateGraph>

#include <glm/common.hpp>

#include <algorithm>
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

// Draws triangles of a geometry by our own indices, with all of its arrays.
class TrianglesOfGeometry : public osg::Drawable
{
public:
    TrianglesOfGeometry(const osg::Geometry* geometry, SurfaceMesh::Indices indices)
        : _geometry(geometry), _indices(std::move(indices))
    {
        setSupportsDisplayList(false);
        setUseDisplayList(false);
        setUseVertexBufferObjects(geometry && geometry->getUseVertexBufferObjects());
        setDataVariance(osg::Object::STATIC);
        if (geometry && geometry->getDataVariance() == osg::Object::DYNAMIC)
            setDataVariance(osg::Object::DYNAMIC);
    }
    osg::Object* cloneType() const override { return new TrianglesOfGeometry(nullptr, nullptr); }
    osg::Object* clone(const osg::CopyOp&) const override { return cloneType(); }
    const char* libraryName() const override { return "osgVolumizer"; }
    const char* className() const override { return "TrianglesOfGeometry"; }

    void drawImplementation(osg::RenderInfo& renderInfo) const override
    {
        osg::State& state = *renderInfo.getState();
        const bool buffers =
            state.useVertexBufferObject(_supportsVertexBufferObjects && _useVertexBufferObjects);
        osg::VertexArrayState* arrays = state.getCurrentVertexArrayState();
        arrays->setVertexBufferObjectSupported(buffers);
        _geometry->drawVertexArraysImplementation(renderInfo);
        osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
        contextResources(state)->indices.stream(gl, GL_ELEMENT_ARRAY_BUFFER_ARB, _indices->data(),
                                                _indices->size() * sizeof(unsigned));
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(_indices->size()), GL_UNSIGNED_INT,
                       nullptr);
        gl.glBindBuffer(GL_ELEMENT_ARRAY_BUFFER_ARB, 0);
        arrays->unbindElementBufferObject();
        if (buffers) arrays->unbindVertexBufferObject();
    }

private:
    osg::ref_ptr<const osg::Geometry> _geometry;
    SurfaceMesh::Indices _indices;
};

} // namespace

std::unique_ptr<SurfaceMesh> SurfaceMesh::of(const ForeignLeaf& foreign)
{
    const osgUtil::RenderLeaf& leaf = foreign.leaf();
    const osg::Drawable* drawable = leaf.getDrawable();
    if (typeid(*drawable) != typeid(osg::Geometry)) return nullptr;
    const auto& geometry = static_cast<const osg::Geometry&>(*drawable);
    if (!canBeDrawnByIndex(geometry) || hasVertexShader(leaf._parent)) return nullptr;

    const auto& vertices = static_cast<const osg::Vec3Array&>(*geometry.getVertexArray());
    std::vector<unsigned> indices;
    osg::TriangleIndexFunctor<CollectTriangles> collect;
    collect.indices = &indices;
    geometry.accept(collect);

    std::unique_ptr<SurfaceMesh> mesh(new SurfaceMesh);
    mesh->_geometry = &geometry;
    const double infinity = std::numeric_limits<double>::infinity();
    BoxInView& view = mesh->_view;
    view.screen = {glm::dvec2(infinity), glm::dvec2(-infinity)};
    view.depth = {infinity, -infinity};
    const osg::Matrixd toClip = *leaf._modelview * *leaf._projection;
    const osg::Matrixd& toEye = *leaf._modelview;
    std::vector<float> depths(vertices.size());
    bool behind = false;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const osg::Vec3d p(vertices[i]);
        const double depth =
            -(p.x() * toEye(0, 2) + p.y() * toEye(1, 2) + p.z() * toEye(2, 2) + toEye(3, 2));
        const osg::Vec4d clip = osg::Vec4d(p, 1.0) * toClip;
        depths[i] = static_cast<float>(depth);
        behind = behind || !(clip.w() > 0.0);
        const glm::dvec2 device(clip.x() / clip.w(), clip.y() / clip.w());
        view.screen.min = glm::min(view.screen.min, device);
        view.screen.max = glm::max(view.screen.max, device);
        view.depth.nearDepth = std::min(view.depth.nearDepth, depth);
        view.depth.farDepth = std::max(view.depth.farDepth, depth);
    }
    if (behind) view.screen = foreign.view().screen;
    if (!std::isfinite(view.depth.nearDepth) || !std::isfinite(view.depth.farDepth)) return nullptr;
    // GL computes depths in float: what is flat and parallel to the view still has a range.
    const double slack =
        2e-6 * std::max(std::abs(view.depth.nearDepth), std::abs(view.depth.farDepth));
    view.depth.nearDepth -= slack;
    view.depth.farDepth += slack;

    mesh->_triangles.reserve(indices.size() / 3);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        if (std::max({indices[i], indices[i + 1], indices[i + 2]}) >= vertices.size())
            return nullptr;
        const float a = depths[indices[i]], b = depths[indices[i + 1]], c = depths[indices[i + 2]];
        const float s = static_cast<float>(slack);
        mesh->_triangles.push_back({{indices[i], indices[i + 1], indices[i + 2]},
                                    std::min({a, b, c}) - s,
                                    std::max({a, b, c}) + s,
                                    (a + b + c) / 3.0f});
    }
    std::stable_sort(mesh->_triangles.begin(), mesh->_triangles.end(),
                     [](const Triangle& a, const Triangle& b) { return a.middle > b.middle; });
    return mesh;
}

std::vector<SurfaceMesh::Indices>
SurfaceMesh::split(const std::vector<core::DepthInterval>& farToNear) const
{
    std::vector<std::vector<unsigned>> lists(farToNear.size());
    for (const Triangle& t : _triangles) {
        const auto first = std::partition_point(
            farToNear.begin(), farToNear.end(),
            [&t](const core::DepthInterval& d) { return d.nearDepth > t.farDepth; });
        for (auto i = first; i != farToNear.end() && i->farDepth >= t.nearDepth; ++i) {
            std::vector<unsigned>& list = lists[static_cast<std::size_t>(i - farToNear.begin())];
            list.insert(list.end(), t.vertex, t.vertex + 3);
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
