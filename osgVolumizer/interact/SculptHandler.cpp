#include "SculptHandler.h"

#include "../VolumeAppearance.h"
#include "Pick.h"

#include <osg/Camera>
#include <osg/Transform>
#include <osg/View>
#include <osgGA/GUIActionAdapter>

namespace osgVolumizer {

using Event = osgGA::GUIEventAdapter;

SculptHandler::SculptHandler(Voxels* voxels) : _sculptor(voxels), _modifiers(Event::MODKEY_SHIFT) {}

// In the object frame; nothing where something else is seen.
std::optional<osg::Vec3d> SculptHandler::pointUnder(const Event& event,
                                                    osgGA::GUIActionAdapter& actions) const
{
    osg::View* view = actions.asView();
    osg::Camera* camera = view ? view->getCamera() : nullptr;
    const osg::Viewport* viewport = camera ? camera->getViewport() : nullptr;
    if (!viewport) return std::nullopt;
    const auto seen = zpick(*camera, 0.5 * (event.getXnormalized() + 1.0) * viewport->width(),
                            0.5 * (event.getYnormalized() + 1.0) * viewport->height());
    if (!seen.ok()) reportError(seen.status);
    if (!seen.ok() || !*seen || !(**seen).isVolume) return std::nullopt;
    const PixelPick& pick = **seen;
    const VolumeAppearance* appearance = appearanceOf(pick.nodePath);
    if (!appearance || appearance->getVoxels() != _sculptor.getVoxels()) return std::nullopt;
    return pick.point * osg::computeWorldToLocal(pick.nodePath);
}

bool SculptHandler::handleKey(const Event& event)
{
    const int key = event.getUnmodifiedKey();
    if (!(event.getModKeyMask() & Event::MODKEY_CTRL) || (key != 'z' && key != 'y')) return false;
    if (key == 'z' ? !_sculptor.canUndo() : !_sculptor.canRedo()) return false;
    reportError(key == 'z' ? _sculptor.undo() : _sculptor.redo());
    _drawing = false;
    return true;
}

bool SculptHandler::handle(const Event& event, osgGA::GUIActionAdapter& actions)
{
    const auto type = event.getEventType();
    if (_drawing && type == Event::RELEASE) { // whoever else has handled it
        _sculptor.endStroke();
        _drawing = false;
        return true;
    }
    if (event.getHandled() || !_sculptor.getVoxels()) return false;
    if (type == Event::KEYDOWN) {
        if (!handleKey(event)) return false;
        actions.requestRedraw();
        return true;
    }
    const bool pushed = type == Event::PUSH && event.getButton() == Event::LEFT_MOUSE_BUTTON &&
                        (_modifiers == 0 || (event.getModKeyMask() & _modifiers) != 0);
    if (pushed || (_drawing && type == Event::DRAG)) {
        const auto point = pointUnder(event, actions);
        if (!point) return _drawing;
        const auto dabs = _drawing ? _sculptor.strokeTo(*point) : _sculptor.beginStroke(*point);
        if (!dabs.ok()) reportError(dabs.status);
        _drawing = _drawing || dabs.ok();
        actions.requestRedraw();
        return true;
    }
    return false;
}

} // namespace osgVolumizer
