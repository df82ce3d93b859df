#pragma once

#include <osg/Camera>
#include <osg/FrameStamp>
#include <osg/Stats>
#include <osg/View>

namespace osgVolumizer {
namespace render {

/// The statistics of the camera or, where it has none of its own (a nested render-to-texture
/// camera), of the view; null where they are not asked for "osgVolumizer".
inline osg::Stats* collectingStats(const osg::Camera* camera)
{
    if (!camera) return nullptr;
    osg::Stats* stats = const_cast<osg::Camera*>(camera)->getStats();
    if (!stats && camera->getView() && camera->getView()->getCamera())
        stats = const_cast<osg::Camera*>(camera->getView()->getCamera())->getStats();
    return stats && stats->collectStats("osgVolumizer") ? stats : nullptr;
}

/// Adds to a counter of the frame in the statistics that collect it.
inline void count(const osg::Camera* camera, const osg::FrameStamp* frame, const char* name,
                  double amount)
{
    osg::Stats* stats = collectingStats(camera);
    if (!stats || !frame) return;
    double value = 0.0;
    stats->getAttribute(frame->getFrameNumber(), name, value);
    stats->setAttribute(frame->getFrameNumber(), name, value + amount);
}

} // namespace render
} // namespace osgVolumizer
