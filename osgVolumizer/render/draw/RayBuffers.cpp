#include "RayBuffers.h"

namespace osgVolumizer {
namespace render {

void RayBuffers::release(osg::GLExtensions& gl)
{
    deleteFramebuffers(gl, {&target.framebuffer});
}

} // namespace render
} // namespace osgVolumizer
