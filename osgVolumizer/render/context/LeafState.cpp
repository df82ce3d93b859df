#include "LeafState.h"

#include "Matrices.h"
#include "ModeInForce.h"

#include <osg/ClipControl>
#include <osg/ColorMask>
#include <osg/DepthRangeIndexed>
#include <osg/Fog>
#include <osg/PolygonMode>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace osgVolumizer {
namespace render {

namespace {

using osg::StateAttribute;

// State sets from the root down.
std::vector<const osg::StateSet*> pathOf(const osgUtil::StateGraph* graph)
{
    std::vector<const osg::StateSet*> path;
    for (; graph; graph = graph->_parent)
        if (graph->getStateSet()) path.push_back(graph->getStateSet());
    std::reverse(path.begin(), path.end());
    return path;
}

} // namespace

const StateAttribute* effectiveAttribute(const osgUtil::StateGraph* graph,
                                         StateAttribute::Type type, unsigned member)
{
    const StateAttribute* attribute = nullptr;
    bool overridden = false;
    for (const osg::StateSet* set : pathOf(graph)) {
        const auto* pair = set->getAttributePair(type, member);
        if (!pair || (overridden && !(pair->second & StateAttribute::PROTECTED))) continue;
        attribute = pair->first.get();
        overridden = (pair->second & StateAttribute::OVERRIDE) != 0;
    }
    return attribute;
}

std::vector<const osg::ClipPlane*> effectiveClipPlanes(const osgUtil::StateGraph* graph)
{
    std::set<unsigned> numbers;
    for (const osg::StateSet* set : pathOf(graph))
        for (const auto& attribute : set->getAttributeList())
            if (attribute.first.first == StateAttribute::CLIPPLANE)
                numbers.insert(attribute.first.second);
    std::vector<const osg::ClipPlane*> planes;
    for (const unsigned number : numbers)
        if (const auto* plane = static_cast<const osg::ClipPlane*>(
                effectiveAttribute(graph, StateAttribute::CLIPPLANE, number)))
            planes.push_back(plane);
    return planes;
}

bool isOn(const osgUtil::StateGraph* graph, GLenum mode, bool byDefault)
{
    return isOn(pathOf(graph), mode, byDefault);
}

bool showsOutlines(const osgUtil::StateGraph* graph)
{
    const auto* mode = effective<osg::PolygonMode>(graph, StateAttribute::POLYGONMODE);
    return mode && (mode->getMode(osg::PolygonMode::FRONT) != osg::PolygonMode::FILL ||
                    mode->getMode(osg::PolygonMode::BACK) != osg::PolygonMode::FILL);
}

bool writesDepth(const osgUtil::StateGraph* graph)
{
    const auto* depth = effective<osg::Depth>(graph, StateAttribute::DEPTH);
    return isDepthTested(graph) && (!depth || depth->getWriteMask());
}

bool writesAllChannels(const osgUtil::StateGraph* graph)
{
    const auto* mask = effective<osg::ColorMask>(graph, StateAttribute::COLORMASK);
    return !mask || (mask->getRedMask() && mask->getGreenMask() && mask->getBlueMask() &&
                     mask->getAlphaMask());
}

namespace {

std::optional<FogAbove> fogAbove(const osgUtil::StateGraph* graph)
{
    constexpr double LOG2_E = 1.4426950408889634;
    const auto* fog = effective<osg::Fog>(graph, StateAttribute::FOG);
    if (!fog || !isOn(graph, GL_FOG, false)) return std::nullopt;
    // OpenGL refuses such.
    if (!(fog->getDensity() >= 0.0f) || !std::isfinite(fog->getDensity() + fog->getEnd()) ||
        !std::isfinite(fog->getStart()))
        return std::nullopt;
    FogAbove made;
    made.color = {fog->getColor().r(), fog->getColor().g(), fog->getColor().b()};
    const double density = static_cast<double>(fog->getDensity());
    const double start = static_cast<double>(fog->getStart());
    const double end = static_cast<double>(fog->getEnd());
    switch (fog->getMode()) {
    case osg::Fog::LINEAR:
        if (start == end) return std::nullopt; // undefined in OpenGL
        made.linear = true;
        made.rates = glm::vec3(end / (end - start), -1.0 / (end - start), 0.0);
        break;
    case osg::Fog::EXP:
        made.rates.y = static_cast<float>(density * LOG2_E);
        break;
    case osg::Fog::EXP2:
        made.rates.z = static_cast<float>(density * density * LOG2_E);
        break;
    }
    return made;
}

} // namespace

float FogAbove::share(double depth) const
{
    const double sum = glm::dot(glm::dvec3(rates), glm::dvec3(1.0, depth, depth * depth));
    return static_cast<float>(std::clamp(linear ? sum : std::exp2(-sum), 0.0, 1.0));
}

StateAbove stateAbove(const osgUtil::StateGraph* graph)
{
    StateAbove state;
    state.fog = fogAbove(graph);
    if (const auto* depth = effective<osg::Depth>(graph, StateAttribute::DEPTH))
        state.depthTest = {depth->getFunction(), depth->getZNear(), depth->getZFar()};
    if (const auto* range =
            effective<osg::DepthRangeIndexed>(graph, StateAttribute::DEPTHRANGEINDEXED)) {
        state.depthTest.zNear = range->getZNear();
        state.depthTest.zFar = range->getZFar();
    }
    if (!isDepthTested(graph)) state.depthTest.function = osg::Depth::ALWAYS;
    state.stencilTested = isOn(graph, GL_STENCIL_TEST, false);
    state.allChannels = writesAllChannels(graph);
    constexpr GLenum RASTERIZER_DISCARD = 0x8C89; // GL_RASTERIZER_DISCARD
    for (GLenum mode : {GLenum(GL_SCISSOR_TEST), GLenum(GL_POLYGON_STIPPLE), RASTERIZER_DISCARD})
        state.partly = state.partly || isOn(graph, mode, false);
    state.toUsualClip = toUsualClip(graph);
    return state;
}

glm::dmat4 toUsualClip(const osgUtil::StateGraph* graph)
{
    glm::dmat4 map(1.0);
    const auto* control = effective<osg::ClipControl>(graph, StateAttribute::CLIPCONTROL);
    if (!control) return map;
    if (control->getOrigin() == osg::ClipControl::UPPER_LEFT) map[1][1] = -1.0;
    if (control->getDepthMode() == osg::ClipControl::ZERO_TO_ONE) {
        map[2][2] = 2.0;
        map[3][2] = -1.0;
    }
    return map;
}

osg::Matrixd usualProjection(const osgUtil::RenderLeaf& leaf)
{
    return toOsg(toUsualClip(leaf._parent) * toGlm(*leaf._projection));
}

} // namespace render
} // namespace osgVolumizer
