#pragma once

#include "../Error.h"
#include "../core/Export.h"
#include "DragHistory.h"

#include <osg/Group>
#include <osg/ref_ptr>

#include <memory>

namespace osgManipulator {
class Dragger;
}

namespace osgVolumizer {

/// Base of all that moves something by handles: cuts, crops, probes, clip planes, parts, lattices.
/// The handles are osgManipulator's draggers. Put the group once into a scene that an
/// osgViewer::View shows, beside the volume's geometry (below the same transforms), unless a class
/// says otherwise; it follows what it moves, whoever moves that.
///
/// Handles are drawn as opaque surfaces, which volumes hide where they are opaque, and once more,
/// faintly, on top of everything (contexts of the compatibility profile); neither lights nor clip
/// planes change them. They are found under the pointer through whatever is in front; of several,
/// whichever group they are in, the nearest.
///
/// Things change in the event traversal and follow in the update traversal, so between frames, in
/// every threading model of OSG's viewers. What is refused is reported, and the handle goes back.
///
/// Not in scene files, though what it moves is: OSG leaves the group out, with a warning. Copies
/// are plain groups.
class OSGVOLUMIZER_EXPORT VolumeHandles : public osg::Group
{
public:
    /// Where drags become steps; null (default): nowhere.
    void setHistory(DragHistory* history);
    DragHistory* getHistory() const;
    /// Of the faint picture on top, 0 (none) to 1; default 0.35. VALUE_INVALID for any other.
    ReportedStatus setThroughOpacity(double opacity);
    double getThroughOpacity() const;

    /// The draggers, in an order that each class states: for colours, constraints and callbacks of
    /// an application. Their activation by modifier keys and mouse buttons (setActivation...) is
    /// heeded, not that by other keys, and no setHandleEvents(): events come from the group.
    unsigned getNumDraggers() const;
    osgManipulator::Dragger* getDragger(unsigned number) const;
    /// Between press and release.
    bool isDragged() const;
    /// Puts the handles where that is what they move, as each update traversal does.
    void follow();

    void traverse(osg::NodeVisitor& visitor) override;
    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;
    const char* libraryName() const override { return "osgVolumizer"; }
    const char* className() const override { return "VolumeHandles"; }

protected:
    VolumeHandles();
    ~VolumeHandles() override;

    /// Adds a dragger, whose moves are handed to move().
    void addDragger(osgManipulator::Dragger* dragger);
    /// Puts the draggers' matrices where what they move is.
    virtual void place() = 0;
    /// A dragger has moved: changes what it moves, or refuses.
    virtual ReportedStatus move(unsigned dragger) = 0;
    /// What puts the present state back; null where there is none.
    virtual DragHistory::Restore remember() = 0;

private:
    class Follower;
    struct Private;
    void started();
    void moved(unsigned dragger);
    void finished();

    std::unique_ptr<Private> _private;
};

} // namespace osgVolumizer
