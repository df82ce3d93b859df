#include "TrianglesOfGeometry.h"

#include "../context/ContextResources.h"

namespace osgVolumizer {
namespace render {

TrianglesOfGeometry::TrianglesOfGeometry(const osg::Geometry* geometry, Indices indices)
    : _geometry(geometry), _indices(std::move(indices))
{
    setSupportsDisplayList(false);
    setUseDisplayList(false);
    setUseVertexBufferObjects(geometry && geometry->getUseVertexBufferObjects());
    setDataVariance(osg::Object::STATIC);
    if (geometry && geometry->getDataVariance() == osg::Object::DYNAMIC)
        setDataVariance(osg::Object::DYNAMIC);
}

void TrianglesOfGeometry::drawImplementation(osg::RenderInfo& renderInfo) const
{
    if (!_geometry) return;
    osg::State& state = *renderInfo.getState();
    const bool buffers =
        state.useVertexBufferObject(_supportsVertexBufferObjects && _useVertexBufferObjects);
    osg::VertexArrayState* arrays = state.getCurrentVertexArrayState();
    arrays->setVertexBufferObjectSupported(buffers);
    _geometry->drawVertexArraysImplementation(renderInfo);
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    contextResources(state)->indices.stream(gl, GL_ELEMENT_ARRAY_BUFFER_ARB, _indices->data(),
                                            _indices->size() * sizeof(unsigned));
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(_indices->size()), GL_UNSIGNED_INT, nullptr);
    gl.glBindBuffer(GL_ELEMENT_ARRAY_BUFFER_ARB, 0);
    arrays->unbindElementBufferObject();
    if (buffers) arrays->unbindVertexBufferObject();
}

} // namespace render
} // namespace osgVolumizer
