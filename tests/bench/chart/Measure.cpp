#include "Measure.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>

namespace osgVolumizer {
namespace bench {

namespace {

double cpuMilliseconds()
{
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    const auto ms = [](const timeval& t) { return 1e3 * double(t.tv_sec) + 1e-3 * double(t.tv_usec); };
    return ms(usage.ru_utime) + ms(usage.ru_stime);
}

// What a screen shows: alpha left out, since half of the peers write none that means anything.
support::Difference compareOverBlack(support::FloatImage a, support::FloatImage b,
                                     const support::Mask& mask)
{
    for (glm::vec4& p : a.pixels) p.a = 0.0f;
    for (glm::vec4& p : b.pixels) p.a = 0.0f;
    support::Difference d = support::compare(a, b, mask);
    d.rmse *= std::sqrt(4.0 / 3.0); // over three channels
    d.bias *= 4.0 / 3.0;
    return d;
}

void timeFrame(Renderer& renderer, Point& point)
{
    const double cpu = cpuMilliseconds();
    const auto start = std::chrono::steady_clock::now();
    renderer.frame();
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
    point.milliseconds.push_back(wall.count());
    point.cpuMilliseconds.push_back(cpuMilliseconds() - cpu);
}

} // namespace

double median(std::vector<double> values)
{
    if (values.empty()) return 0.0;
    const std::size_t middle = values.size() / 2;
    std::sort(values.begin(), values.end());
    return values.size() % 2 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

std::vector<Point> measure(const ChartScene& scene, const Reference& reference,
                           const std::vector<RendererPtr>& renderers, const MeasureOptions& options)
{
    std::vector<Renderer*> open;
    for (const RendererPtr& renderer : renderers) {
        const Status status = renderer->open(scene);
        if (status.ok())
            open.push_back(renderer.get());
        else
            std::cerr << scene.name << ", " << renderer->name() << ": " << status.text << "\n";
    }
    std::vector<Point> points;
    for (double step : options.steps)
        for (Renderer* renderer : open) {
            Point point;
            point.scene = scene.name;
            point.renderer = renderer->name();
            point.step = step;
            points.push_back(point);
        }
    for (int round = 0; round < options.rounds; ++round) {
        std::size_t i = 0;
        for (double step : options.steps)
            for (Renderer* renderer : open) {
                Point& point = points[i++];
                renderer->setStep(step);
                renderer->frame(); // what only the first frame after a change costs
                if (round == 0) {
                    const support::FloatImage picture = renderer->picture();
                    point.difference = compareOverBlack(picture, reference.picture, reference.mask);
                    if (options.pictures && step == options.steps.back())
                        support::savePicture(picture, "chart-" + scene.name + "-" + renderer->name());
                }
                timeFrame(*renderer, point);
            }
    }
    return points;
}

} // namespace bench
} // namespace osgVolumizer
