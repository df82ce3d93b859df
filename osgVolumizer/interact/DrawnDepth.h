#pragma once

#include "Pick.h"

#include <osg/Camera>
#include <osg/ref_ptr>

#include <mutex>
#include <optional>

namespace osgVolumizer {

/// Reads the depth under a pixel out of the picture that a camera draws: what surfaces are there
/// then costs nothing, however many triangles they have. Volumes leave no depth; zpickDrawn() finds
/// them in front of it. Of no use for cameras that draw into several samples of a frame buffer
/// object. Thread safe.
class OSGVOLUMIZER_EXPORT DrawnDepth : public osg::Camera::DrawCallback
{
public:
    /// Adds one to the post-draw callbacks of a camera: before cameras that draw after it.
    static osg::ref_ptr<DrawnDepth> install(osg::Camera& camera);

    /// Asks for the depth under a pixel, as in zpick(): it is there once the next frame is drawn.
    void ask(double x, double y);
    /// The window depth, 0 to 1, that was read for the last pixel that was asked for; nothing as
    /// long as it is not there.
    std::optional<double> get() const;

    void operator()(osg::RenderInfo& renderInfo) const override;

private:
    mutable std::mutex _mutex; // of what follows
    mutable bool _asked = false;
    double _x = 0.0, _y = 0.0;
    mutable std::optional<double> _depth;
};

/// As zpick(), with the depth that was drawn in place of surfaces: found are a volume in front of
/// it, or the place of that depth, without a node; nothing where neither is. As long as the camera
/// stays as it was when that was drawn. VALUE_INVALID also for a depth outside [0, 1].
OSGVOLUMIZER_EXPORT Result<std::optional<PixelPick>> zpickDrawn(osg::Camera& camera, double x,
                                                                double y, double windowDepth,
                                                                osg::Node::NodeMask mask = ~0u);

} // namespace osgVolumizer
