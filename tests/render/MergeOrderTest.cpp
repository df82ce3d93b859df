// The order of nodes does not show, and what is cut in two looks like what was whole.

#include "MixedScene.h"

#include <support/GLTest.h>

#include <osg/Depth>

namespace MergeOrderTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 33; // voxels per axis
const glm::dvec3 MIDDLE(0.5 * (SIZE - 1));
const Points WARM = {{0.0, {0.1, 0.3, 0.9, 0.02}}, {1.0, {1.0, 0.4, 0.1, 0.2}}};
const Points COLD = {{0.0, {0.1, 0.9, 0.3, 0.01}}, {1.0, {0.2, 0.2, 1.0, 0.25}}};

class MergeOrder : public support::GLTest
{
protected:
    MergeOrder()
    {
        _options.size(128, 128).perspective(40.0).lookAt({70, -50, 60}, {16, 16, 16}, {0, 0, 1});
    }
    FloatImage picture(const MixedScene& scene) const
    {
        return support::renderScene(scene.root(), _options);
    }
    support::Difference swapped(MixedScene& scene, const std::string& name) const
    {
        const FloatImage before = picture(scene);
        scene.reverse();
        const FloatImage after = picture(scene);
        support::savePicture(before, "merge_order_" + name);
        return support::compare(after, before);
    }

    RenderOptions _options;
};

TEST_F(MergeOrder, OverlappingVolumes)
{
    MixedScene scene;
    scene.addVolume(makeBlob(glm::ivec3(SIZE), 5.5), WARM);
    scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), COLD,
                    osg::Matrixd::rotate(0.5, osg::Vec3d(0.3, 1.0, 0.5)) *
                        osg::Matrixd::translate(9, 4, 6));
    EXPECT_LE(swapped(scene, "volumes").maximum, 1e-6);
}

// Two of one place and shape, that no rule about depth can tell apart.
TEST_F(MergeOrder, CongruentVolumes)
{
    MixedScene scene;
    scene.addVolume(makeBlob(glm::ivec3(SIZE), 5.5), WARM);
    scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), COLD);
    EXPECT_LE(swapped(scene, "congruent").maximum, 1e-6);
}

TEST_F(MergeOrder, VolumesAndSurfaces)
{
    MixedScene scene;
    scene.addVolume(makeBlob(glm::ivec3(SIZE), 5.5), WARM);
    scene.addMesh(sphereMesh(MIDDLE, 6.0, 24, 12), {0.1, 0.9, 0.2, 0.6});
    scene.addQuad({glm::vec3(-4, 16, -4), {36, 16, -4}, {36, 16, 36}, {-4, 16, 36}},
                  {0.9, 0.1, 0.2, 0.4});
    scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), COLD,
                    osg::Matrixd::rotate(0.5, osg::Vec3d(0.3, 1.0, 0.5)) *
                        osg::Matrixd::translate(9, 4, 6));
    scene.addQuad({glm::vec3(16, -4, -4), {16, 36, -4}, {16, 36, 36}, {16, -4, 36}},
                  {0.2, 0.3, 1.0, 0.5});
    EXPECT_LE(swapped(scene, "surfaces").maximum, 1e-6);
}

// The order of nodes falls out entirely, at any period.
TEST_F(MergeOrder, NodeOrderFallsOut)
{
    for (double period : {4.0, 2.0, 1.0, 0.5}) {
        MixedScene scene;
        scene.addVolume(makeBlob(glm::ivec3(SIZE), 5.5), WARM);
        scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), COLD);
        scene.addVolume(makeVoxels(glm::ivec3(SIZE), bumps), WARM,
                        osg::Matrixd::translate(3, -5, 8));
        scene.setPeriod(period);
        EXPECT_LE(swapped(scene, "three").maximum, 1e-6) << period;
    }
}

// The opacity of half of the extinction.
Points halved(Points points)
{
    for (auto& p : points)
        p.color.a = 1.0 - std::sqrt(1.0 - p.color.a);
    return points;
}

/// Enough points that opacities halved at points are halved between them.
Points densePoints()
{
    Points points;
    for (int i = 0; i <= 256; ++i) {
        const double f = i / 256.0;
        points.push_back({f, glm::mix(WARM[0].color, WARM[1].color, f)});
    }
    return points;
}

// Extinctions add: half twice is the whole.
TEST_F(MergeOrder, TwoHalfDenseCopiesAreTheWhole)
{
    const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    MixedScene whole, halves;
    whole.addVolume(voxels, densePoints());
    halves.addVolume(voxels, halved(densePoints()));
    halves.addVolume(voxels, halved(densePoints()));
    // Alone a ray's length is a whole number of steps, together it need not be: equal up to the
    // error of sampling.
    whole.setPeriod(0.5);
    halves.setPeriod(0.5);
    const FloatImage one = picture(whole), two = picture(halves);
    support::savePicture(two, "merge_order_half_dense");
    EXPECT_LE(support::compare(two, one).maximum, 1e-3);
}

// Two boxes of geometry that share a region: dense once where one of them is, twice where both are.
// Cut to share nothing they are the whole; sharing a slice they are what the oracle adds up.
TEST_F(MergeOrder, TwoPartsOfSpace)
{
    const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    const double top = SIZE - 1;
    MixedScene whole;
    whole.addVolume(voxels, WARM);
    whole.setPeriod(0.5);
    const FloatImage one = picture(whole);
    for (const double shared : {0.0, 6.0}) {
        MixedScene parts;
        const core::Box3d boxes[2] = {{glm::dvec3(0.0), {17.3 + shared, top, top}},
                                      {{17.3, 0.0, 0.0}, glm::dvec3(top)}};
        for (const core::Box3d& box : boxes) {
            osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
            appearance->setVoxels(voxels);
            appearance->setLookupTable(makeTable(WARM));
            appearance->addChild(VolumeGeometry::createBox(osg::BoundingBoxd(
                box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z)));
            parts.adopt(*appearance);
            oracle::Volume truth =
                oracle::voxelVolume(gridOf(*voxels), glm::ivec3(SIZE), oracle::Table(WARM));
            truth.region = oracle::boxRegion(box);
            parts.truth().volumes.push_back(truth);
        }
        parts.setPeriod(0.5);
        const Judged j = judge(parts, _options);
        save(j, shared > 0.0 ? "merge_order_shared" : "merge_order_split");
        EXPECT_LE(j.all.rmse, 4e-3) << shared;
        EXPECT_LE(j.away.maximum, 4e-3) << shared;
        if (shared > 0.0) continue;
        EXPECT_LE(support::compare(j.picture, one).maximum, 1e-3);
    }
}

} // namespace

} // namespace MergeOrderTest
