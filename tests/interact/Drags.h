#pragma once

// Drags by the events that a window would send, and by commands of a program.

#include <osgVolumizer/interact/VolumeHandles.h>

#include <osgManipulator/Command>
#include <osgManipulator/Dragger>
#include <osgViewer/Viewer>

#include <support/SceneRenderer.h>

namespace osgVolumizer {
namespace test {

/// A window without OpenGL, for its events.
class NoWindow : public osgViewer::GraphicsWindow
{
public:
    NoWindow(int width, int height)
    {
        _traits = new osg::GraphicsContext::Traits;
        _traits->width = width;
        _traits->height = height;
    }
    bool valid() const override { return true; }
    void closeImplementation() override {}
};

/// Gives a viewer a view that nothing is drawn of.
inline void lookWithoutWindow(osgViewer::Viewer& viewer, osg::Node* scene,
                              const support::RenderOptions& options)
{
    viewer.getCamera()->setGraphicsContext(new NoWindow(options.width, options.height));
    viewer.getCamera()->setViewport(0, 0, options.width, options.height);
    viewer.getCamera()->setViewMatrix(options.view);
    viewer.getCamera()->setProjectionMatrix(options.projection);
    viewer.setSceneData(scene);
}

/// A pointer over a viewer's camera.
class Pointer
{
public:
    explicit Pointer(osgViewer::Viewer& viewer) : _viewer(viewer) {}

    /// Presses the left button on a place of the world.
    bool press(const osg::Vec3d& world, int keys = 0)
    {
        return send(osgGA::GUIEventAdapter::PUSH, world, true, keys);
    }
    bool drag(const osg::Vec3d& world) { return send(osgGA::GUIEventAdapter::DRAG, world, true); }
    bool release(const osg::Vec3d& world)
    {
        return send(osgGA::GUIEventAdapter::RELEASE, world, false);
    }
    /// From press to release, by way of the middle. True where a handle was there.
    bool dragFromTo(const osg::Vec3d& from, const osg::Vec3d& to)
    {
        const bool handled = press(from);
        drag((from + to) * 0.5);
        drag(to);
        release(to);
        return handled;
    }

private:
    // As in ViewerBase::frame(), without drawing. True where somebody has handled it.
    bool send(osgGA::GUIEventAdapter::EventType type, const osg::Vec3d& world, bool down,
              int keys = 0)
    {
        osg::Camera& camera = *_viewer.getCamera();
        const osg::Vec3d clip = world * camera.getViewMatrix() * camera.getProjectionMatrix();
        osg::ref_ptr<osgGA::GUIEventAdapter> event = new osgGA::GUIEventAdapter;
        const float x = static_cast<float>(clip.x()), y = static_cast<float>(clip.y());
        event->setEventType(type);
        event->setTime(0.0);
        event->setInputRange(-1.0f, -1.0f, 1.0f, 1.0f);
        event->setX(x);
        event->setY(y);
        event->setButton(osgGA::GUIEventAdapter::LEFT_MOUSE_BUTTON);
        event->setButtonMask(down ? osgGA::GUIEventAdapter::LEFT_MOUSE_BUTTON : 0);
        event->setModKeyMask(keys);
        event->addPointerData(new osgGA::PointerData(&camera, x, -1.0f, 1.0f, y, -1.0f, 1.0f));
        _viewer.getEventQueue()->addEvent(event);
        _viewer.advance();
        _viewer.eventTraversal();
        _viewer.updateTraversal();
        return event->getHandled();
    }

    osgViewer::Viewer& _viewer;
};

/// A drag by commands alone, of a dragger without constraints. The motion is in its own frame.
inline void command(osgManipulator::Dragger& dragger, osgManipulator::MotionCommand& motion)
{
    osg::NodePath path;
    osgManipulator::computeNodePathToRoot(dragger, path);
    const osg::Matrixd toWorld = osg::computeLocalToWorld(path);
    motion.setLocalToWorldAndWorldToLocal(toWorld, osg::Matrixd::inverse(toWorld));
    for (const auto stage :
         {osgManipulator::MotionCommand::START, osgManipulator::MotionCommand::MOVE,
          osgManipulator::MotionCommand::FINISH}) {
        motion.setStage(stage);
        dragger.dispatch(motion);
    }
}

inline void translate(osgManipulator::Dragger& dragger, const osg::Vec3d& own)
{
    osg::ref_ptr<osgManipulator::TranslateInLineCommand> motion =
        new osgManipulator::TranslateInLineCommand(osg::Vec3d(), own);
    motion->setTranslation(own);
    command(dragger, *motion);
}

} // namespace test
} // namespace osgVolumizer
