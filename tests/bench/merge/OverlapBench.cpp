// What volumes cost that overlap: time of a frame of all against the sum of those of each alone;
// and of surfaces in two of them, against that with the surfaces hidden. Frames of all are
// interleaved, and medians of the process's CPU time compared, as in mergebench.
//
//   overlapbench [frames] [size of the picture]

#include "../support/Median.h"
#include "../support/ProcessTime.h"
#include "MixedScene.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using osgVolumizer::bench::median;
using osgVolumizer::bench::processMilliseconds;

namespace {

constexpr int SIZE = 64; // voxels per axis
const glm::dvec3 MIDDLE(0.5 * (SIZE - 1));

// Turned about its middle and moved a little: another way for each.
osg::Matrixd placement(int number)
{
    const double s = number;
    return osg::Matrixd::translate(-MIDDLE.x, -MIDDLE.y, -MIDDLE.z) *
           osg::Matrixd::rotate(0.4 * s, osg::Vec3d(0.3, 1.0, 0.5 - 0.1 * s)) *
           osg::Matrixd::translate(MIDDLE.x + 5 * std::sin(2.0 * s), MIDDLE.y + 6 * std::cos(s),
                                   MIDDLE.z + 4 * std::sin(s));
}

// Median CPU time of pictures of some of the children, for each choice of them.
std::vector<double> times(osg::Group& scene, const support::RenderOptions& options,
                          const std::vector<unsigned>& choices, int frames)
{
    support::SceneRenderer renderer(&scene, options);
    std::vector<std::vector<double>> all(choices.size());
    for (int frame = -1; frame < frames; ++frame) {
        for (std::size_t c = 0; c < choices.size(); ++c) {
            for (unsigned child = 0; child < scene.getNumChildren(); ++child)
                scene.getChild(child)->setNodeMask(choices[c] >> child & 1u ? ~0u : 0u);
            const double before = processMilliseconds();
            renderer.render();
            if (frame >= 0) all[c].push_back(processMilliseconds() - before);
        }
    }
    std::vector<double> medians;
    for (const std::vector<double>& some : all)
        medians.push_back(median(some));
    return medians;
}

MixedScene volumes(int count, bool congruent)
{
    MixedScene scene;
    for (int i = 0; i < count; ++i)
        scene.addVolume(
            makeVoxels(glm::ivec3(SIZE),
                       [i](const glm::dvec3& p) { return bumps((0.3 + 0.03 * i) * p); }),
            {{0.0, {0.1, 0.2, 0.9, 0.002}}, {1.0, {1.0, 0.1 * i, 0.1, 0.06 / count}}},
            congruent ? osg::Matrixd() : placement(i));
    return scene;
}

// `empty` is the time of a frame that shows nothing, which is in each of the others.
void overlap(int count, bool congruent, const support::RenderOptions& options, int frames)
{
    MixedScene scene = volumes(count, congruent);
    std::vector<unsigned> choices{0u, (1u << count) - 1u};
    for (int i = 0; i < count; ++i)
        choices.push_back(1u << i);
    const std::vector<double> t = times(*scene.root(), options, choices, frames);
    const double sum = std::accumulate(t.begin() + 2, t.end(), 0.0) - (count - 1) * t[0];
    std::printf("%d volumes%-12s together %7.1f ms  one by one %7.1f ms  ratio %.2f\n", count,
                congruent ? ", congruent" : "", t[1], sum, t[1] / sum);
}

void surfaces(const support::RenderOptions& options, int frames)
{
    MixedScene scene = volumes(2, false);
    for (const glm::dvec3& at : {glm::dvec3(22, 25, 30), {40, 35, 32}, {32, 32, 45}})
        scene.addMesh(sphereMesh(at, 12.0, 100, 50), {0.2, 0.9, 0.3, 0.4});
    const std::vector<double> t = times(*scene.root(), options, {3u, ~0u}, frames);
    std::printf("three spheres in two volumes: hidden %7.1f ms  shown %7.1f ms  ratio %.2f\n", t[0],
                t[1], t[1] / t[0]);
}

} // namespace

int main(int argc, char** argv)
{
    const int frames = argc > 1 ? std::max(1, std::atoi(argv[1])) : 9;
    const int size = argc > 2 ? std::max(16, std::atoi(argv[2])) : 256;
    support::RenderOptions options;
    options.size(size, size).perspective(30.0).lookAt({150, -110, 120}, {31, 31, 31}, {0, 0, 1});
    for (const int count : {2, 4, 8})
        for (const bool congruent : {true, false})
            overlap(count, congruent, options, frames);
    surfaces(options, frames);
}
