#include "DragHistory.h"

#include <algorithm>
#include <utility>

namespace osgVolumizer {

void DragHistory::add(Restore before, Restore after)
{
    _steps.resize(_done);
    _steps.push_back({std::move(before), std::move(after)});
    ++_done;
    forgetOldest();
}

bool DragHistory::undo()
{
    if (_done == 0) return false;
    const Restore before = _steps[--_done].before; // which may change the history
    if (before) before();
    return true;
}

bool DragHistory::redo()
{
    if (_done == _steps.size()) return false;
    const Restore after = _steps[_done++].after;
    if (after) after();
    return true;
}

void DragHistory::clear()
{
    _steps.clear();
    _done = 0;
}

void DragHistory::setMaximumSteps(std::size_t count)
{
    _maximum = std::max<std::size_t>(count, 1);
    forgetOldest();
}

void DragHistory::forgetOldest()
{
    if (_steps.size() <= _maximum) return;
    const std::size_t surplus = std::min(_steps.size() - _maximum, _done);
    _steps.erase(_steps.begin(), _steps.begin() + static_cast<std::ptrdiff_t>(surplus));
    _done -= surplus;
    _steps.resize(std::min(_steps.size(), _maximum)); // undone ones, the last ones first
}

} // namespace osgVolumizer
