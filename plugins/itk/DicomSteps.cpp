// Which of several pictures of a place belong to which time step.

#include "DicomSeries.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>

namespace osgVolumizer {
namespace medical {

namespace {

constexpr std::size_t INSTANCE = 5; ///< in DicomFrame::order

using StepKey = std::array<double, 5>;
using StepKeyOf = std::function<StepKey(const DicomFrame&)>;
using Frames = std::vector<DicomFrame>;

// The steps of a key that has a picture of each place; none where the key is the same for several
// pictures of a place. `all` counts the others too.
std::vector<Frames> stepsBy(const std::vector<Frames>& places, const StepKeyOf& keyOf,
                            std::size_t& all)
{
    std::map<StepKey, Frames> steps;
    for (const Frames& place : places) {
        std::set<StepKey> here;
        for (const DicomFrame& frame : place) {
            const StepKey key = keyOf(frame);
            if (!here.insert(key).second) return {};
            steps[key].push_back(frame);
        }
    }
    all = steps.size();
    std::vector<Frames> whole;
    for (auto& [key, frames] : steps)
        if (frames.size() == places.size()) whole.push_back(std::move(frames));
    return whole;
}

// One or several of what frames are ordered by, or what their instance numbers count.
std::vector<StepKeyOf> keysFor(const std::vector<Frames>& places)
{
    std::vector<StepKeyOf> keys;
    for (const std::vector<std::size_t>& parts :
         {std::vector<std::size_t>{0}, {1}, {2}, {3}, {4}, {0, 2}, {2, 3}, {0, 1, 2, 3}})
        keys.emplace_back([parts](const DicomFrame& frame) {
            StepKey key{};
            for (const std::size_t i : parts)
                key[i] = frame.order[i];
            return key;
        });
    double first = places.front().front().order[INSTANCE];
    std::size_t most = 0;
    for (const Frames& place : places) {
        most = std::max(most, place.size());
        for (const DicomFrame& frame : place)
            first = std::min(first, frame.order[INSTANCE]);
    }
    // Step after step, or place after place.
    const double slices = double(places.size()), steps = double(most);
    for (const double from : {first, 1.0}) {
        keys.emplace_back([from, slices](const DicomFrame& frame) {
            return StepKey{std::floor((frame.order[INSTANCE] - from) / slices)};
        });
        keys.emplace_back([from, steps](const DicomFrame& frame) {
            const double i = frame.order[INSTANCE] - from;
            return StepKey{i - steps * std::floor(i / steps)};
        });
    }
    return keys;
}

} // namespace

std::vector<std::vector<DicomFrame>> wholeSteps(const std::vector<std::vector<DicomFrame>>& places,
                                                std::size_t& all)
{
    std::vector<Frames> best;
    for (const StepKeyOf& keyOf : keysFor(places)) {
        std::size_t count = 0;
        std::vector<Frames> steps = stepsBy(places, keyOf, count);
        if (steps.size() <= best.size()) continue;
        best = std::move(steps);
        all = count;
    }
    return best;
}

} // namespace medical
} // namespace osgVolumizer
