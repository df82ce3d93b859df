#pragma once

#include <cstddef>
#include <vector>

namespace osgVolumizer {
namespace render {

/// What decides how many slots a surface's fragments need.
struct SurfaceDepthComplexity
{
    /// How many of its triangles lie over each other at most: see SurfaceMesh::coverEstimate().
    double estimate = 0.0;
    std::size_t triangles = 0; ///< no pixel has more fragments
    bool known = false;        ///< else both are guessed
};

/// Surfaces whose fragments are captured together, in slots of their own.
struct CaptureSet
{
    std::vector<std::size_t> surfaces; ///< numbers of what findCaptureSets() was given
    int firstSlot = 0, slotCount = 0;
};

/// Large meshes by themselves, with as many slots as they seem to need, and one more where there is
/// room; all others together, with as many as they could need. The sum of slots is a multiple of 4,
/// of which the last set has what is left over. Empty where `affordable` slots do not suffice.
std::vector<CaptureSet> findCaptureSets(const std::vector<SurfaceDepthComplexity>& surfaces,
                                        int affordable);

/// Most slots that buffers of a size in pixels should have: a multiple of 4.
int affordableSlots(int width, int height);

} // namespace render
} // namespace osgVolumizer
