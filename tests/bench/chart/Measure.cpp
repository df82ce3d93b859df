#include "Measure.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>

namespace osgVolumizer {
namespace bench {

namespace {

// Pictures of shaded scenes are judged by the renderer's own one at this step: each shades by
// another model.
constexpr double SHADED_REFERENCE_STEP = 1.0 / 16.0;

double cpuMilliseconds()
{
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    const auto ms = [](const timeval& t) {
        return 1e3 * double(t.tv_sec) + 1e-3 * double(t.tv_usec);
    };
    return ms(usage.ru_utime) + ms(usage.ru_stime);
}

// What a screen shows: alpha is left out, since some of the peers write none that means anything.
support::Difference compareOverBlack(support::FloatImage a, support::FloatImage b,
                                     const support::Mask& mask)
{
    for (glm::vec4& p : a.pixels)
        p.a = 0.0f;
    for (glm::vec4& p : b.pixels)
        p.a = 0.0f;
    support::Difference d = support::compare(a, b, mask);
    d.rmse *= std::sqrt(4.0 / 3.0); // over three channels
    d.bias *= 4.0 / 3.0;
    return d;
}

// A renderer whose frames take longer than this is not measured at finer steps.
constexpr double PATIENCE_MILLISECONDS = 500.0;

// What only the first frame after a change costs is not counted.
void drawAt(Renderer& renderer, double step)
{
    const Status status = renderer.setStep(step);
    if (!status.ok()) std::cerr << renderer.name() << ": " << status.text << "\n";
    renderer.frame();
}

double timeFrame(Renderer& renderer)
{
    const auto start = std::chrono::steady_clock::now();
    renderer.frame();
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
    return wall.count();
}

// A renderer that could be opened, and what its pictures are compared with.
struct Entry
{
    Renderer* renderer;
    support::FloatImage picture;
    support::Mask mask;
};

std::vector<Entry> openAll(const ChartScene& scene, const Reference& reference,
                           const std::vector<RendererPtr>& renderers)
{
    std::vector<Entry> entries;
    for (const RendererPtr& renderer : renderers) {
        const Status status = renderer->open(scene);
        if (!status.ok()) {
            std::cerr << scene.name << ", " << renderer->name() << ": " << status.text << "\n";
            continue;
        }
        Entry entry{renderer.get(), reference.picture, reference.mask};
        if (scene.shaded) {
            drawAt(*renderer, SHADED_REFERENCE_STEP);
            entry.picture = renderer->picture();
            entry.mask = support::coveredPixels(entry.picture);
        }
        entries.push_back(std::move(entry));
    }
    return entries;
}

} // namespace

std::vector<Point> measure(const ChartScene& scene, const Reference& reference,
                           const std::vector<RendererPtr>& renderers, const MeasureOptions& options)
{
    const std::vector<Entry> entries = openAll(scene, reference, renderers);
    std::vector<Point> points(options.steps.size() * entries.size());
    // Per renderer: how many steps are measured, which the first round decides.
    std::vector<std::size_t> measured(entries.size(), options.steps.size());
    for (int round = 0; round < options.rounds; ++round) {
        for (std::size_t s = 0; s < options.steps.size(); ++s)
            for (std::size_t e = 0; e < entries.size(); ++e) {
                if (s >= measured[e]) continue;
                const Entry& entry = entries[e];
                const double step = options.steps[s];
                Renderer& renderer = *entry.renderer;
                Point& point = points[s * entries.size() + e];
                drawAt(renderer, step);
                if (round == 0) {
                    const support::FloatImage picture = renderer.picture();
                    point.scene = scene.name;
                    point.renderer = renderer.name();
                    point.step = step;
                    point.difference = compareOverBlack(picture, entry.picture, entry.mask);
                    if (options.pictures && step == options.steps.back())
                        support::savePicture(picture, "chart " + scene.name + " " + point.renderer);
                }
                const double cpu = cpuMilliseconds();
                point.milliseconds.push_back(timeFrame(renderer));
                point.cpuMilliseconds.push_back(cpuMilliseconds() - cpu);
                if (round == 0 && point.milliseconds.front() > PATIENCE_MILLISECONDS)
                    measured[e] = s + 1;
            }
    }
    points.erase(std::remove_if(points.begin(), points.end(),
                                [](const Point& p) { return p.milliseconds.empty(); }),
                 points.end());
    return points;
}

std::vector<double> drawFrames(Renderer& renderer, int count)
{
    std::vector<double> milliseconds;
    for (int i = 0; i < count; ++i)
        milliseconds.push_back(timeFrame(renderer));
    return milliseconds;
}

} // namespace bench
} // namespace osgVolumizer
