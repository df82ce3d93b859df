#include "VolumeHandles.h"

#include "../core/Text.h"
#include "private/HandleLook.h"
#include "private/HandlePointer.h"

#include <osgGA/EventVisitor>
#include <osgManipulator/Command>
#include <osgManipulator/Dragger>
#include <osgUtil/CullVisitor>
#include <osgViewer/View>

#include <vector>

namespace osgVolumizer {

/// Told of what a dragger does, by its own events or by commands of an application.
class VolumeHandles::Follower : public osgManipulator::DraggerCallback
{
public:
    Follower(VolumeHandles& handles, unsigned dragger) : _handles(&handles), _dragger(dragger) {}
    void forget() { _handles = nullptr; }

    using osgManipulator::DraggerCallback::receive;
    bool receive(const osgManipulator::MotionCommand& command) override
    {
        using osgManipulator::MotionCommand;
        if (!_handles) return false;
        if (command.getStage() == MotionCommand::START) _handles->started();
        if (command.getStage() == MotionCommand::MOVE) _handles->moved(_dragger);
        if (command.getStage() == MotionCommand::FINISH) _handles->finished();
        return command.getStage() != MotionCommand::NONE;
    }

private:
    VolumeHandles* _handles;
    unsigned _dragger;
};

struct VolumeHandles::Private
{
    struct Handle
    {
        osg::ref_ptr<osgManipulator::Dragger> dragger;
        osg::ref_ptr<Follower> follower;
    };

    HandleLook look;
    std::vector<Handle> handles;
    HandlePointer pointer;
    osg::ref_ptr<DragHistory> history;
    DragHistory::Restore before; // the drag under way
    bool dragged = false, changed = false;
};

VolumeHandles::VolumeHandles() : _private(new Private)
{
    setNumChildrenRequiringUpdateTraversal(1);
    setNumChildrenRequiringEventTraversal(1);
}

VolumeHandles::~VolumeHandles()
{
    for (const Private::Handle& handle : _private->handles) {
        handle.follower->forget();
        handle.dragger->removeDraggerCallback(handle.follower.get());
    }
}

void VolumeHandles::setHistory(DragHistory* history)
{
    _private->history = history;
}

DragHistory* VolumeHandles::getHistory() const
{
    return _private->history.get();
}

ReportedStatus VolumeHandles::setThroughOpacity(double opacity)
{
    if (!(opacity >= 0.0 && opacity <= 1.0))
        return reported({ErrorCode::VALUE_INVALID,
                         "handles: the opacity of what shows through is " +
                             core::formatNumber(opacity) + ", expected a number from 0 to 1"});
    _private->look.setThroughOpacity(opacity);
    return {};
}

double VolumeHandles::getThroughOpacity() const
{
    return _private->look.throughOpacity();
}

unsigned VolumeHandles::getNumDraggers() const
{
    return static_cast<unsigned>(_private->handles.size());
}

osgManipulator::Dragger* VolumeHandles::getDragger(unsigned number) const
{
    return number < getNumDraggers() ? _private->handles[number].dragger.get() : nullptr;
}

bool VolumeHandles::isDragged() const
{
    return _private->dragged;
}

void VolumeHandles::follow()
{
    place();
}

void VolumeHandles::addDragger(osgManipulator::Dragger* dragger)
{
    const osg::ref_ptr<Follower> follower = new Follower(*this, getNumDraggers());
    dragger->addDraggerCallback(follower.get());
    _private->handles.push_back({dragger, follower});
    addChild(dragger);
}

void VolumeHandles::started()
{
    finished(); // where OSG has sent no end of the last one
    _private->before = remember();
    _private->dragged = true;
}

void VolumeHandles::moved(unsigned dragger)
{
    if (move(dragger))
        _private->changed = true;
    else
        place();
}

void VolumeHandles::finished()
{
    DragHistory::Restore before;
    before.swap(_private->before);
    if (_private->changed && _private->history && before)
        _private->history->add(std::move(before), remember());
    _private->dragged = _private->changed = false;
}

void VolumeHandles::resizeGLObjectBuffers(unsigned int maximum)
{
    osg::Group::resizeGLObjectBuffers(maximum);
    _private->look.resizeGLObjectBuffers(maximum);
}

void VolumeHandles::releaseGLObjects(osg::State* state) const
{
    osg::Group::releaseGLObjects(state);
    _private->look.releaseGLObjects(state);
}

void VolumeHandles::traverse(osg::NodeVisitor& visitor)
{
    if (osgGA::EventVisitor* events = visitor.asEventVisitor()) {
        if (auto* view = dynamic_cast<osgViewer::View*>(events->getActionAdapter()))
            for (const osg::ref_ptr<osgGA::Event>& event : events->getEvents())
                if (osgGA::GUIEventAdapter* ea = event->asGUIEventAdapter()) {
                    if (_private->pointer.handle(*this, *ea, *view)) ea->setHandled(true);
                    // OSG's draggers send no end where the pointer is nowhere on their line.
                    if (ea->getEventType() == osgGA::GUIEventAdapter::RELEASE &&
                        !_private->pointer.active())
                        finished();
                }
    } else if (osgUtil::CullVisitor* cull = visitor.asCullVisitor()) {
        for (osg::StateSet* pass : _private->look.passes()) {
            cull->pushStateSet(pass);
            osg::Group::traverse(visitor);
            cull->popStateSet();
        }
        return;
    } else if (visitor.getVisitorType() == osg::NodeVisitor::UPDATE_VISITOR && !isDragged()) {
        place();
    }
    osg::Group::traverse(visitor);
}

} // namespace osgVolumizer
