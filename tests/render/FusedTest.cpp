// Volumes that overlap, marched together.

#include "MixedScene.h"

#include <osgVolumizer/Error.h>
#include <osgVolumizer/render/context/ContextLimits.h>

#include <support/GLTest.h>
#include <support/Instrumented.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace FusedTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using render::ContextLimits;
using support::FloatImage;
using support::RenderOptions;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 33; // voxels per axis
const glm::dvec3 MIDDLE(0.5 * (SIZE - 1));
const Points WARM = {{0.0, {0.1, 0.3, 0.9, 0.02}}, {1.0, {1.0, 0.4, 0.1, 0.2}}};
const Points COLD = {{0.0, {0.1, 0.9, 0.3, 0.01}}, {1.0, {0.2, 0.2, 1.0, 0.25}}};
const Points STEPS = {{0.0, {0.1, 0.9, 0.3, 0.0}}, {0.5, {0.1, 0.9, 0.3, 0.0}},
                      {0.5, {1.0, 0.8, 0.1, 0.3}}, {0.7, {1.0, 0.8, 0.1, 0.3}},
                      {0.7, {0.2, 0.1, 0.9, 0.1}}, {1.0, {0.2, 0.1, 0.9, 0.1}}};

// Turned about its middle and moved: another way for each.
osg::Matrixd placement(int number)
{
    const double s = number;
    return osg::Matrixd::translate(-MIDDLE.x, -MIDDLE.y, -MIDDLE.z) *
           osg::Matrixd::rotate(0.4 * s, osg::Vec3d(0.3, 1.0, 0.5 - 0.1 * s)) *
           osg::Matrixd::translate(MIDDLE.x + 5 * std::sin(2.0 * s), MIDDLE.y + 4 * std::cos(s),
                                   MIDDLE.z + 3 * std::sin(s));
}

class Fused : public support::GLTest
{
protected:
    Fused()
    {
        _options.size(96, 96).perspective(40.0).lookAt({70, -50, 60}, {16, 16, 16}, {0, 0, 1});
    }
    void SetUp() override
    {
        GLTest::SetUp();
        clearLastError();
    }
    FloatImage picture(const MixedScene& scene) const
    {
        return support::renderScene(scene.root(), _options);
    }
    static MixedScene several(int count, double period = 1.0)
    {
        MixedScene scene;
        for (int i = 0; i < count; ++i)
            scene.addVolume(
                makeVoxels(glm::ivec3(SIZE),
                           [i](const glm::dvec3& p) { return bumps((1.0 - 0.05 * i) * p); }),
                i % 2 ? WARM : COLD, placement(i));
        scene.setPeriod(period);
        return scene;
    }
    double counted(const MixedScene& scene, const std::string& counter) const
    {
        support::SceneRenderer renderer(scene.root(), _options);
        renderer.render();
        return renderer.counters()[counter];
    }

    RenderOptions _options;
};

// A limit on what contexts can do, for volumes that are marched together.
RenderOptions limitedUnits(const RenderOptions& options, int units)
{
    return support::limited(options,
                            [units](ContextLimits& limits) { limits.textureUnits = units; });
}

// The difference between scenes, far from where rasterisers may disagree.
double rmse(const FloatImage& a, const FloatImage& b)
{
    return support::compare(a, b).rmse;
}

} // namespace

// Red and green of one density in one place are an even yellow.
TEST_F(Fused, ConstantPairIsExact)
{
    for (double period : {1.0, 4.0}) {
        MixedScene scene;
        for (const glm::dvec4& color : {glm::dvec4(1, 0, 0, 0.3), glm::dvec4(0, 1, 0, 0.3)})
            scene.addVolume(makeVoxels(glm::ivec3(32), bumps), constantPoints(color));
        scene.setPeriod(period);
        const Judged j = judge(scene, _options);
        save(j, "fused_constant_pair");
        EXPECT_GT(j.away.pixels, 2000u);
        EXPECT_LE(j.away.maximum, 1e-5);
    }
}

// Constant volumes that overlap in part: steps end where any of them does.
TEST_F(Fused, ConstantVolumesThatOverlapInPartAreExact)
{
    MixedScene scene;
    const std::array<glm::dvec4, 4> colors = {
        glm::dvec4(1, 0, 0, 0.1), {0, 1, 0, 0.05}, {0, 0, 1, 0.2}, {1, 1, 0, 0.07}};
    for (int i = 0; i < 4; ++i)
        scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), constantPoints(colors[i]),
                        placement(i));
    scene.setPeriod(3.0);
    const Judged j = judge(scene, _options);
    save(j, "fused_constant_four");
    EXPECT_LE(j.away.maximum, 2e-5);
}

