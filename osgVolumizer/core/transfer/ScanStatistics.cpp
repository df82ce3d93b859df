#include "ScanStatistics.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

namespace osgVolumizer {
namespace core {

namespace {

using Histogram = std::vector<std::uint64_t>;

/// From the background on: brightness rises evenly, as it does for people who see few colours.
const glm::dvec3 WARM[] = {{0.24, 0.08, 0.10},
                           {0.62, 0.25, 0.18},
                           {0.88, 0.52, 0.33},
                           {0.97, 0.79, 0.55},
                           {1.00, 0.97, 0.90}};

double total(const Histogram& h)
{
    return static_cast<double>(std::accumulate(h.begin(), h.end(), std::uint64_t(0)));
}

/// Share of the samples in bins [first, end).
double share(const Histogram& h, int first, int end)
{
    const double part =
        static_cast<double>(std::accumulate(h.begin() + first, h.begin() + end, std::uint64_t(0)));
    const double all = total(h);
    return all > 0.0 ? part / all : 0.0;
}

/// The outermost bin of the foreground, but for 0.1 % of its samples. `step` leads away from the
/// threshold.
int farBin(const Histogram& h, int start, int step)
{
    double foreground = 0.0;
    for (int b = start; b >= 0 && b < ScanStatistics::BINS; b += step)
        foreground += static_cast<double>(h[static_cast<std::size_t>(b)]);
    double sum = 0.0;
    int b = start;
    for (; b >= 0 && b < ScanStatistics::BINS; b += step) {
        sum += static_cast<double>(h[static_cast<std::size_t>(b)]);
        if (sum >= 0.999 * foreground) break;
    }
    return std::min(std::max(b, 0), ScanStatistics::BINS - 1);
}

/// Opacity along the foreground, over the highest: what begins to show does so soon.
double rise(double along)
{
    return along * (2.0 - along);
}

/// Mean over a histogram of a rise that is 0 at fraction `from` and 1 at `to`.
double meanRise(const Histogram& h, double from, double to)
{
    double sum = 0.0;
    for (std::size_t b = 0; b < h.size(); ++b) {
        const double value = (static_cast<double>(b) + 0.5) / ScanStatistics::BINS;
        const double ramp = std::min(std::max((value - from) / (to - from), 0.0), 1.0);
        sum += rise(ramp) * static_cast<double>(h[b]);
    }
    const double all = total(h);
    return all > 0.0 ? sum / all : 0.0;
}

} // namespace

ScanStatistics::ScanStatistics(const glm::ivec3& volumeSize, const ValueRange& range)
    : _size(volumeSize), _range(range), _all(BINS, 0), _inner(BINS, 0), _border(BINS, 0)
{
    const double samples = static_cast<double>(sampleCount(volumeSize));
    _step = std::max(1, static_cast<int>(std::ceil(std::cbrt(samples / 4194304.0))));
}

void ScanStatistics::add(const VoxelView& part, const glm::ivec3& origin)
{
    const double scale = BINS / (_range.high - _range.low);
    const auto isInner = [&](int v, int axis) {
        return 4 * v >= _size[axis] && 4 * v < 3 * _size[axis];
    };
    const auto isOuter = [&](int v, int axis) { return v < _step || v + _step >= _size[axis]; };
    for (int z = 0; z < part.size.z; z += _step)
        for (int y = 0; y < part.size.y; y += _step) {
            const glm::ivec3 p(origin.x, origin.y + y, origin.z + z);
            const bool innerRow = isInner(p.y, 1) && isInner(p.z, 2);
            const bool outerRow = isOuter(p.y, 1) || isOuter(p.z, 2);
            const std::int64_t row =
                part.size.x * (y + std::int64_t(part.size.y) * std::int64_t(z));
            for (int x = 0; x < part.size.x; x += _step) {
                const double v = voxelValue(part, row + x);
                if (std::isnan(v)) continue;
                const double bin = std::min(std::max((v - _range.low) * scale, 0.0), BINS - 1.0);
                const std::size_t b = static_cast<std::size_t>(bin);
                ++_all[b];
                if (innerRow && isInner(p.x + x, 0)) ++_inner[b];
                if (outerRow || isOuter(p.x + x, 0)) ++_border[b];
            }
        }
}

int otsuThreshold(const std::vector<std::uint64_t>& histogram)
{
    const double all = total(histogram);
    double sum = 0.0;
    for (std::size_t b = 0; b < histogram.size(); ++b)
        sum += static_cast<double>(b) * static_cast<double>(histogram[b]);
    double below = 0.0, sumBelow = 0.0, best = 0.0;
    int first = -1, last = -1;
    for (std::size_t b = 0; b + 1 < histogram.size(); ++b) {
        below += static_cast<double>(histogram[b]);
        sumBelow += static_cast<double>(b) * static_cast<double>(histogram[b]);
        if (below == 0.0 || below == all) continue;
        const double distance = sumBelow / below - (sum - sumBelow) / (all - below);
        const double between = below * (all - below) * distance * distance;
        if (between > best) {
            best = between;
            first = static_cast<int>(b);
        }
        if (between >= best) last = static_cast<int>(b);
    }
    return first < 0 ? -1 : (first + last) / 2;
}

TransferFunction suggestTransferFunction(const ScanStatistics& statistics, int voxelsPerSample)
{
    const int threshold = otsuThreshold(statistics.all());
    // A single value: all of it is shown.
    if (threshold < 0) return *TransferFunction::create({{0.0, glm::dvec4(0.8, 0.8, 0.8, 0.05)}});
    const bool inverted = share(statistics.border(), 0, threshold + 1) < 0.5;
    const double from = (threshold + 1.0) / ScanStatistics::BINS;
    const int far = inverted ? farBin(statistics.all(), threshold, -1)
                             : farBin(statistics.all(), threshold + 1, 1);
    const double to = (far + (inverted ? 0.0 : 1.0)) / ScanStatistics::BINS;
    const glm::ivec3& size = statistics.volumeSize();
    const double width = voxelsPerSample * (static_cast<double>(size.x) + size.y + size.z) / 3.0;
    const double filled =
        std::max(meanRise(statistics.inner(), from, to), meanRise(statistics.all(), from, to));
    const double extinction = 12.0 / std::max(filled * width, 1e-3);
    const double opacity = std::min(std::max(opacityFromExtinction(extinction, 1.0), 0.002), 0.95);
    std::vector<TransferFunction::Point> points;
    for (std::size_t i = 0; i < std::size(WARM); ++i) {
        const double along = static_cast<double>(i) / (std::size(WARM) - 1);
        points.push_back({from + along * (to - from), glm::dvec4(WARM[i], rise(along) * opacity)});
    }
    if (inverted) std::reverse(points.begin(), points.end());
    return *TransferFunction::create(points);
}

} // namespace core
} // namespace osgVolumizer
