// Picks per second on one core: random lines through 256^3 voxels. Arguments of the program are
// those of Google Benchmark.
#include <interact/PickOracle.h>

#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <benchmark/benchmark.h>

using namespace osgVolumizer;
using namespace osgVolumizer::test;

namespace {

constexpr int SIZE = 256;

// A ball with bumps in the middle, about a tenth of the volume; nothing around it.
osg::ref_ptr<VolumeAppearance> makeScene(const Points& points)
{
    VoxelSource::Description description;
    description.size = glm::ivec3(SIZE);
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    source->allocate(description);
    auto* bytes = static_cast<unsigned char*>(source->data());
    for (int z = 0; z < SIZE; ++z)
        for (int y = 0; y < SIZE; ++y)
            for (int x = 0; x < SIZE; ++x) {
                const glm::dvec3 p(x, y, z);
                const double inside = 1.0 - glm::length(p - 127.5) / 75.0;
                *bytes++ = static_cast<unsigned char>(
                    inside <= 0.0 ? 0.0 : 255.0 * std::sqrt(inside) * bumps(0.3 * p));
            }
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(new Voxels(source));
    appearance->setLookupTable(makeTable(points));
    return appearance;
}

const Points OPAQUE = {{0.1, {1, 1, 1, 0.0}}, {0.5, {1, 1, 1, 0.5}}};
const Points SMOKE = {{0.1, {1, 1, 1, 0.0}}, {1.0, {1, 1, 1, 0.004}}};

void pick(benchmark::State& state, VolumeAppearance& appearance)
{
    RandomLines random(glm::dvec3(0.0), glm::dvec3(SIZE - 1));
    std::vector<Line> lines;
    for (int i = 0; i < 1000; ++i)
        lines.push_back(random.next());
    int hits = 0;
    std::size_t i = 0;
    for (auto _ : state) {
        const Line& line = lines[i++ % lines.size()];
        osg::ref_ptr<osgUtil::LineSegmentIntersector> segment =
            new osgUtil::LineSegmentIntersector(toVec3d(line.start), toVec3d(line.end));
        osgUtil::IntersectionVisitor visitor(segment);
        appearance.accept(visitor);
        hits += segment->containsIntersections();
    }
    state.counters["picks"] = benchmark::Counter(double(i), benchmark::Counter::kIsRate);
    state.counters["hits"] = double(hits) / double(i);
}

void opaque(benchmark::State& state)
{
    static const auto scene = makeScene(OPAQUE);
    pick(state, *scene);
}
BENCHMARK(opaque)->Unit(benchmark::kMicrosecond);

// Light passes all the way, and so no pick ends early.
void smoke(benchmark::State& state)
{
    static const auto scene = makeScene(SMOKE);
    pick(state, *scene);
}
BENCHMARK(smoke)->Unit(benchmark::kMicrosecond);

void maximum(benchmark::State& state)
{
    static const auto scene = makeScene(OPAQUE);
    scene->setRayFunction(VolumeAppearance::MAXIMUM);
    pick(state, *scene);
}
BENCHMARK(maximum)->Unit(benchmark::kMicrosecond);

void isosurface(benchmark::State& state)
{
    static const auto scene = makeScene(OPAQUE);
    scene->setRayFunction(VolumeAppearance::ISOSURFACE);
    scene->setIsoValue(100.0);
    pick(state, *scene);
}
BENCHMARK(isosurface)->Unit(benchmark::kMicrosecond);

} // namespace

BENCHMARK_MAIN();
