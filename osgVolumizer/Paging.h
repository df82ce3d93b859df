#pragma once

#include "Error.h"

#include <cstdint>
#include <functional>

namespace osg {
class Camera;
}

namespace osgVolumizer {

class Voxels;

/// What paged voxels (see Voxels::isPaged()) may take, all of a process together. Held at all
/// times, but for the one page that is drawn where not even that fits.
struct PagingBudget
{
    /// Of samples in main memory that wait to be drawn, or that may be wanted again.
    std::int64_t memoryBytes = 0;
    /// Of their textures, in each context.
    std::int64_t textureBytes = 0;
    /// What a frame may spend on handing pages to a context; or, of slow frames, a tenth of what
    /// the last one took. A page at least, whatever it takes.
    double uploadMilliseconds = 0.0;
    /// Threads that read; 1 to 64.
    int threads = 0;
};

/// What suits this machine: a quarter of its memory, an eighth of it for textures (which a graphics
/// driver may move there), 4 ms, and a thread for each core but one, 2 to 8. The environment
/// variables OSGVOLUMIZER_MEMORY and OSGVOLUMIZER_TEXTURE_MEMORY (megabytes, "512") decide instead.
OSGVOLUMIZER_EXPORT PagingBudget defaultPagingBudget();

/// Takes effect on what is read and drawn next. Refuses bytes below 1 MB, milliseconds that are not
/// above 0, and other numbers of threads (VALUE_INVALID); the old budget then stays. Thread safe.
OSGVOLUMIZER_EXPORT ReportedStatus setPagingBudget(const PagingBudget& budget);
/// The default until one is set. Thread safe.
OSGVOLUMIZER_EXPORT PagingBudget getPagingBudget();

/// What a view is told of paged voxels in it.
struct PagingEvent
{
    const Voxels* voxels = nullptr;
    const osg::Camera* camera = nullptr; ///< of the view; null without one
    /// Pages that are missing, of those that the picture should be drawn from: 0 once it is final,
    /// for this view and, where time goes on, this time step.
    std::int64_t missing = 0;
};
/// Called while a scene is traversed, in whichever thread that is, whenever a view's picture of
/// paged voxels has become final, or no longer is. It may not change the scene. Viewers of
/// osgViewer that draw on demand are told to draw until it is final without this.
using PagingCallback = std::function<void(const PagingEvent&)>;
/// In place of the one before; none where empty. Thread safe; it may still be called once by a
/// frame under way.
OSGVOLUMIZER_EXPORT void setPagingCallback(PagingCallback callback);
OSGVOLUMIZER_EXPORT PagingCallback getPagingCallback();

} // namespace osgVolumizer