// Together their error is what it is of each by itself, and falls as fast.
TEST_F(Fused, ErrorIsThatOfTheVolumesAlone)
{
    const std::vector<int> counts =
        support::INSTRUMENTED ? std::vector<int>{2} : std::vector<int>{2, 3, 6};
    for (int count : counts) {
        double alone = 0.0;
        for (int i = 0; i < count; ++i) {
            MixedScene one = several(count);
            for (int k = 0; k < count; ++k)
                one.root()->getChild(k)->setNodeMask(k == i ? ~0u : 0u);
            one.truth().volumes = {one.truth().volumes[i]};
            alone = std::max(alone, judge(one, _options).away.rmse);
        }
        std::vector<double> periods, errors;
        for (double period : {2.0, 1.0, 0.5}) {
            const Judged j = judge(several(count, period), _options);
            periods.push_back(period);
            errors.push_back(j.away.rmse);
            if (period == 1.0) save(j, "fused_" + std::to_string(count));
        }
        const double order = support::convergenceOrder(periods, errors);
        std::printf("  %d volumes: rmse %.2e, worst alone %.2e, order %.2f\n", count, errors[1],
                    alone, order);
        EXPECT_LE(errors[1], 1.5 * alone) << count;
        EXPECT_GE(order, 1.9) << count;
    }
}

// One pass, however many.
TEST_F(Fused, OneLeafAndNoIntervals)
{
    const MixedScene scene = several(8);
    EXPECT_EQ(counted(scene, "osgVolumizer volume leaves"), 1.0);
    EXPECT_EQ(counted(scene, "osgVolumizer draw calls"), 1.0);
}

// Samples of all are taken where all are, and nowhere else.
TEST_F(Fused, RaysPayForWhatTheyMeet)
{
    const RenderOptions options = support::countingSamples(_options);
    const auto samples = [&](unsigned mask) {
        MixedScene scene = several(4);
        for (unsigned k = 0; k < 4; ++k)
            scene.root()->getChild(k)->setNodeMask(mask >> k & 1u ? ~0u : 0u);
        double sum = 0.0;
        for (const glm::vec4& pixel : support::renderScene(scene.root(), options).pixels)
            sum += pixel.r;
        return sum;
    };
    double alone = 0.0;
    for (unsigned k = 0; k < 4; ++k)
        alone += samples(1u << k);
    // Steps end where any volume begins or ends: one more for each of the others' ends.
    const double together = samples(15u);
    std::printf("  samples together %.0f, one by one %.0f\n", together, alone);
    EXPECT_GT(alone, 1e5);
    EXPECT_LE(together, 1.2 * alone);
}

// Every kind of volume with every other, against the same drawn in thin slabs at a short period.
TEST_F(Fused, AllKindsOfVolumes)
{
    const auto make = [](double period) {
        MixedScene scene;
        const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
        VolumeAppearance& lit = scene.addVolume(voxels, WARM, placement(1));
        lit.setShading(true);
        scene.addVolume(voxels, STEPS, placement(2)).setLookup(A::PREINTEGRATED);
        scene.addVolume(voxels, COLD, placement(3)).setInterpolation(A::CUBIC);
        scene.addVolume(voxels, WARM, placement(4)).setLookup(A::BEFORE_INTERPOLATION);
        scene.addVolume(voxels, COLD, placement(5)).setExactFiltering(true);
        VolumeAppearance& iso = scene.addVolume(voxels, WARM, placement(6));
        iso.setRayFunction(A::ISOSURFACE);
        iso.setIsoValue(0.8);
        scene.addVolume(makeBlob(glm::ivec3(SIZE), 5.5), WARM, placement(7))
            .setCombineRule(A::PAINT);
        scene.setPeriod(period);
        return scene;
    };
    const FloatImage together = picture(make(0.5));
    RenderOptions apart = limitedUnits(_options, 7); // not even one volume
    const FloatImage slabs = support::renderScene(make(0.125).root(), apart);
    support::savePicture(together, "fused_kinds");
    support::savePicture(slabs, "fused_kinds_slabs");
    EXPECT_EQ(counted(make(1.0), "osgVolumizer volume leaves"), 1.0);
    EXPECT_LE(rmse(together, slabs), 4e-3);
}

