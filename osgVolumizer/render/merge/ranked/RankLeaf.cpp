#include "RankLeaf.h"

#include "../../context/ForeignState.h"
#include "../../context/ProgramInterface.h"
#include "../../context/ScreenPass.h"
#include "../../context/SharedStateSets.h"
#include "../../context/Uniforms.h"

#include <osg/ColorMask>
#include <osg/Depth>
#include <osg/Stencil>

#include <string>

namespace osgVolumizer {
namespace render {

namespace {

using osg::StateAttribute;

osg::ref_ptr<osg::StateSet> rankScreenState(const char* fragment, bool writeDepth)
{
    osg::ref_ptr<osg::StateSet> set = screenState(fragment, writeDepth);
    for (int k = 0; k < RankLeaf::RANK_COUNT; ++k)
        set->addUniform(new osg::Uniform(uniformName("depths" + std::to_string(k)).c_str(),
                                         int(UNIT_FIRST_CAPTURED) + k));
    set->addUniform(new osg::Uniform(uniformName("opaqueDepth").c_str(), int(UNIT_OPAQUE_DEPTH)));
    set->addUniform(new osg::Uniform(uniformName("sortedFar").c_str(), int(UNIT_SORTED_FAR)));
    set->addUniform(new osg::Uniform(uniformName("sortedNear").c_str(), int(UNIT_SORTED_NEAR)));
    return set;
}

} // namespace

RankLeaf::RankLeaf(Accumulation* accumulation, Step step, int index, const glm::ivec4& area)
    : SortingLeaf(accumulation, area), _step(step), _index(index)
{
}

osg::Object* RankLeaf::cloneType() const
{
    return new RankLeaf(nullptr, SORT, 0, glm::ivec4(0));
}

osg::ref_ptr<osg::StateSet> RankLeaf::stateSet(Step step)
{
    if (step == SORT)
        return sharedStateSet(SharedState::SORT,
                              []() { return rankScreenState("sortranks.frag.glsl", false); });
    if (step == BEGIN_RANK || step == BEGIN_REST)
        return sharedStateSet(SharedState::FILL,
                              []() { return rankScreenState("fillrank.frag.glsl", true); });
    return clearState();
}

RankBuffers* RankLeaf::buffersIn(osg::State& state) const
{
    ContextResources& resources = *contextResources(state);
    RankBuffers& buffers = resources.part<RankBuffers>();
    const bool made = _accumulation->hasTarget() &&
                      ensureRanks(state, resources.part<AccumulationBuffers>(), buffers);
    _accumulation->bindTarget(state);
    return made ? &buffers : nullptr;
}

void RankLeaf::drawImplementation(osg::RenderInfo& renderInfo) const
{
    if (!_accumulation) return;
    osg::State& state = *renderInfo.getState();
    const RankBuffers* buffers = buffersIn(state);
    if (!buffers) {
        drawWithout(state, Refusal::RANKED_SURFACES,
                    "the card has no memory for ranks of surfaces; those in volumes are sorted by "
                    "intervals of depth",
                    _step == BEGIN_DEPTHS || _step == BEGIN_RANK ||
                        (_step == BEGIN_REST && !_accumulation->hasPlainTarget()));
        return;
    }
    draw(state, *buffers);
    reapplyInNextFrame(state);
    for (unsigned unit = UNIT_OPAQUE_DEPTH; unit < UNIT_FIRST_CAPTURED + RANK_COUNT; ++unit)
        state.haveAppliedTextureAttribute(unit, StateAttribute::TEXTURE);
}

void RankLeaf::draw(osg::State& state, const RankBuffers& buffers) const
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    switch (_step) {
    case BEGIN_DEPTHS:
        bindFramebuffer(state, buffers.framebuffers[_index]);
        clearArea(_area, GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
        if (_index > 0) gl.glBeginConditionalRender(buffers.queries[_index - 1], WAIT_FOR_QUERY);
        gl.glBeginQuery(GL_SAMPLES_PASSED_ARB, buffers.queries[_index]);
        break;
    case END_DEPTHS:
        gl.glEndQuery(GL_SAMPLES_PASSED_ARB);
        if (_index > 0) gl.glEndConditionalRender();
        break;
    case SORT:
        sort(state, buffers);
        break;
    case BEGIN_SEGMENT:
        _accumulation->bindTarget(state);
        if (_index > 0) gl.glBeginConditionalRender(buffers.queries[_index - 1], WAIT_FOR_QUERY);
        break;
    case BEGIN_RANK:
    case BEGIN_REST:
        fill(state, buffers);
        break;
    case END_SEGMENT:
        if (_index > 0) gl.glEndConditionalRender();
        break;
    case END_RANK:
    case END_REST:
        gl.glEndConditionalRender();
        _accumulation->bindTarget(state);
        break;
    }
}

// From the buffers to the two textures that volumes and fill() read.
void RankLeaf::sort(osg::State& state, const RankBuffers& buffers) const
{
    ContextResources& resources = *contextResources(state);
    AccumulationBuffers& target = resources.part<AccumulationBuffers>();
    bindFramebuffer(state, buffers.sortedFramebuffer);
    for (int k = 0; k < RANK_COUNT; ++k)
        state.applyTextureAttribute(UNIT_FIRST_CAPTURED + static_cast<unsigned>(k),
                                    buffers.depths[k]);
    state.applyTextureAttribute(UNIT_OPAQUE_DEPTH, target.opaqueDepth);
    drawScreen(state, resources, _area);
    for (int i = 0; i < 2; ++i)
        target.sortedSurfaces[i] = buffers.sorted[i];
    _accumulation->bindTarget(state);
}

// The depth that surfaces of this step are compared with.
void RankLeaf::fill(osg::State& state, const RankBuffers& buffers) const
{
    ContextResources& resources = *contextResources(state);
    bindFramebuffer(state, buffers.rankFramebuffer);
    if (_step == BEGIN_REST) clearArea(_area, GL_STENCIL_BUFFER_BIT);
    state.get<osg::GLExtensions>()->glBeginConditionalRender(buffers.queries[_index],
                                                             WAIT_FOR_QUERY);
    state.applyTextureAttribute(UNIT_SORTED_FAR, buffers.sorted[0]);
    state.applyTextureAttribute(UNIT_SORTED_NEAR, buffers.sorted[1]);
    state.applyTextureAttribute(UNIT_OPAQUE_DEPTH,
                                resources.part<AccumulationBuffers>().opaqueDepth);
    setUniform(state, "rank", _step == BEGIN_REST ? -1 : _index);
    drawScreen(state, resources, _area);
}

namespace {

osg::ref_ptr<osg::StateSet> makeSurfaceState(RankLeaf::Step step, int index)
{
    osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
    if (step == RankLeaf::BEGIN_DEPTHS)
        set->setAttribute(new osg::ColorMask(false, false, false, false), FORCE_ON);
    const auto stencil = [&set](osg::Stencil::Function function, int reference) {
        set->setAttributeAndModes(countingStencil(function, reference), FORCE_ON);
    };
    osg::Depth::Function function = osg::Depth::EQUAL;
    if (step == RankLeaf::BEGIN_DEPTHS) {
        function = osg::Depth::ALWAYS;
        stencil(osg::Stencil::EQUAL, index);
    } else if (step == RankLeaf::BEGIN_REST) {
        function = osg::Depth::LESS;
        stencil(osg::Stencil::LEQUAL,
                RankLeaf::RANK_COUNT); // passes where the count has come this far
    }
    // True depths, whatever range the leaf asks for: the volume is compared with them.
    set->setAttributeAndModes(new osg::Depth(function, 0.0, 1.0, step == RankLeaf::BEGIN_DEPTHS),
                              FORCE_ON);
    return set;
}

} // namespace

osg::ref_ptr<osg::StateSet> rankedSurfaceState(RankLeaf::Step step, int index)
{
    // All ranks are drawn alike.
    const int distinct = step == RankLeaf::BEGIN_DEPTHS ? index : RankLeaf::RANK_COUNT + step;
    const auto key =
        static_cast<std::uint64_t>(SharedState::RANKED_SURFACES) + std::uint64_t(distinct);
    return sharedStateSet(key, [step, index]() { return makeSurfaceState(step, index); });
}

} // namespace render
} // namespace osgVolumizer
