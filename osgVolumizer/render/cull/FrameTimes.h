#pragma once

#include <osg/Matrixd>

#include <cstdint>
#include <map>
#include <mutex>

namespace osgVolumizer {
namespace render {

/// By how much sampling periods are stretched in each view for frames to take a wanted time: more
/// while the view moves and frames take longer, less while there is time left, not at all once it
/// rests. Thread safe.
class FrameTimes
{
public:
    /// Once a frame. \param view whichever identifies it \param frame number of the frame, which
    /// tells whether the last one was seen \param toClip where the volume is in it: moving is when
    /// this changes \param now, target seconds \return factor of periods, >= 1
    double stretch(std::uint64_t view, unsigned frame, const osg::Matrixd& toClip, double now,
                   double target);

    static constexpr double LARGEST = 16.0;

private:
    struct View
    {
        unsigned frame = 0;
        osg::Matrixd toClip;
        double time = 0.0;
        double stretch = 1.0; ///< while moving
        bool moved = false;   ///< in its last frame
    };
    static constexpr std::size_t CAPACITY = 16;

    std::mutex _mutex;
    std::map<std::uint64_t, View> _views;
};

} // namespace render
} // namespace osgVolumizer
