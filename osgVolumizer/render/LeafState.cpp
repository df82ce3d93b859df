#include "LeafState.h"

#include <osg/ColorMask>

#include <algorithm>
#include <vector>

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
                                         StateAttribute::Type type)
{
    const StateAttribute* attribute = nullptr;
    bool overridden = false;
    for (const osg::StateSet* set : pathOf(graph)) {
        const auto* pair = set->getAttributePair(type);
        if (!pair || (overridden && !(pair->second & StateAttribute::PROTECTED))) continue;
        attribute = pair->first.get();
        overridden = (pair->second & StateAttribute::OVERRIDE) != 0;
    }
    return attribute;
}

bool isOn(const osgUtil::StateGraph* graph, GLenum mode, bool byDefault)
{
    bool on = byDefault, overridden = false;
    for (const osg::StateSet* set : pathOf(graph)) {
        const StateAttribute::GLModeValue value = set->getMode(mode);
        if (value & StateAttribute::INHERIT) continue;
        if (overridden && !(value & StateAttribute::PROTECTED)) continue;
        on = (value & StateAttribute::ON) != 0;
        overridden = (value & StateAttribute::OVERRIDE) != 0;
    }
    return on;
}

namespace {

// Whether an attribute of a type holds against those set further down.
bool isOverridden(const osgUtil::StateGraph* graph, StateAttribute::Type type)
{
    for (; graph; graph = graph->_parent) {
        if (!graph->getStateSet()) continue;
        const auto* pair = graph->getStateSet()->getAttributePair(type);
        if (pair && (pair->second & StateAttribute::OVERRIDE)) return true;
    }
    return false;
}

} // namespace

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

StateAbove stateAbove(const osgUtil::StateGraph* graph)
{
    StateAbove state;
    if (const auto* depth = effective<osg::Depth>(graph, StateAttribute::DEPTH))
        state.depthTest = {depth->getFunction(), depth->getZNear(), depth->getZFar()};
    if (!isDepthTested(graph)) state.depthTest.function = osg::Depth::ALWAYS;
    state.stencilTested = isOn(graph, GL_STENCIL_TEST, false);
    state.allChannels = writesAllChannels(graph);
    state.blendOverridden = isOverridden(graph, StateAttribute::BLENDFUNC) ||
                            isOverridden(graph, StateAttribute::BLENDEQUATION);
    return state;
}

} // namespace render
} // namespace osgVolumizer
