// What translucent geometry costs in and around a volume: time of a frame against that of the same
// scene with the geometry hidden, and of the geometry alone. Frames of all are interleaved, and
// medians compared, so that a busy machine slows all. CPU time is that of the whole process, so
// that with a software rasteriser it is what a frame costs, whatever else the machine does.
//
//   mergebench [frames] [name]

#include "../support/Median.h"
#include "../support/ProcessTime.h"
#include "MixedScene.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <random>

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using osgVolumizer::bench::median;
using osgVolumizer::bench::processMilliseconds;

namespace {

constexpr int SIZE = 128; // voxels per axis
constexpr glm::dvec4 GREEN(0.2, 0.9, 0.3, 0.4);

struct Bench
{
    std::string name;
    double target; // most that the ratio may be
    osg::ref_ptr<osg::Group> surfaces;
};

void addSphere(osg::Group& group, const glm::dvec3& center, double radius, int slices)
{
    group.addChild(makeGeometry(sphereMesh(center, radius, slices, slices / 2), GREEN));
}

// 100 * (2 * 50 - ...) and so on: the counts are printed.
std::vector<Bench> makeBenches()
{
    std::vector<Bench> benches;
    Bench spheres{"three spheres of 10000 triangles", 1.6, new osg::Group};
    addSphere(*spheres.surfaces, {44, 50, 60}, 24, 100);
    addSphere(*spheres.surfaces, {80, 70, 64}, 28, 100);
    addSphere(*spheres.surfaces, {64, 64, 90}, 20, 100);
    benches.push_back(spheres);

    Bench many{"100000 triangles", 2.5, new osg::Group};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> place(20.0, 108.0);
    for (int i = 0; i < 10; ++i)
        addSphere(*many.surfaces, {place(random), place(random), place(random)}, 16, 100);
    benches.push_back(many);

    Bench one{"one sphere of 100000 triangles", 2.5, new osg::Group};
    addSphere(*one.surfaces, {64, 64, 64}, 40, 316);
    benches.push_back(one);

    Bench outside{"a hundred leaves beyond the volume's depths", 1.02, new osg::Group};
    for (int i = 0; i < 100; ++i) {
        const float x = static_cast<float>(6.4 * (i % 10)), z = static_cast<float>(6.4 * (i / 10));
        outside.surfaces->addChild(makeGeometry(
            quadMesh({glm::vec3(x, 330, z), {x + 1, 330, z}, {x + 1, 330, z + 1}, {x, 330, z + 1}}),
            GREEN));
    }
    benches.push_back(outside);
    return benches;
}

void run(const Bench& bench, int frames)
{
    osg::ref_ptr<Voxels> voxels =
        makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3& p) { return bumps(0.4 * p); });
    const TwinVolume volume =
        makeTwin(voxels, {{0.0, {0.1, 0.2, 0.9, 0.002}}, {1.0, {1.0, 0.5, 0.1, 0.03}}});
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(volume.node);
    scene->addChild(bench.surfaces);
    support::RenderOptions options;
    options.size(512, 512).perspective(30.0).frameScene(volume.node->getBound());
    support::SceneRenderer renderer(scene, options);
    enum Show
    {
        HIDDEN,
        SHOWN,
        ALONE,
        COUNT
    };
    std::vector<double> wall[COUNT], cpu[COUNT];
    for (int i = -1; i < frames; ++i) {
        for (const Show show : {ALONE, HIDDEN, SHOWN}) {
            bench.surfaces->setNodeMask(show != HIDDEN ? ~0u : 0u);
            volume.node->setNodeMask(show != ALONE ? ~0u : 0u);
            const double before = processMilliseconds();
            const support::FloatImage picture = renderer.render();
            if (i < 0 && show == SHOWN) support::savePicture(picture, "bench_" + bench.name);
            if (i < 0) continue;
            cpu[show].push_back(processMilliseconds() - before);
            wall[show].push_back(renderer.milliseconds().front());
        }
    }
    const double hidden = median(wall[HIDDEN]), shown = median(wall[SHOWN]);
    std::printf("%-45s hidden %7.1f ms  shown %7.1f ms  ratio %.3f  target %.2f %s\n",
                bench.name.c_str(), hidden, shown, shown / hidden, bench.target,
                shown <= bench.target * hidden ? "" : "  MISSED");
    const double cpuHidden = median(cpu[HIDDEN]), cpuShown = median(cpu[SHOWN]);
    std::printf("%-45s hidden %7.1f ms  shown %7.1f ms  ratio %.3f  surfaces alone %.1f ms\n",
                "    CPU", cpuHidden, cpuShown, cpuShown / cpuHidden, median(cpu[ALONE]));
    for (const auto& counter : renderer.counters())
        std::printf("    %s %g\n", counter.first.c_str(), counter.second);
}

} // namespace

int main(int argc, char** argv)
{
    const int frames = argc > 1 ? std::max(1, std::atoi(argv[1])) : 15;
    for (const Bench& bench : makeBenches())
        if (argc < 3 || bench.name.find(argv[2]) != std::string::npos) run(bench, frames);
}
