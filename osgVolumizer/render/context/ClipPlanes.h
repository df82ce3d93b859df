#pragma once

#include "../../core/geometry/Box.h"

#include <osg/Matrixd>
#include <osg/Vec4d>

#include <vector>

namespace osgUtil {
class RenderStage;
class StateGraph;
} // namespace osgUtil

namespace osgVolumizer {
namespace render {

/// A plane in a frame from which `toPlane` leads to the plane's own; its normal has length 1.
core::Plane transformedPlane(const osg::Vec4d& plane, const osg::Matrixd& toPlane);

/// What osg::ClipPlanes leave of what is drawn under a graph: the planes whose modes are on, in a
/// frame. Those of a ClipNode have their place in the stage; those of a state set are of the leaf's
/// frame. Where a mode is on without a plane, OpenGL's own cuts nothing.
std::vector<core::Plane> clipPlanesOf(const osgUtil::StateGraph* graph, osgUtil::RenderStage& stage,
                                      const osg::Matrixd& frameToLeaf,
                                      const osg::Matrixd& frameToEye);

} // namespace render
} // namespace osgVolumizer
