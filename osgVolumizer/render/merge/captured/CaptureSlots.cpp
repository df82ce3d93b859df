#include "CaptureSlots.h"

#include "CaptureBuffers.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

constexpr std::size_t MEMORY_BUDGET = std::size_t(512) << 20, BYTES_PER_SLOT = 20 + 5;
constexpr std::size_t LARGE_MESH = 2000; // triangles
constexpr int COMMON_SLOTS = 8, UNKNOWN_FRAGMENTS = 4;
// An estimate may be a little above a whole number.
constexpr double ESTIMATE_TOLERANCE = 0.9;

int slotsFor(const SurfaceDepthComplexity& surface)
{
    const double fragments =
        surface.known ? surface.estimate * ESTIMATE_TOLERANCE : UNKNOWN_FRAGMENTS;
    return static_cast<int>(std::ceil(std::clamp(fragments, 1.0, 1000.0)));
}

// Numbers the slots of sets one after another; whole fours are sorted, so all of them have to be
// drawn, or at least cleared.
void numberSlots(std::vector<CaptureSet>& sets)
{
    int next = 0;
    for (CaptureSet& set : sets) {
        set.firstSlot = next;
        next += set.slotCount;
    }
    sets.back().slotCount += (next + 3) / 4 * 4 - next;
}

} // namespace

std::vector<CaptureSet> findCaptureSets(const std::vector<SurfaceDepthComplexity>& surfaces,
                                        int affordable)
{
    CaptureSet common;
    std::vector<CaptureSet> sets;
    int total = 0, needed = 0;
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
        const SurfaceDepthComplexity& surface = surfaces[s];
        const int slots = slotsFor(surface);
        if (surface.known && surface.triangles >= LARGE_MESH) {
            sets.push_back({{s}, 0, slots});
            total += slots;
        } else {
            common.surfaces.push_back(s);
            const std::size_t most =
                surface.known ? surface.triangles : std::size_t(UNKNOWN_FRAGMENTS);
            needed += static_cast<int>(std::min(most, std::size_t(slots) + 1));
        }
    }
    common.slotCount = std::min(needed, COMMON_SLOTS);
    int spare = affordable - total - common.slotCount;
    if (spare < 0) return {};
    if (spare >= static_cast<int>(sets.size())) {
        for (CaptureSet& set : sets)
            ++set.slotCount;
        spare -= static_cast<int>(sets.size());
    }
    common.slotCount = std::min(needed, common.slotCount + spare);
    if (common.slotCount > 0) sets.insert(sets.begin(), common);
    if (!sets.empty()) numberSlots(sets);
    return sets;
}

int affordableSlots(int width, int height)
{
    const std::size_t pixels = std::size_t(std::max(width, 1)) * std::size_t(std::max(height, 1));
    const std::size_t slots = MEMORY_BUDGET / (pixels * BYTES_PER_SLOT);
    return static_cast<int>(std::min(slots, std::size_t(CaptureBuffers::MAXIMUM_SLOTS))) / 4 * 4;
}

} // namespace render
} // namespace osgVolumizer
