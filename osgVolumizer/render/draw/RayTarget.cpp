#include "RayTarget.h"

#include "../context/ContextResources.h"
#include "../context/ProgramInterface.h"
#include "../context/ReportOnce.h"
#include "../context/ScreenPass.h"
#include "../context/Uniforms.h"
#include "RayBuffers.h"
#include "RayFunctions.h"
#include "VolumeProgram.h"

#include <osg/BlendEquation>
#include <osg/BlendFunc>

#include <algorithm>

namespace osgVolumizer {
namespace render {

namespace {

constexpr unsigned UNIT_RAYS = UNIT_VOXELS;

} // namespace

RayTarget::RayTarget(osg::State& state, ContextResources& resources,
                     const ProgramFeatures& features, const glm::ivec4& viewport)
    : _state(state), _gl(*state.get<osg::GLExtensions>()), _resources(resources),
      _features(features), _viewport(viewport), _scope(state)
{
    _made = _resources.part<RayBuffers>().target.ensure(
        _state, std::max(_viewport.x + _viewport.z, 1), std::max(_viewport.y + _viewport.w, 1));
    if (!_made) {
        reportOnce({ErrorCode::NOT_SUPPORTED, "the card has no memory for gathered values; volumes "
                                              "with such ray functions are not drawn"});
        return;
    }
    _scope.redirect(_resources.part<RayBuffers>().target.framebuffer);
    const RayFunctionRow& row = rowOf(_features.rayFunction);
    GLfloat clearColor[4];
    glGetFloatv(GL_COLOR_CLEAR_VALUE, clearColor);
    const GLboolean scissor = glIsEnabled(GL_SCISSOR_TEST);
    glDisable(GL_SCISSOR_TEST);
    glClearColor(row.emptyValue, row.emptyValue, row.emptyValue, row.emptyValue);
    glClear(GL_COLOR_BUFFER_BIT);
    glClearColor(clearColor[0], clearColor[1], clearColor[2], clearColor[3]);
    if (scissor) glEnable(GL_SCISSOR_TEST);
    glEnable(GL_BLEND);
    _gl.glBlendEquation(row.blendEquation);
    glBlendFunc(GL_ONE, GL_ONE);
}

void RayTarget::resolve(const VolumeLook& look)
{
    _scope.drawOver();
    osg::ref_ptr<osg::Program>& resolving =
        _resources.part<RayBuffers>().programs[{_features.rayFunction, _features.rgba}];
    if (!resolving) resolving = makeResolveProgram(_features.rayFunction, _features.rgba);
    _state.applyAttribute(resolving.get());
    const auto* program = _state.getLastAppliedProgramObject();
    if (!program) return;
    const Uniforms uniforms(_gl, *program);
    uniforms.set("rays", int(UNIT_RAYS));
    uniforms.set("fogColor", look.fog.color);
    uniforms.set("fogShare", look.features.fog ? look.fog.share(look.referenceDepth) : 1.0f);
    _state.applyTextureAttribute(UNIT_RAYS, _resources.part<RayBuffers>().target.color.get());
    if (!_features.rgba) {
        uniforms.set("lookupTable", int(UNIT_TABLE));
        uniforms.set("valueToEntry", look.valueToEntry);
        uniforms.set("lastEntry", static_cast<float>(look.table.count - 1));
        _state.applyTextureAttribute(UNIT_TABLE, look.table.texture.get());
    }
    drawScreen(_state, _resources, _viewport);
}

} // namespace render
} // namespace osgVolumizer
