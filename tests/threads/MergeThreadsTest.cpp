// A mixed scene that changes while it is drawn, in every threading model, with two contexts. Built
// with -DOSGVOLUMIZER_SANITIZE=thread this is the test for data races.

#include "TwoContexts.h"

#include <render/MixedScene.h>

#include <support/GLTest.h>

namespace MergeThreadsTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::PictureTarget;
using support::RenderOptions;

namespace {

constexpr int SIZE = 17; // voxels per axis
constexpr unsigned FRAMES = 24;
const Points THIN = {{0.0, {0.1, 0.3, 0.9, 0.02}}, {1.0, {1.0, 0.4, 0.1, 0.2}}};

/// A scene whose every part changes from frame to frame, and stands still from the last one on.
class Changing : public osg::NodeCallback
{
public:
    explicit Changing(MixedScene& scene) : _scene(scene)
    {
        _voxels[0] = makeVoxels(glm::ivec3(SIZE), bumps);
        _voxels[1] = makeBlob(glm::ivec3(SIZE), 4.0);
        for (Voxels* voxels : {_voxels[0].get(), _voxels[1].get()})
            voxels->setBrickSize({9, 9, 9}); // eight bricks, in one texture
        scene.addVolume(_voxels[0], THIN);
        scene.addVolume(_voxels[1], THIN, osg::Matrixd::translate(6, 3, 4));
        _quad = &scene.addQuad({glm::vec3(-3, -2, 1), {19, 0, 3}, {20, 18, 15}, {-2, 15, 12}},
                               {0.1, 0.9, 0.2, 0.6});
        _quad->setDataVariance(osg::Object::DYNAMIC);
        _quad->setUseDisplayList(false);
        _quad->setUseVertexBufferObjects(true);
        _sphere = &scene.addMesh(sphereMesh({8, 9, 7}, 5.0, 16, 8), {0.9, 0.1, 0.2, 0.4});
        _transform = dynamic_cast<osg::MatrixTransform*>(scene.root()->getChild(1));
        _corners = new osg::Vec3Array(*static_cast<osg::Vec3Array*>(_quad->getVertexArray()));
        scene.root()->setUpdateCallback(this);
    }
    void operator()(osg::Node* node, osg::NodeVisitor* visitor) override
    {
        change(++_frame);
        traverse(node, visitor);
    }

private:
    void change(unsigned frame)
    {
        const bool still = frame >= FRAMES;
        const double phase = still ? 0.0 : 0.3 * frame;
        _transform->setMatrix(osg::Matrixd::translate(6 + 3 * std::sin(phase), 3, 4));
        auto* vertices = static_cast<osg::Vec3Array*>(_quad->getVertexArray());
        for (unsigned i = 0; i < 4; ++i)
            (*vertices)[i] = (*_corners)[i] + osg::Vec3(0, 0, 2.0f * float(std::sin(phase)));
        vertices->dirty();
        _quad->dirtyBound();
        // Nodes leave and come back.
        osg::Group& root = *_scene.root();
        const bool shown = still || frame % 5 != 3;
        if (shown && !root.containsNode(_sphere)) root.addChild(_sphere);
        if (!shown && root.containsNode(_sphere)) root.removeChild(_sphere);
        // Tables and voxels change.
        Points points = THIN;
        if (!still) points[1].color.a += 0.01 * (frame % 7);
        EXPECT_TRUE(_scene.volumes()[0]
                        ->getLookupTable()
                        ->setPoints(points, LookupTable::RANGE_FRACTION)
                        .ok());
        if (frame % 6 == 2) _voxels[1]->dirty(frame / 6);
        const double period = still || frame % 4 ? 1.0 : 0.5;
        EXPECT_TRUE(
            _scene.volumes()[1]->setSamplingPeriod(osg::Vec3d(period, period, period)).ok());
    }

    MixedScene& _scene;
    osg::ref_ptr<Voxels> _voxels[2];
    osg::ref_ptr<osg::Geometry> _quad, _sphere;
    osg::ref_ptr<osg::Vec3Array> _corners;
    osg::MatrixTransform* _transform = nullptr;
    unsigned _frame = 0;
};

RenderOptions viewOf()
{
    RenderOptions options;
    options.size(64, 64).perspective(40.0).lookAt({36, -26, 30}, {9, 9, 8}, {0, 0, 1});
    return options;
}

class MergeThreads : public support::GLTest,
                     public ::testing::WithParamInterface<osgViewer::ViewerBase::ThreadingModel>
{
};

TEST_P(MergeThreads, ChangingSceneEndsLikeAStillOne)
{
    FloatImage still;
    {
        MixedScene scene;
        const osg::ref_ptr<Changing> changing = new Changing(scene);
        RenderOptions options = viewOf();
        options.frames = FRAMES;
        still = support::renderScene(scene.root(), options);
        const Judged j = judge(scene, options);
        EXPECT_LE(j.all.rmse, 4e-3);
        save(j, "merge_threads");
    }
    MixedScene scene;
    const osg::ref_ptr<Changing> changing = new Changing(scene);
    RenderOptions options = viewOf();
    options.threading = GetParam();
    options.frames = FRAMES;
    support::SceneRenderer renderer(scene.root(), options);
    osgViewer::Viewer& viewer = renderer.viewer();
    const osg::ref_ptr<PictureTarget> target = addSecondContext(viewer, 64, 64);
    target->request(FRAMES);
    const FloatImage picture = renderer.render(), other = target->wait();
    viewer.stopThreading();
    EXPECT_EQ(renderer.glError(), 0u);
    EXPECT_EQ(target->glError(), 0u);
    EXPECT_LE(support::compare(picture, still).maximum, 1e-5);
    EXPECT_LE(support::compare(other, still).maximum, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Models, MergeThreads, ::testing::ValuesIn(THREADING_MODELS));

} // namespace

} // namespace MergeThreadsTest
