#pragma once

#include <osg/Camera>
#include <osg/FrameStamp>
#include <osg/Stats>
#include <osg/View>

namespace osgVolumizer {
namespace render {

/// Adds to a counter of the frame in the statistics of the camera and, where it has none of its own
/// (a nested render-to-texture camera), of the view's. They collect it when asked for
/// "osgVolumizer".
inline void count(const osg::Camera* camera, const osg::FrameStamp* frame, const char* name,
                  double amount)
{
    if (!camera || !frame) return;
    osg::Stats* stats = const_cast<osg::Camera*>(camera)->getStats();
    if (!stats && camera->getView() && camera->getView()->getCamera())
        stats = const_cast<osg::Camera*>(camera->getView()->getCamera())->getStats();
    if (!stats || !stats->collectStats("osgVolumizer")) return;
    double value = 0.0;
    stats->getAttribute(frame->getFrameNumber(), name, value);
    stats->setAttribute(frame->getFrameNumber(), name, value + amount);
}

} // namespace render
} // namespace osgVolumizer
