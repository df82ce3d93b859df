// Picks of composited volumes against a dense march in double precision.
#include "PickOracle.h"

#include <osgVolumizer/ReadVoxels.h>

namespace PickOracleTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;

namespace {

constexpr int LINES = 1000;
constexpr double TENTH = 0.1; // of a voxel
constexpr double STEP = 1.0 / 128.0;

// A box of voxels with spacing 1 that is filled by a grid.
Extinction gridExtinction(std::shared_ptr<oracle::Grid> grid, const oracle::Table& table)
{
    const glm::dvec3 last(grid->size() - 1);
    return [grid, table, last](const glm::dvec3& p) {
        if (!inside(p, glm::dvec3(0.0), last)) return 0.0;
        return oracle::Table::extinction(table.color(grid->value(p)).a);
    };
}

int compareBox(Voxels* voxels, const Points& points, VolumeAppearance::Interpolation how,
               int lines = LINES)
{
    const oracle::Grid::Interpolation modes[] = {oracle::Grid::NEAREST, oracle::Grid::LINEAR,
                                                 oracle::Grid::CUBIC};
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    appearance->setInterpolation(how);
    appearance->setLookupTable(makeTable(points));
    const glm::dvec3 last(voxels->getLayout().size() - 1);
    return comparePicks(*appearance,
                        gridExtinction(gridOf(*voxels, modes[how]), oracle::Table(points)),
                        glm::dvec3(0.0), last, lines, TENTH, STEP);
}

osg::ref_ptr<Voxels> ramp()
{
    return makeVoxels(glm::ivec3(40), [](const glm::dvec3& p) { return p.x / 39.0; });
}

// Values rise from the middle outwards; the table is a thin shell with sharp sides.
const Points SHELL = {{0.0, {1, 0, 0, 0.0}},  {0.5, {1, 0, 0, 0.0}},  {0.5, {1, 0, 0, 0.9}},
                      {0.54, {1, 0, 0, 0.9}}, {0.54, {1, 0, 0, 0.0}}, {1.0, {1, 0, 0, 0.0}}};

osg::ref_ptr<Voxels> distances(int size)
{
    return makeVoxels(glm::ivec3(size), [size](const glm::dvec3& p) {
        return glm::length(p - 0.5 * glm::dvec3(size - 1)) / size;
    });
}

TEST(PickOracle, SmoothBlob)
{
    const auto voxels = makeBlob(glm::ivec3(48), 8.0);
    EXPECT_GT(compareBox(voxels, smoothPoints(0.3), VolumeAppearance::LINEAR), 300);
}

TEST(PickOracle, Ramp)
{
    EXPECT_GT(compareBox(ramp(), smoothPoints(0.2), VolumeAppearance::LINEAR), 300);
}

TEST(PickOracle, ShellWithSteps)
{
    EXPECT_GT(compareBox(distances(48), SHELL, VolumeAppearance::LINEAR), 300);
}

TEST(PickOracle, NearestSamples)
{
    EXPECT_GT(
        compareBox(makeBlob(glm::ivec3(32), 6.0), smoothPoints(0.5), VolumeAppearance::NEAREST),
        300);
}

TEST(PickOracle, CubicInterpolation)
{
    EXPECT_GT(
        compareBox(makeBlob(glm::ivec3(24), 4.0), smoothPoints(0.5), VolumeAppearance::CUBIC, 300),
        100);
}

TEST(PickOracle, Detail)
{
    EXPECT_GT(compareBox(makeVoxels(glm::ivec3(40), bumps), SHELL, VolumeAppearance::LINEAR), 300);
}

TEST(PickOracle, LookupBeforeInterpolation)
{
    const auto voxels = distances(32);
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    appearance->setLookupTable(makeTable(SHELL));
    appearance->setLookup(VolumeAppearance::BEFORE_INTERPOLATION);
    const oracle::Table table(SHELL);
    std::vector<double> samples = gridOf(*voxels)->samples();
    for (double& v : samples)
        v = oracle::Table::extinction(table.color(v).a);
    const auto grid = std::make_shared<oracle::Grid>(glm::ivec3(32), samples);
    const auto extinction = [&](const glm::dvec3& p) {
        return inside(p, glm::dvec3(0.0), glm::dvec3(31.0)) ? grid->value(p) : 0.0;
    };
    EXPECT_GT(comparePicks(*appearance, extinction, glm::dvec3(0.0), glm::dvec3(31.0), LINES, TENTH,
                           STEP),
              200);
}

// The bricks, and memory that is read in them, must not show.
TEST(PickOracle, ManyBricks)
{
    const auto voxels = makeVoxels(glm::ivec3(41, 37, 29), bumps);
    ASSERT_TRUE(voxels->setBrickSize({12, 9, 15}).ok());
    EXPECT_GT(voxels->getLayout().brickCount(), 20);
    EXPECT_GT(compareBox(voxels, SHELL, VolumeAppearance::LINEAR), 300);
    const auto single = makeVoxels(glm::ivec3(41, 37, 29), bumps);
    osg::ref_ptr<VolumeAppearance> a = makeVolume(voxels), b = makeVolume(single);
    RandomLines lines(glm::dvec3(0.0), {40, 36, 28});
    for (int how : {0, 1, 2}) {
        a->setInterpolation(VolumeAppearance::Interpolation(how));
        b->setInterpolation(VolumeAppearance::Interpolation(how));
        for (int i = 0; i < 100; ++i) {
            const Line line = lines.next();
            const auto inBricks = pickLine(*a, line), inOne = pickLine(*b, line);
            ASSERT_EQ(inBricks.has_value(), inOne.has_value());
            if (!inOne) continue;
            EXPECT_NEAR(inBricks->ratio, inOne->ratio, 1e-7);
        }
    }
}

TEST(PickOracle, AnOpacityUnitAndSpacing)
{
    const auto voxels = makeBlob(glm::ivec3(32), 6.0);
    voxels->setSpacing({0.5, 2.0, 1.0});
    voxels->setOrigin({-7.0, 3.0, 100.0});
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    appearance->setLookupTable(makeTable(smoothPoints(0.6)));
    appearance->setOpacityUnit(2.5);
    appearance->setPickOpacity(0.3);
    const auto grid = gridOf(*voxels);
    const oracle::Table table(smoothPoints(0.6));
    const auto extinction = [&](const glm::dvec3& p) {
        const glm::dvec3 v = (p - glm::dvec3(-7, 3, 100)) / glm::dvec3(0.5, 2.0, 1.0);
        if (!inside(v, glm::dvec3(0.0), glm::dvec3(31.0))) return 0.0;
        return oracle::Table::extinction(table.color(grid->value(v)).a) / 2.5;
    };
    EXPECT_GT(
        comparePicks(*appearance, extinction, {-7, 3, 100}, {8.5, 65, 131}, LINES, 0.05, STEP),
        200);
}

TEST(PickOracle, RgbaVoxels)
{
    constexpr int SIZE = 24;
    VoxelSource::Description description;
    description.size = glm::ivec3(SIZE);
    description.components = 4;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    ASSERT_TRUE(source->allocate(description).ok());
    auto* bytes = static_cast<unsigned char*>(source->data());
    std::vector<double> alpha;
    for (int i = 0; i < SIZE * SIZE * SIZE; ++i) {
        const glm::dvec3 p(i % SIZE, i / SIZE % SIZE, i / SIZE / SIZE);
        const double a =
            std::floor(120.0 * bumps(p) * std::exp(-0.01 * glm::dot(p - 12.0, p - 12.0)));
        for (int c = 0; c < 3; ++c)
            bytes[4 * i + c] = 200;
        bytes[4 * i + 3] = static_cast<unsigned char>(a);
        alpha.push_back(a / 255.0);
    }
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(new Voxels(source));
    const oracle::Grid grid(glm::ivec3(SIZE), alpha);
    const auto extinction = [&](const glm::dvec3& p) {
        return inside(p, glm::dvec3(0.0), glm::dvec3(SIZE - 1.0))
                   ? oracle::Table::extinction(grid.value(p))
                   : 0.0;
    };
    EXPECT_GT(comparePicks(*appearance, extinction, glm::dvec3(0.0), glm::dvec3(SIZE - 1.0), LINES,
                           TENTH, STEP),
              100);
}

// The scan that is shipped, with a table that shows skin.
TEST(PickOracle, Scan)
{
    const auto read = readVoxels(OSGVOLUMIZER_SOURCE_DIR "/data/head.tif");
    ASSERT_TRUE(read.ok()) << read.status.text;
    osg::ref_ptr<Voxels> voxels = *read;
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    appearance->getLookupTable()->setRamp(0.25, 0.30);
    const auto size = voxels->getLayout().size();
    const VoxelBlock block = voxels->getBrick(0);
    const auto count = std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    ASSERT_EQ(block.bytes, count);
    const auto grid = std::make_shared<oracle::Grid>(
        size, oracle::toDoubles(block.data, count, VoxelType::UINT8));
    const osg::Vec2d range = voxels->getRange();
    const oracle::Table table(*appearance->getLookupTable()->getFunction(), {range.x(), range.y()});
    EXPECT_GT(comparePicks(*appearance, gridExtinction(grid, table), glm::dvec3(0.0),
                           glm::dvec3(size - 1), LINES, TENTH, STEP),
              400);
}

} // namespace

} // namespace PickOracleTest