// More than one march can have: two marches, in thin slabs, and a message.
TEST_F(Fused, NineVolumesAreMarchedInTwoGroups)
{
    const Judged j = judge(several(9), _options);
    save(j, "fused_nine");
    EXPECT_NE(getLastError().text.find("more volumes overlap"), std::string::npos)
        << getLastError().text;
    EXPECT_LE(j.away.rmse, 4e-3);
    EXPECT_GT(counted(several(9), "osgVolumizer volume leaves"), 10.0);
}

// A context with few texture units has smaller groups, or none.
TEST_F(Fused, FewTextureUnits)
{
    const FloatImage expected = picture(several(4, 0.5));
    for (int units : {16, 11, 6}) {
        const MixedScene scene = several(4, 0.5);
        const FloatImage image = support::renderScene(scene.root(), limitedUnits(_options, units));
        EXPECT_LE(rmse(image, expected), 2e-3) << units;
    }
}

// Units that turn out to be missing only when the frame is drawn: that frame shows all volumes one
// over the other, the next ones thin slabs.
TEST_F(Fused, TextureUnitsThatAreFoundMissingLate)
{
    const RenderOptions options = support::limited(_options, [](ContextLimits& limits) {
        limits.textureUnits = limits.version > 0.0 ? 8 : 32;
    });
    const MixedScene scene = several(3, 0.5);
    const FloatImage expected = picture(scene);
    support::SceneRenderer renderer(scene.root(), options);
    const FloatImage first = renderer.render();
    EXPECT_NE(getLastError().text.find("thin slabs"), std::string::npos) << getLastError().text;
    const FloatImage second = renderer.render();
    EXPECT_GT(support::coveredPixels(first).count(), 1000u);
    EXPECT_LE(rmse(first, expected), 0.2);
    EXPECT_LE(rmse(second, expected), 2e-3);
}

// Surfaces in two volumes are captured as those in one are, to the same error.
TEST_F(Fused, SurfacesInSeveralVolumes)
{
    std::vector<double> periods, errors;
    for (double period : {2.0, 1.0, 0.5}) {
        MixedScene scene = several(2, period);
        scene.addMesh(sphereMesh(MIDDLE, 9.0, 24, 12), {0.1, 0.9, 0.2, 0.6});
        scene.addQuad({glm::vec3(-4, 16, -4), {36, 16, -4}, {36, 16, 36}, {-4, 16, 36}},
                      {0.9, 0.1, 0.2, 0.4});
        const Judged j = judge(scene, _options);
        periods.push_back(period);
        errors.push_back(j.away.rmse);
        std::printf("  period %g: rmse %.2e\n", period, j.away.rmse);
        if (period != 1.0) continue;
        save(j, "fused_surfaces");
        // The surfaces' rectangle, and the rest: one interval.
        EXPECT_LE(counted(scene, "osgVolumizer intervals"), 1.0);
        EXPECT_LE(counted(scene, "osgVolumizer volume leaves"), 2.0);
    }
    EXPECT_LE(errors[1], 4e-4);
    EXPECT_GE(support::convergenceOrder(periods, errors), 1.9);
}

// Surfaces that reach beyond the volumes show there too.
TEST_F(Fused, SurfacesReachBeyondTheVolumes)
{
    MixedScene scene = several(2);
    scene.addQuad({glm::vec3(-20, 16, -20), {60, 16, -20}, {60, 16, 60}, {-20, 16, 60}},
                  {0.9, 0.1, 0.2, 0.4});
    const Judged j = judge(scene, _options);
    save(j, "fused_beyond");
    EXPECT_LE(j.away.maximum, 4e-3);
}

// So are those in a volume whose bricks cannot share a texture: the same samples as in one brick.
TEST_F(Fused, SurfacesInBricksThatShareNoTexture)
{
    const auto make = [](int brick) {
        MixedScene scene;
        const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
        if (brick > 0) {
            EXPECT_TRUE(voxels->setBrickSize(osg::Vec3i(brick, brick, brick)).ok());
        }
        scene.addVolume(voxels, WARM);
        scene.addMesh(sphereMesh(MIDDLE, 9.0, 24, 12), {0.1, 0.9, 0.2, 0.6});
        return scene;
    };
    const RenderOptions apart = support::joining(_options, false);
    const FloatImage whole = picture(make(0));
    support::SceneRenderer renderer(make(18).root(), apart);
    const FloatImage bricks = renderer.render();
    support::savePicture(bricks, "fused_bricks");
    EXPECT_LE(support::compare(bricks, whole).maximum, 1e-4);
    for (const auto& known : renderer.counters())
        EXPECT_TRUE(known.first != "osgVolumizer intervals" || known.second <= 1.0);
}

} // namespace FusedTest
