#include "Allocation.h"

#include "GLErrors.h"
#include "VolumeProgram.h"

#include <mutex>

namespace osgVolumizer {
namespace render {

namespace {

std::mutex& mockMutex()
{
    static std::mutex mutex;
    return mutex;
}

std::function<bool(const AllocationRequest&)>& mock()
{
    static std::function<bool(const AllocationRequest&)> isRefused;
    return isRefused;
}

bool isMockedAway(const AllocationRequest& request)
{
    std::lock_guard<std::mutex> lock(mockMutex());
    return mock() && mock()(request);
}

} // namespace

bool allocate(const AllocationRequest& request, const std::function<void()>& make)
{
    if (isMockedAway(request)) return false;
    discardErrors();
    make();
    const bool made = glGetError() == GL_NO_ERROR;
    discardErrors();
    return made;
}

bool allocateTarget(osg::State& state, osg::Texture& texture, const glm::ivec3& size)
{
    AllocationRequest request;
    request.size = size;
    request.internalFormat = static_cast<GLenum>(texture.getInternalFormat());
    const bool made = allocate(request, [&]() {
        state.setActiveTextureUnit(UNIT_OPAQUE_DEPTH);
        texture.apply(state);
        state.haveAppliedTextureAttribute(UNIT_OPAQUE_DEPTH, osg::StateAttribute::TEXTURE);
    });
    if (!made) texture.releaseGLObjects(&state);
    return made;
}

void mockAllocation(std::function<bool(const AllocationRequest&)> isRefused)
{
    std::lock_guard<std::mutex> lock(mockMutex());
    mock() = std::move(isRefused);
}

} // namespace render
} // namespace osgVolumizer
