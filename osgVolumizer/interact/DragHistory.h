#pragma once

#include "../core/Export.h"

#include <osg/Referenced>

#include <cstddef>
#include <functional>
#include <vector>

namespace osgVolumizer {

/// Steps that can be undone and redone: of all handles that it is given to (see
/// VolumeHandles::setHistory()), each drag is one, from press to release. What was there before is
/// restored to the bit, also where a program has changed it since. To be called between frames; the
/// handles follow in the next update traversal.
class OSGVOLUMIZER_EXPORT DragHistory : public osg::Referenced
{
public:
    /// Puts back one state of something; called between frames.
    using Restore = std::function<void()>;

    /// A step of a program's own. Steps that were undone are forgotten.
    void add(Restore before, Restore after);
    /// False where there is nothing to be undone or redone.
    bool undo();
    bool redo();
    std::size_t getUndoCount() const { return _done; }
    std::size_t getRedoCount() const { return _steps.size() - _done; }
    void clear();
    /// Steps that are kept, the last ones; default 100, at least 1 is.
    void setMaximumSteps(std::size_t count);
    std::size_t getMaximumSteps() const { return _maximum; }

protected:
    ~DragHistory() override = default;

private:
    struct Step
    {
        Restore before, after;
    };
    void forgetOldest();

    std::vector<Step> _steps;
    std::size_t _done = 0; // of them, that are not undone
    std::size_t _maximum = 100;
};

} // namespace osgVolumizer
