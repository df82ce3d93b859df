// How fast polygonize() is, against the limit that memory sets: memcpy of as many bytes as the
// faces have, in the same run. Counters: polygons per second, bytes per second, and the part of the
// speed of memcpy. Arguments of the program are those of Google Benchmark.

#include "osgVolumizer/core/sampling/FaceCache.h"
#include "tests/core/TestGeometry.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <memory>

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

std::size_t bytesOf(const PolygonizedFaces& f)
{
    return f.faces.vertices.size() * sizeof(float) +
           (f.faces.indices.size() + f.faces.faceOffsets.size()) * sizeof(std::uint32_t);
}

/// Processor time of this thread: wall time on a machine that others use says little.
double now()
{
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Bytes per second of memcpy of the same amount, the best of several.
double memcpySpeed(std::size_t bytes)
{
    std::vector<char> from(bytes, 1), to(bytes, 2);
    double best = 1e9;
    for (int i = 0; i < 25; ++i) {
        const double start = now();
        std::memcpy(to.data(), from.data(), bytes);
        benchmark::ClobberMemory();
        best = std::min(best, now() - start);
    }
    return static_cast<double>(bytes) / best;
}

std::vector<Box3d> bricks(int n, double size)
{
    std::vector<Box3d> r;
    const double step = size / n;
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x)
                r.push_back({glm::dvec3(x, y, z) * step, glm::dvec3(x + 1, y + 1, z + 1) * step});
    return r;
}

View benchView()
{
    return testing::viewAlong({1, 2, 3});
}

void run(benchmark::State& state, TetraSet tetra, const std::vector<Box3d>& boxes,
         SamplingParameters parameters)
{
    Polygonizer polygonizer;
    PolygonizedFaces out;
    if (!polygonizer.setTetraSet(std::make_shared<const TetraSet>(std::move(tetra))).ok() ||
        !polygonizer.setClipBoxes(boxes).ok() ||
        !polygonizer.polygonize(benchView(), parameters, out).ok()) {
        state.SkipWithError("polygonize");
        return;
    }
    double best = 1e9;
    for (auto _ : state) {
        const double start = now();
        const Status status = polygonizer.polygonize(benchView(), parameters, out);
        benchmark::DoNotOptimize(status.code);
        best = std::min(best, now() - start);
    }
    const auto polygons = static_cast<double>(out.faces.faceCount());
    const auto bytes = static_cast<double>(bytesOf(out));
    state.counters["polygons"] = polygons;
    state.counters["bytes/polygon"] = bytes / polygons;
    state.counters["polygons/s"] = polygons / best;
    state.counters["of_memcpy"] = bytes / best / memcpySpeed(bytesOf(out));
}

/// Cells along an axis: with 16 of them all stays in the second-level cache.
void gridV3F(benchmark::State& state)
{
    const int cells = static_cast<int>(state.range(0));
    run(state, testing::makeGrid(cells, cells), {}, {});
}
BENCHMARK(gridV3F)->Arg(64)->Arg(16)->Unit(benchmark::kMillisecond)->UseRealTime();

void gridBricks(benchmark::State& state)
{
    TetraSet grid = testing::makeGrid(64, 64.0, VertexFormat(VertexLayout::T3F_C4F_V3F));
    for (std::size_t i = 0; i < grid.vertices.size(); ++i)
        grid.vertices.setVoxelCoordinate(i, grid.vertices.position(i));
    // Bricks that agree with the cells, or that cut through them.
    run(state, std::move(grid), bricks(4, state.range(0) ? 64.0 : 63.0), {});
}
BENCHMARK(gridBricks)->Arg(1)->Arg(0)->Unit(benchmark::kMillisecond)->UseRealTime();

void boxWith512Planes(benchmark::State& state)
{
    SamplingParameters p;
    p.periodVoxel = glm::dvec3(1e-3);
    p.maximumSamples = 512;
    run(state, testing::makeBox(glm::dvec3(0.0), glm::dvec3(64.0)),
        {{glm::dvec3(0.0), glm::dvec3(64.0)}}, p);
}
BENCHMARK(boxWith512Planes)->Unit(benchmark::kMicrosecond);

/// The same view again, through the cache.
void unchangedView(benchmark::State& state)
{
    FaceCache cache;
    const auto set =
        std::make_shared<const TetraSet>(testing::makeBox(glm::dvec3(0.0), glm::dvec3(64.0)));
    const std::vector<Box3d> boxes = bricks(4, 64.0);
    const View view = benchView();
    for (auto _ : state)
        benchmark::DoNotOptimize(cache.faces(1, set, boxes, view, SamplingParameters()));
}
BENCHMARK(unchangedView)->Unit(benchmark::kNanosecond);

} // namespace

BENCHMARK_MAIN();
