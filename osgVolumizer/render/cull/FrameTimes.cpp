#include "FrameTimes.h"

#include "../context/Matrices.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

void FrameTimes::adapt(View& v, double seconds, double target)
{
    const double late = seconds / target;
    // Part of a frame does not depend on samples: less than all of the change at once. On time it
    // is tried whether there is some left, which a display that waits for its next refresh does not
    // tell.
    const double change = late > 1.0 ? std::pow(late, 0.7) : 0.97 * std::pow(late, 0.3);
    v.reduction = std::clamp(v.reduction * std::clamp(change, 1.0 / 1.5, 2.0), 1.0, LARGEST);
}

double FrameTimes::reduction(std::uint64_t view, unsigned frame, const osg::Matrixd& toClip,
                             double now, double target, double fixed)
{
    std::lock_guard<std::mutex> lock(_mutex);
    if (_views.size() >= CAPACITY && !_views.count(view)) _views.clear();
    View& v = _views[view];
    const auto result = [&v, fixed]() {
        return !v.moved ? 1.0 : fixed > 0.0 ? fixed : v.reduction;
    };
    if (v.frame == frame && frame != 0) return result(); // another eye's turn
    const bool consecutive = v.frame + 1 == frame;
    const double seconds = now - v.time;
    if (consecutive && seconds > 0.0 && target > 0.0) {
        // What the last frame took, if it was drawn with this reduction.
        if (v.moved)
            adapt(v, seconds, target);
        else
            v.atRest = std::min(v.atRest, seconds);
    }
    const bool moves = consecutive && differs(v.toClip, toClip);
    if (moves && !v.moved && target > 0.0 && v.atRest < NEVER)
        v.reduction = std::max(v.reduction, std::clamp(v.atRest / target, 1.0, LARGEST_AT_FIRST));
    if (v.moved || !consecutive) v.atRest = NEVER;
    v.moved = moves;
    v.frame = frame;
    v.toClip = toClip;
    v.time = now;
    return result();
}

ReducedSampling reducedSampling(double reduction)
{
    constexpr double SMALL = 1.5, WIDEST = 4.0;
    if (reduction < SMALL) return {1.0, reduction};
    const double distance = std::min(std::cbrt(reduction), WIDEST);
    return {distance, reduction / (distance * distance)};
}

} // namespace render
} // namespace osgVolumizer
