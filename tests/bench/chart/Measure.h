#pragma once

#include "Reference.h"
#include "Renderer.h"

#include <ostream>

namespace osgVolumizer {
namespace bench {

/// One point of the chart.
struct Point
{
    std::string scene, renderer;
    double step = 0.0;
    support::Difference difference;    ///< picture minus reference
    std::vector<double> milliseconds;  ///< wall clock, one per round
    std::vector<double> cpuMilliseconds; ///< of all threads of the process
};

struct MeasureOptions
{
    std::vector<double> steps{4.0, 2.0, 1.0, 0.5, 0.25};
    int rounds = 5;
    bool pictures = false; ///< write a PNG of each renderer's finest step to the build folder
};

/// Draws a scene with all renderers: one round after the other, in each every step, and for each
/// step every renderer, so that whatever else the machine does falls on all alike.
std::vector<Point> measure(const ChartScene& scene, const Reference& reference,
                           const std::vector<RendererPtr>& renderers, const MeasureOptions& options);

double median(std::vector<double> values);

} // namespace bench
} // namespace osgVolumizer
