// Hierarchical models: parts of one volume under transforms of their own, like a jaw and its skull.

#include "MixedScene.h"

#include <support/GLTest.h>

namespace MergePartsTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 33; // voxels per axis
constexpr double CUT = 17.3;
const Points WARM = {{0.0, {0.1, 0.3, 0.9, 0.02}}, {1.0, {1.0, 0.4, 0.1, 0.2}}};
const Points COLD = {{0.0, {0.1, 0.9, 0.3, 0.01}}, {1.0, {0.2, 0.2, 1.0, 0.25}}};

core::Box3d half(int i)
{
    const double top = SIZE - 1;
    return i == 0 ? core::Box3d{glm::dvec3(0.0), {CUT, top, top}}
                  : core::Box3d{{CUT, 0.0, 0.0}, glm::dvec3(top)};
}

osg::ref_ptr<osg::MatrixTransform> part(int i)
{
    const core::Box3d b = half(i);
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform;
    transform->addChild(VolumeGeometry::createBox(
        osg::BoundingBoxd(b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z)));
    return transform;
}

osg::ref_ptr<VolumeAppearance> appearance(Voxels* voxels, const Points& points)
{
    osg::ref_ptr<VolumeAppearance> node = new VolumeAppearance;
    node->setVoxels(voxels);
    node->setLookupTable(makeTable(points));
    return node;
}

oracle::Volume truthOf(const Voxels& voxels, int i, const Points& points, const osg::Matrixd& place)
{
    oracle::Volume truth =
        oracle::voxelVolume(gridOf(voxels), glm::ivec3(SIZE), oracle::Table(points));
    truth.region = oracle::boxRegion(half(i));
    truth.objectToWorld = support::toGlm(place);
    return truth;
}

class MergeParts : public support::GLTest
{
protected:
    MergeParts() : _voxels(makeVoxels(glm::ivec3(SIZE), bumps))
    {
        _options.size(96, 96).perspective(40.0).lookAt({70, -50, 60}, {16, 16, 16}, {0, 0, 1});
    }

    osg::ref_ptr<Voxels> _voxels;
    RenderOptions _options;
};

// The jaw opens and shuts: closed, no seam shows, wherever both are moved.
TEST_F(MergeParts, TouchWithoutSeams)
{
    const osg::ref_ptr<VolumeAppearance> shared = appearance(_voxels, WARM);
    const osg::ref_ptr<osg::MatrixTransform> parts[2] = {part(0), part(1)};
    for (const auto& p : parts)
        shared->addChild(p);
    const osg::ref_ptr<VolumeAppearance> whole = appearance(_voxels, WARM);
    const osg::ref_ptr<osg::MatrixTransform> all = new osg::MatrixTransform;
    all->addChild(VolumeGeometry::createBox(*_voxels));
    whole->addChild(all);
    for (const auto& node : {shared, whole})
        node->setSamplingPeriod(osg::Vec3d(0.5, 0.5, 0.5));
    support::SceneRenderer moving(shared, _options), still(whole, _options);
    for (int frame = 0; frame < 6; ++frame) {
        const osg::Matrixd pose = osg::Matrixd::rotate(0.2 * frame, osg::Vec3d(0.3, 1.0, 0.5)) *
                                  osg::Matrixd::translate(1.5 * frame, 0.0, -frame);
        all->setMatrix(pose);
        for (const auto& p : parts)
            p->setMatrix(pose);
        const FloatImage one = still.render(), two = moving.render();
        if (frame == 3) support::savePicture(two, "merge_parts_closed");
        ASSERT_GT(support::coveredPixels(one).count(), 1500u);
        EXPECT_LE(support::compare(two, one).maximum, 1e-3) << frame;
    }
}

// Open, with a plane through the gap, each part in a look of its own or sharing one.
TEST_F(MergeParts, MovedApart)
{
    const osg::Matrixd poses[2] = {osg::Matrixd::translate(-4, 0, 0),
                                   osg::Matrixd::rotate(-0.4, osg::Vec3d(0, 1, 0)) *
                                       osg::Matrixd::translate(2, 0, 5)};
    for (const bool sharing : {true, false}) {
        MixedScene scene;
        osg::ref_ptr<VolumeAppearance> looks[2] = {appearance(_voxels, WARM), nullptr};
        looks[1] = sharing ? looks[0] : appearance(_voxels, COLD);
        for (int i = 0; i < 2; ++i) {
            const osg::ref_ptr<osg::MatrixTransform> p = part(i);
            p->setMatrix(poses[i]);
            looks[i]->addChild(p);
            scene.truth().volumes.push_back(
                truthOf(*_voxels, i, i == 0 || sharing ? WARM : COLD, poses[i]));
        }
        scene.adopt(*looks[0]);
        if (!sharing) scene.adopt(*looks[1]);
        scene.addQuad({glm::vec3(-10, -6, 14), {44, -6, 18}, {44, 40, 20}, {-10, 40, 16}},
                      {0.1, 0.9, 0.2, 0.5});
        const Judged j = judge(scene, _options);
        save(j, sharing ? "merge_parts_open" : "merge_parts_looks");
        EXPECT_GT(j.away.pixels, 1500u);
        EXPECT_LE(j.all.rmse, 4e-3);
        EXPECT_LE(j.away.maximum, 6e-3);
    }
}

} // namespace

} // namespace MergePartsTest
