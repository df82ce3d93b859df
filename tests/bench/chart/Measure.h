#pragma once

#include "../support/Median.h"
#include "Reference.h"
#include "Renderer.h"

namespace osgVolumizer {
namespace bench {

/// One point of the chart: one renderer at one step.
struct Point
{
    std::string scene, renderer;
    double step = 0.0;
    support::Difference difference;      ///< picture minus reference, red, green and blue
    std::vector<double> milliseconds;    ///< wall clock of a frame, one per round
    std::vector<double> cpuMilliseconds; ///< of all threads of the process
};

struct MeasureOptions
{
    std::vector<double> steps{8.0, 4.0, 2.0, 1.0, 0.5, 0.25, 0.125};
    int rounds = 5;
    bool pictures = false; ///< write what each renderer draws at its finest step, for people
};

/// Draws a scene with all renderers: one round after the other, in each every step, and for each
/// step every renderer, so that whatever else the machine does falls on all alike.
std::vector<Point> measure(const ChartScene& scene, const Reference& reference,
                           const std::vector<RendererPtr>& renderers,
                           const MeasureOptions& options);

/// Draws frames of one renderer, with nothing between them: for a profiler that is told to count
/// inside of this function only. Returns the wall clock milliseconds of each.
std::vector<double> drawFrames(Renderer& renderer, int count);

} // namespace bench
} // namespace osgVolumizer
