#pragma once

#include "Sculpt.h"

#include <osgGA/GUIEventHandler>

#include <optional>

namespace osgVolumizer {

/// Sculpts voxels under the mouse: with a modifier key held, by default Shift, the left button
/// draws a stroke along what is seen of them, found by zpick(). Where nothing of them is seen, or
/// something in front of them, the stroke pauses, and goes on from where it was. Control and Z undo
/// a stroke, Control and Y do it again. All other events are left to others, such as manipulators;
/// what it takes it tells by returning true. What is refused is reported.
class OSGVOLUMIZER_EXPORT SculptHandler : public osgGA::GUIEventHandler
{
public:
    explicit SculptHandler(Voxels* voxels);

    /// Its tool, and its history.
    Sculptor& getSculptor() { return _sculptor; }
    const Sculptor& getSculptor() const { return _sculptor; }
    /// A mask of osgGA::GUIEventAdapter::ModKeyMask of which one has to be held; 0 for none.
    void setModifiers(int mask) { _modifiers = mask; }
    int getModifiers() const { return _modifiers; }

    using osgGA::GUIEventHandler::handle;
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter& actions) override;

protected:
    ~SculptHandler() override = default;

private:
    std::optional<osg::Vec3d> pointUnder(const osgGA::GUIEventAdapter& event,
                                         osgGA::GUIActionAdapter& actions) const;
    bool handleKey(const osgGA::GUIEventAdapter& event);

    Sculptor _sculptor;
    int _modifiers;
    bool _drawing = false;
};

} // namespace osgVolumizer
