// Lookup tables: when they are applied, how finely, and what a change of one costs.

#include "Volumes.h"

#include <osgVolumizer/render/textures/TableTextures.h>

#include <support/GLTest.h>

#include <cmath>
#include <random>

namespace TransferTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

using Transfer = support::GLTest;

const Points SMOOTH{{0.0, {0.2, 0.4, 0.9, 0.02}}, {1.0, {1.0, 0.3, 0.1, 0.3}}};
const Points JUMPS{{0.0, {0.2, 0.4, 0.9, 0.0}},   {0.4, {0.2, 0.4, 0.9, 0.0}},
                   {0.4, {1.0, 0.6, 0.1, 0.5}},   {0.45, {0.9, 0.2, 0.1, 0.5}},
                   {0.45, {0.1, 0.8, 0.1, 0.02}}, {1.0, {0.1, 0.1, 1.0, 0.1}}};
const Points PEAK{{0.0, {0, 0, 0, 0}},
                  {0.49, {1, 0.5, 0, 0}},
                  {0.5, {1, 0.5, 0, 0.8}},
                  {0.51, {1, 0.5, 0, 0}},
                  {1.0, {0, 0, 0, 0}}};

double blob(const glm::dvec3& p)
{
    return std::exp(-glm::dot(p - 16.0, p - 16.0) / 120.0);
}

RenderOptions view()
{
    RenderOptions options;
    options.size(96, 96).perspective(40.0).lookAt({70, -50, 60}, {16, 16, 16}, {0, 0, 1});
    return options;
}

FloatImage expectedPicture(const oracle::Volume& volume, const RenderOptions& options)
{
    oracle::Scene scene;
    scene.tolerance = 1e-8;
    scene.volumes.push_back(volume);
    return oracle::render(scene, support::oracleCamera(options));
}

double rmse(VolumeAppearance& volume, const RenderOptions& options, const FloatImage& expected,
            double period)
{
    volume.setSamplingPeriod(osg::Vec3d(period, period, period));
    return support::compare(support::renderScene(&volume, options), expected).rmse;
}

} // namespace

TEST_F(Transfer, PreIntegrationWinsForJumpsAndPeaks)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(33), blob);
    const RenderOptions options = view();
    for (const Points& points : {SMOOTH, JUMPS, PEAK}) {
        const bool sharp = points.size() > 2;
        osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
        volume->setLookupTable(makeTable(points));
        const FloatImage expected =
            expectedPicture(oracle::voxelVolume(gridOf(*voxels, oracle::Grid::LINEAR),
                                                glm::ivec3(33), oracle::Table(points)),
                            options);
        volume->setLookup(VolumeAppearance::AFTER_INTERPOLATION);
        const double after = rmse(*volume, options, expected, 1.0);
        volume->setLookup(VolumeAppearance::PREINTEGRATED);
        const double runs = rmse(*volume, options, expected, 1.0);
        const double runsHalf = rmse(*volume, options, expected, 0.5);
        volume->setLookup(VolumeAppearance::AUTOMATIC_LOOKUP);
        const double automatic = rmse(*volume, options, expected, 1.0);
        EXPECT_EQ(automatic, sharp ? runs : after);
        EXPECT_LT(runs, sharp ? after / 20.0 : 2e-4);
        EXPECT_LT(runsHalf, runs / 2.0);
    }
}

TEST_F(Transfer, PreIntegratedSlicesMissNoPeakEither)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(33), blob);
    const RenderOptions options = view();
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
    volume->setTechnique(VolumeAppearance::SLICES);
    volume->setLookupTable(makeTable(PEAK));
    const FloatImage expected =
        expectedPicture(oracle::voxelVolume(gridOf(*voxels, oracle::Grid::LINEAR), glm::ivec3(33),
                                            oracle::Table(PEAK)),
                        options);
    volume->setLookup(VolumeAppearance::AFTER_INTERPOLATION);
    const double after = rmse(*volume, options, expected, 1.0);
    volume->setLookup(VolumeAppearance::PREINTEGRATED);
    EXPECT_LT(rmse(*volume, options, expected, 1.0), after / 5.0);
}

