#include "DrawnDepth.h"

#include "../render/context/ReadDepth.h"

#include <osg/RenderInfo>

namespace osgVolumizer {

osg::ref_ptr<DrawnDepth> DrawnDepth::install(osg::Camera& camera)
{
    osg::ref_ptr<DrawnDepth> made = new DrawnDepth;
    camera.addPostDrawCallback(made);
    return made;
}

void DrawnDepth::ask(double x, double y)
{
    std::lock_guard<std::mutex> lock(_mutex);
    _asked = true;
    _x = x;
    _y = y;
    _depth.reset();
}

std::optional<double> DrawnDepth::get() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    return _depth;
}

void DrawnDepth::operator()(osg::RenderInfo& renderInfo) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    if (!_asked) return;
    _asked = false;
    const osg::Camera* camera = renderInfo.getCurrentCamera();
    if (camera && camera->getViewport())
        _depth = render::readDepth(*renderInfo.getState(), *camera->getViewport(), _x, _y);
}

} // namespace osgVolumizer
