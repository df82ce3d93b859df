#include "RankLeaf.h"

#include "../context/ContextRefusals.h"
#include "../context/ForeignState.h"
#include "../context/ProgramInterface.h"
#include "../context/ReportOnce.h"
#include "../context/ScreenPass.h"
#include "../context/SharedStateSets.h"
#include "../context/Uniforms.h"
#include "../draw/VolumeProgram.h"

#include <osg/ColorMask>
#include <osg/Depth>
#include <osg/Stencil>

#include <string>

namespace osgVolumizer {
namespace render {

namespace {

using osg::StateAttribute;

osg::ref_ptr<osg::StateSet> layerScreenState(const char* fragment, bool writeDepth)
{
    osg::ref_ptr<osg::StateSet> set = screenState(fragment, writeDepth);
    for (int k = 0; k < RankLeaf::LAYER_COUNT; ++k)
        set->addUniform(new osg::Uniform(uniformName("layer" + std::to_string(k)).c_str(),
                                         int(UNIT_FIRST_LAYER) + k));
    set->addUniform(new osg::Uniform(uniformName("opaqueDepth").c_str(), int(UNIT_OPAQUE_DEPTH)));
    set->addUniform(new osg::Uniform(uniformName("sortedFar").c_str(), int(UNIT_SORTED_FAR)));
    set->addUniform(new osg::Uniform(uniformName("sortedNear").c_str(), int(UNIT_SORTED_NEAR)));
    return set;
}

} // namespace

RankLeaf::RankLeaf(Accumulation* accumulation, Step step, int index, const glm::ivec4& area)
    : _accumulation(accumulation), _step(step), _index(index), _area(area)
{
    setSupportsDisplayList(false);
    setUseDisplayList(false);
    setUseVertexBufferObjects(false);
    setDataVariance(osg::Object::STATIC);
}

osg::Object* RankLeaf::cloneType() const
{
    return new RankLeaf(nullptr, SORT, 0, glm::ivec4(0));
}

osg::ref_ptr<osg::StateSet> RankLeaf::stateSet(Step step)
{
    if (step == SORT)
        return sharedStateSet(SharedState::SORT,
                              []() { return layerScreenState("sort.frag.glsl", false); });
    if (step == BEGIN_RANK || step == BEGIN_REST)
        return sharedStateSet(SharedState::FILL,
                              []() { return layerScreenState("fill.frag.glsl", true); });
    return clearState();
}

// In the frame that finds that the card has no memory for layers, surfaces are drawn after the
// volumes.
void RankLeaf::drawWithout(osg::State& state) const
{
    reportOnce({ErrorCode::NOT_SUPPORTED, "the card has no memory for layers of surfaces; those "
                                          "in volumes are sorted by intervals of depth"});
    refuse(state.getContextID(), Refusal::RANKED_SURFACES);
    const bool begins = _step == BEGIN_CAPTURE || _step == BEGIN_RANK ||
                        (_step == BEGIN_REST && !_accumulation->hasPlainTarget());
    if (begins)
        glEnable(GL_RASTERIZER_DISCARD);
    else
        glDisable(GL_RASTERIZER_DISCARD);
}

void RankLeaf::drawImplementation(osg::RenderInfo& renderInfo) const
{
    if (!_accumulation) return;
    osg::State& state = *renderInfo.getState();
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const std::shared_ptr<ContextResources> resources = contextResources(state);
    LayerBuffers* made = _accumulation->layerBuffers(state);
    if (!made) {
        drawWithout(state);
        return;
    }
    const LayerBuffers& layers = *made;
    switch (_step) {
    case BEGIN_CAPTURE:
        bindFramebuffer(state, layers.layerFramebuffers[_index]);
        clearArea(_area, GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
        if (_index > 0) gl.glBeginConditionalRender(layers.queries[_index - 1], WAIT_FOR_QUERY);
        gl.glBeginQuery(GL_SAMPLES_PASSED_ARB, layers.queries[_index]);
        break;
    case END_CAPTURE:
        gl.glEndQuery(GL_SAMPLES_PASSED_ARB);
        if (_index > 0) gl.glEndConditionalRender();
        break;
    case SORT:
        bindFramebuffer(state, layers.sortedFramebuffer);
        for (int k = 0; k < LAYER_COUNT; ++k)
            state.applyTextureAttribute(UNIT_FIRST_LAYER + static_cast<unsigned>(k),
                                        layers.layers[k]);
        state.applyTextureAttribute(UNIT_OPAQUE_DEPTH, resources->accumulation.opaqueDepth);
        drawScreen(state, *resources, _area);
        _accumulation->bindTarget(state);
        break;
    case BEGIN_SEGMENT:
        _accumulation->bindTarget(state);
        if (_index > 0) gl.glBeginConditionalRender(layers.queries[_index - 1], WAIT_FOR_QUERY);
        break;
    case BEGIN_RANK:
    case BEGIN_REST:
        bindFramebuffer(state, layers.rankFramebuffer);
        if (_step == BEGIN_REST) clearArea(_area, GL_STENCIL_BUFFER_BIT);
        gl.glBeginConditionalRender(layers.queries[_index], WAIT_FOR_QUERY);
        state.applyTextureAttribute(UNIT_SORTED_FAR, layers.sorted[0]);
        state.applyTextureAttribute(UNIT_SORTED_NEAR, layers.sorted[1]);
        state.applyTextureAttribute(UNIT_OPAQUE_DEPTH, resources->accumulation.opaqueDepth);
        setUniform(state, "rank", _step == BEGIN_REST ? -1 : _index);
        drawScreen(state, *resources, _area);
        break;
    case END_SEGMENT:
        if (_index > 0) gl.glEndConditionalRender();
        break;
    case END_RANK:
    case END_REST:
        gl.glEndConditionalRender();
        _accumulation->bindTarget(state);
        break;
    case DEPTH:
        break;
    }
    reapplyInNextFrame(state);
    for (unsigned unit = UNIT_OPAQUE_DEPTH; unit < UNIT_FIRST_LAYER + LAYER_COUNT; ++unit)
        state.haveAppliedTextureAttribute(unit, StateAttribute::TEXTURE);
}

namespace {

osg::ref_ptr<osg::StateSet> makeSurfaceState(RankLeaf::Step step, int index)
{
    osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
    if (step == RankLeaf::BEGIN_CAPTURE || step == RankLeaf::DEPTH)
        set->setAttribute(new osg::ColorMask(false, false, false, false), FORCE_ON);
    if (step == RankLeaf::DEPTH) return set;
    const auto stencil = [&set](osg::Stencil::Function function, int reference) {
        set->setAttributeAndModes(countingStencil(function, reference), FORCE_ON);
    };
    osg::Depth::Function function = osg::Depth::EQUAL;
    if (step == RankLeaf::BEGIN_CAPTURE) {
        function = osg::Depth::ALWAYS;
        stencil(osg::Stencil::EQUAL, index);
    } else if (step == RankLeaf::BEGIN_REST) {
        function = osg::Depth::LESS;
        stencil(osg::Stencil::LEQUAL,
                RankLeaf::LAYER_COUNT); // passes where the count has come this far
    }
    // True depths, whatever range the leaf asks for: the volume is compared with them.
    set->setAttributeAndModes(new osg::Depth(function, 0.0, 1.0, step == RankLeaf::BEGIN_CAPTURE),
                              FORCE_ON);
    return set;
}

} // namespace

osg::ref_ptr<osg::StateSet> layerSurfaceState(RankLeaf::Step step, int index)
{
    // All ranks are drawn alike.
    const int distinct = step == RankLeaf::BEGIN_CAPTURE ? index : RankLeaf::LAYER_COUNT + step;
    const auto key =
        static_cast<std::uint64_t>(SharedState::LAYER_SURFACES) + std::uint64_t(distinct);
    return sharedStateSet(key, [step, index]() { return makeSurfaceState(step, index); });
}

} // namespace render
} // namespace osgVolumizer
