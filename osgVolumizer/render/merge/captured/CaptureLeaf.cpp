#include "CaptureLeaf.h"

#include "../../context/ForeignState.h"
#include "../../context/ProgramInterface.h"
#include "../../context/ScreenPass.h"
#include "../../context/SharedStateSets.h"
#include "../../context/Uniforms.h"

#include <osg/Depth>
#include <osg/Stencil>

#include <algorithm>
#include <string>

namespace osgVolumizer {
namespace render {

namespace {

// Comparators of a sorting network for n elements (Batcher; Knuth, TAOCP 3, algorithm 5.2.2 M).
std::string sortingNetwork(int n)
{
    std::string code;
    int top = 1;
    while (2 * top < n)
        top *= 2;
    for (int p = top; p > 0; p /= 2) {
        int q = top, r = 0;
        for (int d = p; d > 0; d = q - p, q /= 2, r = p)
            for (int i = 0; i + d < n; ++i)
                if ((i & p) == r)
                    code += "    order(d[" + std::to_string(i) + "], d[" + std::to_string(i + d) +
                            "], id[" + std::to_string(i) + "], id[" + std::to_string(i + d) +
                            "]);\n";
    }
    return code;
}

// Straight-line code, so that a pixel's fragments stay in registers.
std::string sortCode(int slots)
{
    std::string code =
        "#define SLOTS " + std::to_string(slots) + "\nlayout(location = 0) out vec4 sorted[" +
        std::to_string(sortedTextures(slots)) +
        "];\n"
        "void order(inout float d0, inout float d1, inout float id0, inout float id1)\n{\n"
        "    // Of equal depths the later is nearer.\n"
        "    bool swap = d0 > d1 || (d0 == d1 && id0 < id1);\n"
        "    float d = d0, id = id0;\n"
        "    d0 = swap ? d1 : d0;\n    d1 = swap ? d : d1;\n"
        "    id0 = swap ? id1 : id0;\n    id1 = swap ? id : id1;\n}\n"
        "void sortAndStore(float d[SLOTS], float id[SLOTS])\n{\n" +
        sortingNetwork(slots);
    const auto element = [](const char* name, int i) {
        return std::string(name) + "[" + std::to_string(i) + "]";
    };
    for (int i = 0; i < slots; i += 4)
        code += "    sorted[" + std::to_string(i / 4) + "] = vec4(" + element("d", i) + ", " +
                element("d", i + 1) + ", " + element("d", i + 2) + ", " + element("d", i + 3) +
                ");\n";
    for (int i = 0; i < slots; i += 4) {
        const std::string out = "sorted[" + std::to_string(slots / 4 + i / 16) + "]";
        if (i % 16 == 0) code += "    " + out + " = vec4(0.0);\n";
        code += "    " + out + "[" + std::to_string(i / 4 % 4) + "] = " + element("id", i) +
                " + 32.0 * (" + element("id", i + 1) + " + 32.0 * (" + element("id", i + 2) +
                " + 32.0 * " + element("id", i + 3) + "));\n";
    }
    return code + "}\n";
}

osg::ref_ptr<osg::StateSet> withUnits(osg::ref_ptr<osg::StateSet> set)
{
    set->addUniform(new osg::Uniform(uniformName("slotDepths").c_str(), int(UNIT_FIRST_CAPTURED)));
    set->addUniform(new osg::Uniform(uniformName("opaqueDepth").c_str(), int(UNIT_OPAQUE_DEPTH)));
    set->addUniform(new osg::Uniform(uniformName("sortedSlots").c_str(), int(UNIT_SORTED_FAR)));
    return set;
}

std::uint64_t key(SharedState first, int number)
{
    return static_cast<std::uint64_t>(first) + static_cast<std::uint64_t>(number);
}

} // namespace

CaptureLeaf::CaptureLeaf(Accumulation* accumulation, const Settings& settings)
    : SortingLeaf(accumulation, settings.area), _settings(settings)
{
}

osg::Object* CaptureLeaf::cloneType() const
{
    return new CaptureLeaf(nullptr, Settings());
}

osg::ref_ptr<osg::StateSet> CaptureLeaf::stateSet(const Settings& settings)
{
    switch (settings.step) {
    case SORT:
        return sharedStateSet(key(SharedState::SORT_SLOTS, settings.slotCount), [&settings]() {
            return withUnits(
                screenState("sortslots.frag.glsl", false, sortCode(settings.slotCount)));
        });
    case WRITE_DEPTH:
        return sharedStateSet(SharedState::NEAREST_SLOT, []() {
            const auto set = withUnits(screenState("nearestslot.frag.glsl", true));
            set->setAttributeAndModes(new osg::Depth(osg::Depth::LESS, 0.0, 1.0, true), FORCE_ON);
            return set;
        });
    case BEGIN_REST:
        return sharedStateSet(SharedState::FILL_REST, []() {
            return withUnits(screenState("fillopaque.frag.glsl", true));
        });
    default:
        break;
    }
    return clearState();
}

CaptureBuffers* CaptureLeaf::buffersIn(osg::State& state) const
{
    ContextResources& resources = *contextResources(state);
    CaptureBuffers& buffers = resources.part<CaptureBuffers>();
    const bool made =
        _accumulation->hasTarget() &&
        ensureCapture(state, resources.part<AccumulationBuffers>(), buffers, _settings.slotCount);
    _accumulation->bindTarget(state);
    return made ? &buffers : nullptr;
}

void CaptureLeaf::drawImplementation(osg::RenderInfo& renderInfo) const
{
    if (!_accumulation) return;
    osg::State& state = *renderInfo.getState();
    const CaptureBuffers* buffers = buffersIn(state);
    if (!buffers) {
        drawWithout(state, Refusal::CAPTURED_SURFACES,
                    "the card has no memory for captured surfaces; those in volumes are sorted "
                    "rank by rank, which takes longer",
                    _settings.step == BEGIN_SLOT ||
                        (_settings.step == BEGIN_REST && !_accumulation->hasPlainTarget()));
        return;
    }
    draw(state, *buffers);
    reapplyInNextFrame(state);
    for (unsigned unit = UNIT_OPAQUE_DEPTH; unit <= UNIT_FIRST_CAPTURED; ++unit)
        state.haveAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE);
}

void CaptureLeaf::draw(osg::State& state, const CaptureBuffers& buffers) const
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    ContextResources& resources = *contextResources(state);
    AccumulationBuffers& target = resources.part<AccumulationBuffers>();
    const int slot = _settings.slot;
    switch (_settings.step) {
    case BEGIN_SLOT:
        bindFramebuffer(state, buffers.framebuffers[slot]);
        clearArea(_area, GL_DEPTH_BUFFER_BIT | GL_STENCIL_BUFFER_BIT);
        if (_settings.conditional)
            gl.glBeginConditionalRender(buffers.queries[slot - 1], WAIT_FOR_QUERY);
        gl.glBeginQuery(GL_SAMPLES_PASSED_ARB, buffers.queries[slot]);
        break;
    case END_SLOT:
        gl.glEndQuery(GL_SAMPLES_PASSED_ARB);
        if (_settings.conditional) gl.glEndConditionalRender();
        break;
    case SORT:
        sort(state, buffers);
        break;
    case WRITE_DEPTH:
        state.applyTextureAttribute(UNIT_SORTED_FAR, buffers.sorted);
        drawScreen(state, resources, _area);
        break;
    case BEGIN_REST:
        gl.glBeginConditionalRender(buffers.queries[slot], WAIT_FOR_QUERY);
        bindFramebuffer(state, buffers.restFramebuffer);
        clearArea(_area, GL_STENCIL_BUFFER_BIT);
        state.applyTextureAttribute(UNIT_OPAQUE_DEPTH, target.opaqueDepth);
        drawScreen(state, resources, _area);
        break;
    case END_REST:
        gl.glEndConditionalRender();
        _accumulation->bindTarget(state);
        break;
    }
}

