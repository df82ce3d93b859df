#include "MeshMeasure.h"

#include "../support/CompareOverBlack.h"
#include "../support/FrameTime.h"

#include <oracles/MeshOracle.h>
#include <support/OracleView.h>

#include <iostream>

namespace osgVolumizer {
namespace bench {

namespace {

constexpr int STRIDE = 4;

// The pixels that the reference has.
support::FloatImage everyFourth(const support::FloatImage& picture)
{
    support::FloatImage result(picture.width / STRIDE, picture.height / STRIDE);
    for (int y = 0; y < result.height; ++y)
        for (int x = 0; x < result.width; ++x)
            result.at(x, y) = picture.at(STRIDE * x + STRIDE / 2, STRIDE * y + STRIDE / 2);
    return result;
}

// False, with the reason on the error stream, where it draws nothing of the scene.
bool drawFirst(MeshRenderer& renderer, const MeshScene& scene, const support::FloatImage& reference,
               MeshPoint& point)
{
    const Status status = renderer.open(scene);
    if (!status.ok()) {
        std::cerr << scene.name << ", " << renderer.name() << ": " << status.text << "\n";
        return false;
    }
    renderer.setView(scene.view(0));
    renderer.frame();
    point.renderer = renderer.name();
    point.picture = renderer.picture();
    if (support::coveredPixels(point.picture).count() == 0) {
        std::cerr << scene.name << ", " << renderer.name() << ": draws nothing\n";
        return false;
    }
    point.difference =
        compareOverBlack(everyFourth(point.picture), reference, support::coveredPixels(reference));
    return true;
}

} // namespace

support::FloatImage meshReference(const MeshScene& scene)
{
    const oracle::MeshOracle exact(scene.mesh, oracle::Table(scene.table), scene.unit);
    return oracle::render(exact, support::oracleCamera(scene.view(0)), glm::dmat4(1.0), STRIDE);
}

std::vector<MeshPoint> measureMesh(const MeshScene& scene, const support::FloatImage& reference,
                                   const std::vector<MeshRendererPtr>& renderers, int rounds)
{
    std::vector<MeshPoint> points;
    std::vector<MeshRenderer*> drawing;
    for (const MeshRendererPtr& renderer : renderers) {
        MeshPoint point;
        if (!drawFirst(*renderer, scene, reference, point)) continue;
        points.push_back(std::move(point));
        drawing.push_back(renderer.get());
    }
    for (int round = 0; round < rounds; ++round)
        for (std::size_t i = 0; i < drawing.size(); ++i) {
            drawing[i]->setView(scene.view(2 * round + 1));
            drawing[i]->frame();
            drawing[i]->setView(scene.view(2 * round + 2));
            const FrameTime time = timeFrame(*drawing[i]);
            points[i].milliseconds.push_back(time.wall);
            points[i].cpuMilliseconds.push_back(time.cpu);
        }
    return points;
}

} // namespace bench
} // namespace osgVolumizer
