#pragma once

#include <support/SceneRenderer.h>

#include <osgViewer/Viewer>

namespace osgVolumizer {
namespace test {

constexpr osgViewer::ViewerBase::ThreadingModel THREADING_MODELS[] = {
    osgViewer::ViewerBase::SingleThreaded, osgViewer::ViewerBase::CullDrawThreadPerContext,
    osgViewer::ViewerBase::DrawThreadPerContext,
    osgViewer::ViewerBase::CullThreadPerCameraDrawThreadPerContext};

/// Gives a viewer a second camera in a context of its own, which draws the same nodes. Draws a
/// frame, and then starts threads.
inline osg::ref_ptr<support::PictureTarget> addSecondContext(osgViewer::Viewer& viewer, int width,
                                                             int height)
{
    viewer.stopThreading();
    osg::ref_ptr<osg::Camera> slave = new osg::Camera;
    slave->setGraphicsContext(new support::SurfacelessGraphicsContext(width, height));
    slave->setProjectionResizePolicy(osg::Camera::FIXED);
    slave->setClearColor(osg::Vec4());
    osg::ref_ptr<support::PictureTarget> target = new support::PictureTarget(*slave, width, height);
    viewer.addSlave(slave, osg::Matrixd(), osg::Matrixd());
    viewer.realize();
    // In its first frame each of OSG's renderers sets the view's lighting mode in the state set
    // that all cameras of the view share, without a lock: no threads yet.
    viewer.stopThreading();
    viewer.frame(0.0);
    viewer.startThreading();
    return target;
}

} // namespace test
} // namespace osgVolumizer
