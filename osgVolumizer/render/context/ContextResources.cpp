#include "ContextResources.h"

#include "ContextRefusals.h"
#include "MeasurePrecision.h"
#include "SharedStateSets.h"

#include <osg/ContextData>

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

std::shared_ptr<ContextResources> take(unsigned contextId)
{
    forgetRefusals(contextId);
    std::lock_guard<std::mutex> lock(registryMutex());
    const auto entry = registry().find(contextId);
    if (entry == registry().end()) return nullptr;
    const std::shared_ptr<ContextResources> resources = entry->second;
    registry().erase(entry);
    return resources;
}

void releaseContext(osg::State& state, bool current)
{
    releaseSharedStateSets(&state);
    const std::shared_ptr<ContextResources> resources = take(state.getContextID());
    // Without the extensions there never was a context to make anything in.
    osg::GLExtensions* gl = osg::GLExtensions::Get(state.getContextID(), false);
    if (resources && gl && current) resources->release(*gl);
}

// OSG keeps one for each context number that has resources, and tells it when they go.
class ContextWatch : public osg::GraphicsObjectManager
{
public:
    explicit ContextWatch(unsigned contextId)
        : osg::GraphicsObjectManager("osgVolumizer::render::ContextResources", contextId)
    {
    }
    void flushDeletedGLObjects(double, double&) override {}
    void flushAllDeletedGLObjects() override {}
    void deleteAllGLObjects() override { releaseAll(true); }
    void discardAllGLObjects() override { releaseAll(false); }

private:
    void releaseAll(bool current)
    {
        // Only its number is asked for.
        const osg::ref_ptr<osg::State> state = new osg::State;
        state->setContextID(getContextID());
        releaseContext(*state, current);
    }
};

} // namespace

ContextResources::ContextResources(osg::State& state) : limits(queryContextLimits(state))
{
    osg::setGLExtensionFuncPtr(glGetFramebufferAttachmentParameteriv,
                               "glGetFramebufferAttachmentParameteriv",
                               "glGetFramebufferAttachmentParameterivEXT");
    if (limits.check().ok()) setPrecision(limits, measurePrecision(state, *this), state);
}

void ContextResources::release(osg::GLExtensions& gl)
{
    vertices.release(gl);
    indices.release(gl);
    for (const auto& part : _parts)
        part.second->release(gl);
    _parts.clear();
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
    const unsigned id = state.getContextID();
    {
        std::lock_guard<std::mutex> lock(registryMutex());
        const auto entry = registry().find(id);
        if (entry != registry().end()) return entry->second;
    }
    // Draws, and may report: nobody else waits for that. One thread at a time has the context.
    const auto made = std::make_shared<ContextResources>(state);
    std::lock_guard<std::mutex> lock(registryMutex());
    registry()[id] = made;
    osg::get<ContextWatch>(id);
    return made;
}

Precision precisionOf(const osg::State& state)
{
    std::lock_guard<std::mutex> lock(registryMutex());
    const auto entry = registry().find(state.getContextID());
    return entry != registry().end() ? entry->second->limits.precision : Precision();
}

Precision leastPrecision()
{
    std::lock_guard<std::mutex> lock(registryMutex());
    Precision least;
    bool known = false;
    for (const auto& entry : registry()) {
        const Precision& p = entry.second->limits.precision;
        if (!known || p.filterWeight > least.filterWeight) least = p;
        known = true;
    }
    return least;
}

std::size_t contextResourcesCount()
{
    std::lock_guard<std::mutex> lock(registryMutex());
    return registry().size();
}

void releaseContextResources(osg::State* state)
{
    if (state) {
        releaseContext(*state, true);
        return;
    }
    // No context is current: the names go with their contexts.
    releaseSharedStateSets(nullptr);
    std::lock_guard<std::mutex> lock(registryMutex());
    for (const auto& entry : registry())
        forgetRefusals(entry.first);
    registry().clear();
}

} // namespace render
} // namespace osgVolumizer
