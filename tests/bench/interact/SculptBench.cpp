// Dabs per second on one core: a tool of radius 10 along strokes through 256^3 voxels. Arguments of
// the program are those of Google Benchmark.
#include <osgVolumizer/interact/Sculpt.h>

#include <benchmark/benchmark.h>

using namespace osgVolumizer;

namespace {

constexpr int SIZE = 256;

void sculpt(benchmark::State& state, VoxelType type, Sculptor::Operation operation)
{
    VoxelSource::Description description;
    description.size = glm::ivec3(SIZE);
    description.type = type;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    source->allocate(description);
    Sculptor sculptor(new Voxels(source));
    Sculptor::Tool tool;
    tool.operation = operation;
    tool.strength = 0.5;
    sculptor.setTool(tool);
    // From side to side, a quarter of the radius for each dab; a position of a drag for each.
    bool begun = false;
    std::int64_t dabs = 0, step = 0;
    for (auto _ : state) {
        const std::int64_t line = step / 80, along = step % 80;
        const osg::Vec3d point(20.0 + 2.5 * double(along), 20.0 + double(line * 7 % 210),
                               20.0 + double(line * 13 % 210));
        const auto done =
            begun && along != 0 ? sculptor.strokeTo(point) : sculptor.beginStroke(point);
        dabs += done.value;
        begun = true;
        ++step;
    }
    state.counters["dabs"] = benchmark::Counter(double(dabs), benchmark::Counter::kIsRate);
}

void bytesMaximum(benchmark::State& state)
{
    sculpt(state, VoxelType::UINT8, Sculptor::Operation::MAX_ADD);
}
BENCHMARK(bytesMaximum)->Unit(benchmark::kMicrosecond);

void bytesPerlin(benchmark::State& state)
{
    sculpt(state, VoxelType::UINT8, Sculptor::Operation::PERLIN_ADD);
}
BENCHMARK(bytesPerlin)->Unit(benchmark::kMicrosecond);

void floatsPerlin(benchmark::State& state)
{
    sculpt(state, VoxelType::FLOAT32, Sculptor::Operation::PERLIN_ADD);
}
BENCHMARK(floatsPerlin)->Unit(benchmark::kMicrosecond);

} // namespace

BENCHMARK_MAIN();
