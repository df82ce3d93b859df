#pragma once

#include <osg/Matrixd>

#include <cstdint>
#include <limits>
#include <map>
#include <mutex>

namespace osgVolumizer {
namespace render {

/// By how much the number of samples is reduced in each view for frames to take a wanted time: more
/// while the view moves and frames take longer, less while there is time left, not at all once it
/// rests. How long frames at rest took is where it begins. Frames that are culled ahead of drawing
/// tell of reductions some frames late, so no more is made of them than whether they were late.
/// Thread safe.
class FrameTimes
{
public:
    /// Once a frame. \param view whichever identifies it \param frame number of the frame, which
    /// tells whether the last one was seen \param toClip where the volume is in it: moving is when
    /// this changes by more than rounding \param now, target seconds \param fixed what to return
    /// for views that move, whatever time they take; 0: by time \return samples wanted over samples
    /// to be taken, >= 1
    double reduction(std::uint64_t view, unsigned frame, const osg::Matrixd& toClip, double now,
                     double target, double fixed = 0.0);

    static constexpr double LARGEST = 128.0;
    /// Bound on what frames at rest say of the first one that moves: they may have waited for
    /// something else.
    static constexpr double LARGEST_AT_FIRST = 16.0;

private:
    static constexpr double NEVER = std::numeric_limits<double>::infinity();
    struct View
    {
        unsigned frame = ~0u - 1; ///< none yet, and none that another one follows
        osg::Matrixd toClip;
        double time = 0.0;
        double reduction = 1.0; ///< while moving
        double atRest = NEVER;  ///< seconds of the fastest frame since it moved last
        bool moved = false;     ///< in its last frame
    };
    static constexpr std::size_t CAPACITY = 16;

    static void adapt(View& view, double seconds, double target);

    std::mutex _mutex;
    std::map<std::uint64_t, View> _views;
};

/// How a reduction is shared out.
struct ReducedSampling
{
    double rayDistance = 1.0; ///< pixels between rays
    double stretch = 1.0;     ///< factor of periods
};

/// Saves samples in the image and along the rays alike: the cube root of a reduction in each of the
/// three directions. A small one is all along the rays, which keeps the picture sharp; a large one
/// too, once rays are 4 pixels apart.
ReducedSampling reducedSampling(double reduction);

} // namespace render
} // namespace osgVolumizer
