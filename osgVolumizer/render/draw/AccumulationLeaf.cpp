#include "AccumulationLeaf.h"

#include "../context/ForeignState.h"
#include "../context/ProgramInterface.h"
#include "../context/ScreenPass.h"
#include "../context/SharedStateSets.h"
#include "../context/Uniforms.h"
#include "VolumeProgram.h"

#include <osgUtil/StateGraph>

namespace osgVolumizer {
namespace render {

namespace {

// Of the leaf that ends accumulation: writes depth.
osg::ref_ptr<osg::StateSet> depthStateSet()
{
    return sharedStateSet(SharedState::DEPTH, []() {
        osg::ref_ptr<osg::StateSet> set = screenState("depth.frag.glsl", true);
        set->addUniform(
            new osg::Uniform(uniformName("opaqueDepth").c_str(), int(UNIT_OPAQUE_DEPTH)));
        set->addUniform(
            new osg::Uniform(uniformName("targetDepth").c_str(), int(UNIT_SPLIT_DEPTH)));
        return set;
    });
}

} // namespace

AccumulationLeaf::AccumulationLeaf(Accumulation* accumulation, Step step, const glm::ivec4& area)
    : _accumulation(accumulation), _step(step), _area(area)
{
    setSupportsDisplayList(false);
    setUseDisplayList(false);
    setUseVertexBufferObjects(false);
    setDataVariance(osg::Object::STATIC);
}

void AccumulationLeaf::drawImplementation(osg::RenderInfo& renderInfo) const
{
    if (!_accumulation) return;
    switch (_step) {
    case BEGIN:
        _accumulation->begin(renderInfo);
        break;
    case END:
        _accumulation->end(renderInfo);
        break;
    case BEGIN_SPLIT:
        _accumulation->beginSplit(renderInfo, _area);
        break;
    case END_SPLIT:
        _accumulation->endSplit(renderInfo);
        break;
    }
    reapplyInNextFrame(*renderInfo.getState());
}

osgUtil::RenderLeaf* accumulationLeaf(Accumulation& accumulation, AccumulationLeaf::Step step,
                                      const osgUtil::RenderLeaf& beside, const glm::ivec4& area)
{
    osg::ref_ptr<osgUtil::RenderLeaf> leaf = new osgUtil::RenderLeaf(
        new AccumulationLeaf(&accumulation, step, area), beside._projection, beside._modelview);
    const bool writesDepth = step == AccumulationLeaf::END && accumulation.isDepthKept();
    const osg::ref_ptr<osg::StateSet> set = writesDepth ? depthStateSet() : clearState();
    beside._parent->find_or_insert(set)->addLeaf(leaf);
    return leaf.get();
}

} // namespace render
} // namespace osgVolumizer
