#include "CoarseImage.h"

#include "../context/ProgramInterface.h"
#include "../context/ReportOnce.h"
#include "../context/ScissorScope.h"
#include "../context/ScreenPass.h"
#include "../context/Uniforms.h"
#include "AccumulationBuffers.h"
#include "VolumeProgram.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

constexpr unsigned UNIT_COARSE = UNIT_SPLIT_DEPTH; // of programs that are never coarse

void clear()
{
    GLfloat color[4];
    glGetFloatv(GL_COLOR_CLEAR_VALUE, color);
    glClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    glClearColor(color[0], color[1], color[2], color[3]);
}

// First and last pixel of a rectangle.
glm::vec4 ends(const glm::ivec4& r)
{
    return glm::vec4(r[0], r[1], r[0] + r[2] - 1, r[1] + r[3] - 1);
}

} // namespace

void CoarseBuffers::release(osg::GLExtensions& gl)
{
    deleteFramebuffers(gl, {&target.framebuffer});
}

CoarseImage::CoarseImage(osg::State& state, ContextResources& resources, const glm::dvec4& viewport,
                         double distance)
    : _state(state), _resources(resources), _scope(state), _window(viewport),
      _size(std::max(1, int(std::ceil(viewport[2] / distance))),
            std::max(1, int(std::ceil(viewport[3] / distance)))),
      _toWindow(viewport[2] / _size.x, viewport[3] / _size.y, viewport[0], viewport[1]),
      _scissored(glIsEnabled(GL_SCISSOR_TEST))
{
    glGetIntegerv(GL_VIEWPORT, _viewport);
    glGetIntegerv(GL_SCISSOR_BOX, _scissor);
    _made = resources.part<CoarseBuffers>().target.ensure(state, _size.x, _size.y);
    if (!_made)
        reportOnce({ErrorCode::NOT_SUPPORTED, "the card has no memory for coarse images; volumes "
                                              "have a ray for each pixel while the view moves"});
    _scope.drawOver();
}

CoarseImage::~CoarseImage()
{
    glViewport(_viewport[0], _viewport[1], _viewport[2], _viewport[3]);
    glScissor(_scissor[0], _scissor[1], _scissor[2], _scissor[3]);
    if (_scissored)
        glEnable(GL_SCISSOR_TEST);
    else
        glDisable(GL_SCISSOR_TEST);
}

bool CoarseImage::begin(const Uniforms& uniforms, const glm::ivec4& rectangle)
{
    _rectangle = intersection(rectangle, glm::ivec4(glm::floor(_window)));
    if (_scissored)
        _rectangle = intersection(_rectangle, {_scissor[0], _scissor[1], _scissor[2], _scissor[3]});
    if (_rectangle[2] <= 0 || _rectangle[3] <= 0) return false;
    // One texel more on each side, for pixels between the outermost rays and the edge.
    const glm::vec2 scale(_toWindow), offset(_toWindow.z, _toWindow.w);
    const glm::vec4 pixels = ends(_rectangle);
    const glm::ivec2 first = glm::ivec2(glm::floor((glm::vec2(pixels) - offset) / scale)) - 1;
    const glm::ivec2 last =
        glm::ivec2(glm::floor((glm::vec2(pixels.z, pixels.w) + 1.0f - offset) / scale)) + 1;
    _texels = glm::ivec4(glm::max(first, glm::ivec2(0)), glm::min(last, _size - 1));

    _scope.redirect(_resources.part<CoarseBuffers>().target.framebuffer);
    glViewport(0, 0, _size.x, _size.y);
    glEnable(GL_SCISSOR_TEST);
    glScissor(_texels.x, _texels.y, _texels.z - _texels.x + 1, _texels.w - _texels.y + 1);
    clear();
    uniforms.set("imageToWindow", _toWindow);
    uniforms.set("windowEnds", pixels);
    return true;
}

void CoarseImage::end()
{
    CoarseBuffers& coarse = _resources.part<CoarseBuffers>();
    const AccumulationBuffers& buffers = _resources.part<AccumulationBuffers>();
    _scope.drawOver();
    glViewport(_viewport[0], _viewport[1], _viewport[2], _viewport[3]);
    glDisable(GL_SCISSOR_TEST);
    if (!coarse.program) coarse.program = makeFillProgram();
    _state.applyAttribute(coarse.program.get());
    if (const auto* program = _state.getLastAppliedProgramObject()) {
        const Uniforms uniforms(*_state.get<osg::GLExtensions>(), *program);
        uniforms.set("image", int(UNIT_COARSE));
        uniforms.set("opaqueDepth", int(UNIT_OPAQUE_DEPTH));
        uniforms.set("hasOpaqueDepth", buffers.hasOpaqueDepth ? 1 : 0);
        uniforms.set("imageToWindow", _toWindow);
        uniforms.set("windowEnds", ends(_rectangle));
        uniforms.set("imageEnds", glm::vec4(_texels));
        _state.applyTextureAttribute(UNIT_COARSE, coarse.target.color.get());
        drawScreen(_state, _resources, _rectangle);
    }
    _scope.applyProgram();
}

void setOneRayPerPixel(const Uniforms& uniforms, const glm::dvec4& viewport)
{
    uniforms.set("imageToWindow", glm::vec4(1.0f, 1.0f, 0.0f, 0.0f));
    uniforms.set("windowEnds", ends(glm::ivec4(viewport)));
}

} // namespace render
} // namespace osgVolumizer
