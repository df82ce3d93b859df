#include "ContextResources.h"

#include "SharedStateSets.h"

#include <map>
#include <mutex>

namespace osgVolumizer {
namespace render {

namespace {

std::mutex& registryMutex()
{
    static std::mutex mutex;
    return mutex;
}

std::map<unsigned, std::shared_ptr<ContextResources>>& registry()
{
    static std::map<unsigned, std::shared_ptr<ContextResources>> resources;
    return resources;
}

void release(ContextResources& resources, osg::State& state)
{
    const unsigned contextId = state.getContextID();
    for (const auto& program : resources.rays.programs)
        program.second->releaseGLObjects(&state);
    // Without the extensions there never was a context to make anything in.
    osg::GLExtensions* gl = osg::GLExtensions::Get(contextId, false);
    if (gl) {
        resources.vertices.release(*gl);
        resources.indices.release(*gl);
        AccumulationBuffers& buffers = resources.accumulation;
        LayerBuffers& layers = buffers.layers;
        for (GLuint* name :
             {&buffers.framebuffer, &buffers.layerFramebuffer, &layers.sortedFramebuffer,
              &layers.rankFramebuffer, &resources.rays.framebuffer})
            if (*name) gl->glDeleteFramebuffers(1, name);
        if (layers.queries[0]) {
            gl->glDeleteFramebuffers(LayerBuffers::COUNT, layers.layerFramebuffers);
            gl->glDeleteQueries(LayerBuffers::COUNT, layers.queries);
        }
    }
}

} // namespace

ContextResources::ContextResources()
{
    osg::setGLExtensionFuncPtr(glGetFramebufferAttachmentParameteriv,
                               "glGetFramebufferAttachmentParameteriv",
                               "glGetFramebufferAttachmentParameterivEXT");
}

void StreamBuffer::stream(osg::GLExtensions& gl, GLenum target, const void* data, std::size_t bytes)
{
    if (!_name) gl.glGenBuffers(1, &_name);
    gl.glBindBuffer(target, _name);
    gl.glBufferData(target, static_cast<GLsizeiptr>(bytes), data, GL_STREAM_DRAW);
}

void StreamBuffer::release(osg::GLExtensions& gl)
{
    if (_name) gl.glDeleteBuffers(1, &_name);
    _name = 0;
}

std::shared_ptr<ContextResources> contextResources(osg::State& state)
{
    std::lock_guard<std::mutex> lock(registryMutex());
    std::shared_ptr<ContextResources>& entry = registry()[state.getContextID()];
    if (!entry) entry = std::make_shared<ContextResources>();
    return entry;
}

void releaseContextResources(osg::State* state)
{
    releaseSharedStateSets(state);
    std::lock_guard<std::mutex> lock(registryMutex());
    if (!state) {
        // No context is current: the names go with their contexts.
        registry().clear();
        return;
    }
    const auto entry = registry().find(state->getContextID());
    if (entry == registry().end()) return;
    release(*entry->second, *state);
    registry().erase(entry);
}

} // namespace render
} // namespace osgVolumizer
