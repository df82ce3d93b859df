#include "Measure.h"

#include "../support/CompareOverBlack.h"
#include "../support/FrameTime.h"

#include <algorithm>
#include <iostream>

namespace osgVolumizer {
namespace bench {

namespace {

// A renderer whose frames take longer than this is not measured at finer steps.
constexpr double PATIENCE_MILLISECONDS = 500.0;

// What only the first frame after a change costs is not counted.
Status drawAt(Renderer& renderer, double step)
{
    const Status status = renderer.setStep(step);
    if (status.ok()) renderer.frame();
    return status;
}

void printRefusal(const ChartScene& scene, const Renderer& renderer, const Status& status)
{
    std::cerr << scene.name << ", " << renderer.name() << ": " << status.text << "\n";
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
        Status status = renderer->open(scene);
        // Each shades by another model, and is judged by its own finest picture.
        if (status.ok() && scene.shaded) status = renderer->setFinest();
        if (!status.ok()) {
            printRefusal(scene, *renderer, status);
            continue;
        }
        Entry entry{renderer.get(), reference.picture, reference.mask};
        if (scene.shaded) {
            renderer->frame();
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
                const Status status = drawAt(renderer, step);
                if (!status.ok()) {
                    if (round == 0) printRefusal(scene, renderer, status);
                    continue;
                }
                if (round == 0) {
                    const support::FloatImage picture = renderer.picture();
                    point.scene = scene.name;
                    point.renderer = renderer.name();
                    point.step = step;
                    point.difference = compareOverBlack(picture, entry.picture, entry.mask);
                    if (options.pictures && step == options.steps.back())
                        support::savePicture(picture, "chart " + scene.name + " " + point.renderer);
                }
                const FrameTime time = timeFrame(renderer);
                point.milliseconds.push_back(time.wall);
                point.cpuMilliseconds.push_back(time.cpu);
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
        milliseconds.push_back(timeFrame(renderer).wall);
    return milliseconds;
}

} // namespace bench
} // namespace osgVolumizer
