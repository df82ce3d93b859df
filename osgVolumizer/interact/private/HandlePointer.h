#pragma once

#include <osg/ref_ptr>
#include <osgManipulator/Dragger>

namespace osgGA {
class GUIEventAdapter;
}
namespace osgViewer {
class View;
}

namespace osgVolumizer {

class VolumeHandles;

/// Finds the dragger under the pointer, through whatever is in front, and hands it the events of a
/// drag. osgManipulator's own way asks for the nearest surface of the whole scene, which a volume
/// about a handle would be.
class HandlePointer
{
public:
    /// True where the event is one of a drag. The handles are those below `owner`.
    bool handle(VolumeHandles& owner, const osgGA::GUIEventAdapter& event, osgViewer::View& view);
    bool active() const { return _active.valid(); }

private:
    bool press(VolumeHandles& owner, const osgGA::GUIEventAdapter& event, osgViewer::View& view);

    osgManipulator::PointerInfo _pointer;
    osg::ref_ptr<osgManipulator::Dragger> _active;
};

} // namespace osgVolumizer