TEST_F(Transfer, LookupBeforeInterpolationBlendsExtinctions)
{
    // Labels 0 to 3: between 1 and 3 lies no 2.
    std::mt19937 random(7);
    osg::ref_ptr<Voxels> voxels =
        makeVoxels(glm::ivec3(9), [&](const glm::dvec3&) { return (random() % 4) / 3.0; });
    const Points points{{0.0, {1, 1, 1, 0}},
                        {1 / 3.0, {1, 0, 0, 0.3}},
                        {2 / 3.0, {0, 1, 0, 0.9}},
                        {1.0, {0, 0, 1, 0.1}}};
    RenderOptions options;
    options.size(64, 64).perspective(40.0).lookAt({18, -12, 14}, {4, 4, 4}, {0, 0, 1});
    for (const auto how : {oracle::Grid::LINEAR, oracle::Grid::CUBIC}) {
        const auto grid = gridOf(*voxels, how);
        oracle::Volume reference = oracle::voxelVolume(grid, glm::ivec3(9), oracle::Table(points));
        oracle::classifySamples(reference, *grid, how);
        // The cubic overshoots below no extinction at all, where the library holds it at none.
        const FloatImage expected = expectedPicture(reference, options);
        osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
        volume->setLookupTable(makeTable(points));
        volume->setLookup(VolumeAppearance::BEFORE_INTERPOLATION);
        volume->setInterpolation(how == oracle::Grid::LINEAR ? VolumeAppearance::LINEAR
                                                             : VolumeAppearance::CUBIC);
        const double coarse = rmse(*volume, options, expected, 0.2);
        const double fine = rmse(*volume, options, expected, 0.1);
        // The clamp makes kinks, which cost some of the order.
        EXPECT_LT(fine, (how == oracle::Grid::LINEAR ? 0.35 : 0.5) * coarse);
    }
}

TEST_F(Transfer, ValuesBeyondTheRangeShowTheTablesEnds)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(
        glm::ivec3(17), [](const glm::dvec3& p) { return (p.x + 0.5 * p.y - 4.0) / 8.0; });
    RenderOptions options;
    options.size(64, 64).perspective(40.0).lookAt({35, -25, 30}, {8, 8, 8}, {0, 0, 1});
    const Points points{
        {0.0, {0.9, 0.1, 0.1, 0.1}}, {0.5, {0.2, 0.9, 0.1, 0.02}}, {1.0, {0.1, 0.1, 1.0, 0.15}}};
    const FloatImage expected =
        expectedPicture(oracle::voxelVolume(gridOf(*voxels, oracle::Grid::LINEAR), glm::ivec3(17),
                                            oracle::Table(points)),
                        options);
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
    volume->setLookupTable(makeTable(points));
    volume->setLookup(VolumeAppearance::PREINTEGRATED);
    EXPECT_LT(rmse(*volume, options, expected, 1.0), 2e-4);
    volume->setLookup(VolumeAppearance::AFTER_INTERPOLATION);
    EXPECT_LT(rmse(*volume, options, expected, 0.25), 2e-4);
}

TEST_F(Transfer, AChangeOfTableUploadsNoVoxels)
{
    osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(33), blob);
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
    for (const auto lookup :
         {VolumeAppearance::AFTER_INTERPOLATION, VolumeAppearance::BEFORE_INTERPOLATION,
          VolumeAppearance::PREINTEGRATED}) {
        volume->setLookup(lookup);
        volume->setLookupTable(makeTable(SMOOTH));
        support::SceneRenderer renderer(volume, view());
        const FloatImage before = renderer.render();
        EXPECT_EQ(renderer.counters().at("osgVolumizer bricks uploaded"), 1.0);
        volume->getLookupTable()->setPoints(JUMPS, LookupTable::RANGE_FRACTION);
        const FloatImage changed = renderer.render();
        EXPECT_EQ(renderer.counters().count("osgVolumizer bricks uploaded"), 0u);
        EXPECT_EQ(support::compare(changed, support::renderScene(volume, view())).maximum, 0.0);
        EXPECT_GT(support::compare(changed, before).rmse, 0.05);
    }
}

TEST(TransferTables, AreMadeOnceAndFineEnough)
{
    osg::ref_ptr<LookupTable> table = makeTable(SMOOTH);
    render::TableTextures textures;
    const osg::Vec2d range(0.0, 255.0);
    const auto first = textures.get(*table, range, VolumeAppearance::AUTOMATIC_LOOKUP);
    EXPECT_EQ(first.id, textures.get(*table, range, VolumeAppearance::AUTOMATIC_LOOKUP).id);
    EXPECT_FALSE(first.integrals);
    EXPECT_EQ(first.texture->getImage()->s(), first.count + 1);
    table->setPoints(PEAK, LookupTable::RANGE_FRACTION);
    const auto second = textures.get(*table, range, VolumeAppearance::AUTOMATIC_LOOKUP);
    EXPECT_NE(second.id, first.id);
    EXPECT_TRUE(second.integrals);
    EXPECT_EQ(second.texture->getImage()->s(), 2 * second.count + 1);
}

} // namespace TransferTest