// From the slots to what the volume's shader reads.
void CaptureLeaf::sort(osg::State& state, const CaptureBuffers& buffers) const
{
    ContextResources& resources = *contextResources(state);
    AccumulationBuffers& target = resources.part<AccumulationBuffers>();
    bindFramebuffer(state, buffers.sortedFramebuffer);
    state.applyTextureAttribute(UNIT_FIRST_CAPTURED, buffers.depths);
    state.applyTextureAttribute(UNIT_OPAQUE_DEPTH, target.opaqueDepth);
    drawScreen(state, resources, _area);
    target.sortedSurfaces[0] = buffers.sorted;
    target.sortedSurfaces[1] = buffers.colors;
    _accumulation->bindTarget(state);
}

osg::ref_ptr<osg::StateSet> captureState(int fragment)
{
    return sharedStateSet(key(SharedState::CAPTURED_SURFACES, fragment), [fragment]() {
        osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
        set->setAttributeAndModes(countingStencil(osg::Stencil::EQUAL, fragment), FORCE_ON);
        set->setAttributeAndModes(new osg::Depth(osg::Depth::ALWAYS, 0.0, 1.0, true), FORCE_ON);
        set->setMode(GL_BLEND, FORCE_OFF);
        return set;
    });
}

osg::ref_ptr<osg::StateSet> captureRestState(int fragments)
{
    return sharedStateSet(key(SharedState::REST_SURFACES, fragments), [fragments]() {
        osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
        // Passes where the count has come this far.
        set->setAttributeAndModes(countingStencil(osg::Stencil::LEQUAL, fragments), FORCE_ON);
        set->setAttributeAndModes(new osg::Depth(osg::Depth::LESS, 0.0, 1.0, false), FORCE_ON);
        return set;
    });
}

} // namespace render
} // namespace osgVolumizer
