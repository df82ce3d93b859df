// Slices per second: planes through 128^3 voxels that fill 512^2 pixels, frame by frame. Arguments
// of the program are those of Google Benchmark.
#include <render/SliceScene.h>

#include <benchmark/benchmark.h>

#include <cmath>

using namespace osgVolumizer;
using namespace osgVolumizer::test;

namespace {

constexpr int SIZE = 128;
constexpr double MIDDLE = 0.5 * (SIZE - 1);

osg::ref_ptr<Voxels> voxelsOf(int brick)
{
    const osg::ref_ptr<Voxels> voxels =
        makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3& p) { return bumps(0.3 * p); });
    voxels->setBrickSize({brick, brick, brick});
    return voxels;
}

// Moves a plane through the volume, each frame elsewhere.
void draw(benchmark::State& state, VolumeSlice& slice, int brick)
{
    const RenderOptions view = RenderOptions().size(512, 512).orthographic(MIDDLE).lookAt(
        {MIDDLE, MIDDLE, 500}, {MIDDLE, MIDDLE, MIDDLE}, {0, 1, 0});
    support::SceneRenderer renderer(
        slicedOnly(voxelsOf(brick), {{0.0, {0, 0, 0, 1}}, {1.0, {1, 1, 1, 1}}}, &slice), view);
    slice.setPlane(osg::Vec3d(MIDDLE, MIDDLE, MIDDLE), osg::Vec3d(0, 0.1, 1));
    renderer.render();
    double milliseconds = 0.0, frames = 0.0;
    for (auto _ : state) {
        slice.setPlane(osg::Vec3d(MIDDLE, MIDDLE, MIDDLE + 30.0 * std::sin(0.1 * frames)),
                       osg::Vec3d(0, 0.1, 1));
        renderer.render();
        milliseconds += renderer.milliseconds().back();
        frames += 1.0;
    }
    // Without reading the picture back.
    state.counters["slices/s"] = 1e3 * frames / milliseconds;
}

void plane(benchmark::State& state)
{
    const osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
    draw(state, *slice, int(state.range(0)));
}
BENCHMARK(plane)->Arg(256)->Arg(33)->Unit(benchmark::kMillisecond);

void exactPlane(benchmark::State& state)
{
    const osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
    slice->setExactFiltering(true);
    draw(state, *slice, 256);
}
BENCHMARK(exactPlane)->Unit(benchmark::kMillisecond);

void slab(benchmark::State& state)
{
    const osg::ref_ptr<VolumeSlice> slice = new VolumeSlice;
    slice->setThickness(10.0);
    slice->setReduction(VolumeSlice::MAXIMUM);
    draw(state, *slice, int(state.range(0)));
}
BENCHMARK(slab)->Arg(256)->Arg(33)->Unit(benchmark::kMillisecond);

} // namespace

BENCHMARK_MAIN();
