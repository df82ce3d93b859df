#include "BoundMesh.h"

namespace osgVolumizer {
namespace render {

BoundMesh::BoundMesh(osg::State& state, ContextResources& resources, const VolumeMesh& mesh,
                     float spacing)
    : _state(state), _gl(*state.get<osg::GLExtensions>())
{
    state.lazyDisablingOfVertexAttributes();
    state.applyDisablingOfVertexAttributes();
    const std::vector<float>& vertices = mesh.vertexArray();
    const std::vector<unsigned>& indices = mesh.indexArray();
    resources.vertices.stream(_gl, GL_ARRAY_BUFFER_ARB, vertices.data(),
                              vertices.size() * sizeof(float));
    resources.indices.stream(_gl, GL_ELEMENT_ARRAY_BUFFER_ARB, indices.data(),
                             indices.size() * sizeof(unsigned));
    enable(ATTRIBUTE_POSITION, 3, mesh.positionOffset, mesh.stride);
    if (mesh.slabOffset >= 0) enable(ATTRIBUTE_SLAB, 2, mesh.slabOffset, mesh.stride);
    if (mesh.voxelCoordinateOffset >= 0)
        enable(ATTRIBUTE_VOXEL_COORDINATE, 3, mesh.voxelCoordinateOffset, mesh.stride);
    if (mesh.colorOffset >= 0)
        enable(ATTRIBUTE_COLOR, mesh.colorSize, mesh.colorOffset, mesh.stride);
    if (mesh.spacingOffset >= 0)
        enable(ATTRIBUTE_SPACING, 1, mesh.spacingOffset, mesh.stride);
    else
        _gl.glVertexAttrib1f(ATTRIBUTE_SPACING, spacing);
}

BoundMesh::~BoundMesh()
{
    for (unsigned a = 0; a < ATTRIBUTE_COUNT; ++a)
        if (_enabled[a]) _gl.glDisableVertexAttribArray(a);
    _gl.glBindBuffer(GL_ARRAY_BUFFER_ARB, 0);
    _gl.glBindBuffer(GL_ELEMENT_ARRAY_BUFFER_ARB, 0);
    _state.unbindVertexBufferObject();
    _state.unbindElementBufferObject();
}

void BoundMesh::enable(unsigned attribute, int size, int offset, int stride)
{
    _gl.glEnableVertexAttribArray(attribute);
    _gl.glVertexAttribPointer(attribute, size, GL_FLOAT, GL_FALSE,
                              static_cast<GLsizei>(stride * sizeof(float)),
                              reinterpret_cast<const void*>(offset * sizeof(float)));
    _enabled[attribute] = true;
}

} // namespace render
} // namespace osgVolumizer
