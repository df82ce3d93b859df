#include "Axis.h"

#include <osgVolumizer/core/Text.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace osgVolumizer {
namespace gdal {

namespace {

constexpr double EVEN = 1e-4; // of a step
constexpr int MOST_TIMES = 4; // as many samples as there are

bool risesOrFalls(const std::vector<double>& values)
{
    const bool rises = values.back() > values.front();
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!std::isfinite(values[i]) ||
            (i > 0 && !(rises ? values[i] > values[i - 1] : values[i] < values[i - 1])))
            return false;
    return true;
}

// Where `value` lies among values that rise or fall.
double placeAmong(const std::vector<double>& values, double value)
{
    const bool rises = values.back() > values.front();
    const auto after = std::upper_bound(
        values.begin() + 1, values.end() - 1, value,
        [rises](double v, double element) { return rises ? v < element : v > element; });
    const double high = *after, low = *(after - 1);
    const double place =
        double(after - values.begin()) - 1.0 + std::clamp((value - low) / (high - low), 0.0, 1.0);
    // Samples of the file stay what they are.
    const double nearest = std::round(place);
    return std::fabs(place - nearest) < 1e-9 ? nearest : place;
}

// The volume's sample `i` of a level among those of the level below all.
int inVolume(const Axis& axis, int i, int level)
{
    if (level == 0) return i;
    const std::int64_t place = (std::int64_t(i) << level) + (std::int64_t(1) << (level - 1));
    return int(std::min<std::int64_t>(place, axis.size - 1));
}

} // namespace

void unwrapDegrees(std::vector<double>& values)
{
    if (values.size() < 3 || risesOrFalls(values)) return;
    double turns = 0.0;
    std::vector<double> unwrapped = values;
    for (std::size_t i = 1; i < values.size(); ++i) {
        const double jump = values[i] - values[i - 1];
        if (std::fabs(jump) > 180.0 && std::fabs(jump) <= 360.0)
            turns -= std::copysign(360.0, jump);
        unwrapped[i] += turns;
    }
    if (risesOrFalls(unwrapped)) values = unwrapped;
}

void placeSamples(Axis& axis, const std::vector<double>& values, double precision, int most,
                  std::vector<std::string>& notices)
{
    const std::string what = "coordinates of " + axis.name;
    if (values.size() == 1 && std::isfinite(values[0])) axis.first = values[0];
    if (values.size() < 2) return;
    if (!risesOrFalls(values)) {
        notices.push_back(what + " neither rise nor fall and are not used");
        return;
    }
    const double count = double(values.size()) - 1.0;
    axis.known = true;
    axis.first = values.front();
    axis.step = (values.back() - values.front()) / count;
    const double span = std::fabs(values.back() - values.front());
    double worst = 0.0, smallest = span, largest = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        worst = std::max(worst, std::fabs(values[i] - (axis.first + double(i) * axis.step)));
        largest = std::max(largest, std::fabs(values[i]));
        if (i > 0) smallest = std::min(smallest, std::fabs(values[i] - values[i - 1]));
    }
    if (worst <= std::max(EVEN * std::fabs(axis.step), precision * largest)) return;
    if (double(most) < count + 1.0) {
        notices.push_back(what + " are uneven, and its samples too many to make even ones: they "
                                 "are drawn as if they were even");
        return;
    }
    // As many as the smallest gap wants, as far as it may be; a little less where that is a
    // rounding error too many.
    const double wanted = std::ceil(span / smallest - 1e-6) + 1.0;
    axis.size = int(std::min({wanted, double(most), MOST_TIMES * double(values.size())}));
    axis.step = (values.back() - values.front()) / (axis.size - 1.0);
    for (int i = 0; i < axis.size; ++i)
        axis.places.push_back(placeAmong(values, axis.first + i * axis.step));
    notices.push_back(what + " are uneven: its " + std::to_string(values.size()) +
                      " samples are interpolated to " + std::to_string(axis.size) + " even ones");
}

Fetch fetchOf(const Axis& axis, int min, int max, int level)
{
    Fetch fetch;
    if (axis.places.empty()) {
        // Samples of a coarser level are evenly apart, but for those that the end holds back.
        for (int i = min; i < max; ++i) {
            const int sample = inVolume(axis, i, level);
            Run* run = fetch.runs.empty() ? nullptr : &fetch.runs.back();
            if (run && sample == run->start + run->count * (1 << level))
                ++run->count;
            else
                fetch.runs.push_back({sample, 1 << level, 1, fetch.count});
            ++fetch.count;
        }
        return fetch;
    }
    const auto placeOf = [&](int i) { return axis.places[std::size_t(inVolume(axis, i, level))]; };
    const int first = int(placeOf(min));
    const int last = std::min(int(std::ceil(placeOf(max - 1))), axis.samples - 1);
    fetch.runs.push_back({first, 1, last - first + 1, 0});
    fetch.count = last - first + 1;
    for (int i = min; i < max; ++i)
        fetch.places.push_back(placeOf(i) - first);
    return fetch;
}

} // namespace gdal
} // namespace osgVolumizer
