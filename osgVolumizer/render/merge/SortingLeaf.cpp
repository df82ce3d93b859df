#include "SortingLeaf.h"

#include "../context/ReportOnce.h"

namespace osgVolumizer {
namespace render {

SortingLeaf::SortingLeaf(Accumulation* accumulation, const glm::ivec4& area)
    : _accumulation(accumulation), _area(area)
{
    setSupportsDisplayList(false);
    setUseDisplayList(false);
    setUseVertexBufferObjects(false);
    setDataVariance(osg::Object::STATIC);
}

void SortingLeaf::drawWithout(osg::State& state, Refusal refusal, const std::string& message,
                              bool skips) const
{
    reportOnce({ErrorCode::NOT_SUPPORTED, message});
    refuse(state.getContextID(), refusal);
    contextResources(state)->part<AccumulationBuffers>().sortedSurfaces[0] = nullptr;
    if (skips)
        glEnable(GL_RASTERIZER_DISCARD);
    else
        glDisable(GL_RASTERIZER_DISCARD);
}

} // namespace render
} // namespace osgVolumizer
