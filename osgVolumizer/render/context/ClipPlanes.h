#pragma once

#include "../../core/geometry/Box.h"

#include <osg/Matrixd>

#include <vector>

namespace osgUtil {
class RenderStage;
class StateGraph;
} // namespace osgUtil

namespace osgVolumizer {
namespace render {

/// What osg::ClipPlanes leave of what is drawn under a graph: the planes whose modes are on, in the
/// frame of a leaf. Those of a ClipNode have their place in the stage; those of a state set are of
/// the leaf's frame. Where a mode is on without a plane, OpenGL's own cuts nothing.
std::vector<core::Plane> clipPlanesOf(const osgUtil::StateGraph* graph, osgUtil::RenderStage& stage,
                                      const osg::Matrixd& leafToEye);

} // namespace render
} // namespace osgVolumizer
