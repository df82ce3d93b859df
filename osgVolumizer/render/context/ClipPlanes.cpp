#include "ClipPlanes.h"

#include "LeafState.h"
#include "PositionedAttributes.h"

#include <osg/ClipPlane>

#include <glm/geometric.hpp>

#include <map>

namespace osgVolumizer {
namespace render {

core::Plane transformedPlane(const osg::Vec4d& plane, const osg::Matrixd& toPlane)
{
    double v[4];
    for (int row = 0; row < 4; ++row)
        v[row] = toPlane(row, 0) * plane[0] + toPlane(row, 1) * plane[1] +
                 toPlane(row, 2) * plane[2] + toPlane(row, 3) * plane[3];
    core::Plane result;
    result.normal = {v[0], v[1], v[2]};
    result.offset = v[3];
    const double length = glm::length(result.normal);
    if (length > 0.0) {
        result.normal /= length;
        result.offset /= length;
    }
    return result;
}

std::vector<core::Plane> clipPlanesOf(const osgUtil::StateGraph* graph, osgUtil::RenderStage& stage,
                                      const osg::Matrixd& frameToLeaf,
                                      const osg::Matrixd& frameToEye)
{
    std::map<unsigned, core::Plane> byNumber;
    for (const auto& positioned : positionedAttributes<osg::ClipPlane>(stage))
        byNumber[positioned.first->getClipPlaneNum()] =
            transformedPlane(positioned.first->getClipPlane(),
                             frameToEye * osg::Matrixd::inverse(positioned.second));
    for (const auto* plane : effectiveClipPlanes(graph))
        byNumber[plane->getClipPlaneNum()] = transformedPlane(plane->getClipPlane(), frameToLeaf);
    std::vector<core::Plane> planes;
    for (const auto& plane : byNumber)
        if (isOn(graph, GL_CLIP_PLANE0 + plane.first, false)) planes.push_back(plane.second);
    return planes;
}

} // namespace render
} // namespace osgVolumizer
