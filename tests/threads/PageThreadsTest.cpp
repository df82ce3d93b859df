// Pages of time steps that are read, uploaded, hidden and let go of while views in two contexts fly
// past, in every threading model. Built with -DOSGVOLUMIZER_SANITIZE=thread this is the test for
// data races of the threads that read.

#include "TwoContexts.h"

#include <render/MixedScene.h>
#include <render/PagedScene.h>

#include <osgVolumizer/Paging.h>

#include <support/GLTest.h>

namespace PageThreadsTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using namespace osgVolumizer::test::paged;
using A = VolumeAppearance;
using support::PictureTarget;

namespace {

constexpr int VOXELS = 60, STEPS = 3;
constexpr unsigned FLIGHT = 40, SHOT = 64;

double valueAt(const glm::dvec3& p, int step)
{
    return waves(p + glm::dvec3(7.0 * step, 0.0, 0.0));
}

RenderOptions viewAt(double angle)
{
    return RenderOptions()
        .size(SHOT, SHOT)
        .perspective(40.0)
        .lookAt(osg::Vec3d(30 + 120 * std::cos(angle), 30 + 120 * std::sin(angle), 70),
                {30, 30, 30}, {0, 0, 1});
}

class PageThreads : public support::GLTest,
                    public ::testing::WithParamInterface<osgViewer::ViewerBase::ThreadingModel>
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        PagingBudget budget = defaultPagingBudget();
        budget.memoryBytes = budget.textureBytes = 2 << 20;
        budget.threads = 4;
        ASSERT_TRUE(setPagingBudget(budget));
    }
    void TearDown() override { setPagingBudget(defaultPagingBudget()); }
};

osg::ref_ptr<osg::Group> sceneOf(A* volume)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(volume);
    scene->addChild(
        makeGeometry(quadMesh({glm::vec3(30, 15, -40), {90, 15, -40}, {90, 15, 90}, {30, 15, 90}}),
                     {0.4, 0.5, 0.3, 1.0}, true));
    return scene;
}

} // namespace

TEST_P(PageThreads, AFlightEndsWithThePictureOfAVolumeInMemory)
{
    const osg::ref_ptr<A> volume =
        volumeOf(new FormulaSource(VOXELS, STEPS, valueAt, VoxelType::UINT8));
    volume->setTimeRate(1.0);
    RenderOptions options = viewAt(0.0);
    options.threading = GetParam();
    support::SceneRenderer renderer(sceneOf(volume), options);
    osgViewer::Viewer& viewer = renderer.viewer();
    const osg::ref_ptr<PictureTarget> target = addSecondContext(viewer, SHOT, SHOT);
    for (unsigned frame = 0; frame < FLIGHT; ++frame) {
        renderer.options().view = viewAt(0.15 * frame).view;
        renderer.options().time = 0.1 * frame;
        renderer.render();
    }
    renderer.options().view = viewAt(-1.2).view;
    renderer.options().time = 1.5;
    const FloatImage picture = settle(renderer);
    viewer.stopThreading();
    const osg::ref_ptr<A> expected =
        makeVolume(makeVoxels(glm::ivec3(VOXELS), [](const glm::dvec3& p) {
            return std::floor(255.0 * valueAt(p, 1) + 0.5) / 255.0;
        }));
    expected->setLookupTable(volume->getLookupTable());
    const FloatImage there = support::renderScene(sceneOf(expected), viewAt(-1.2));
    EXPECT_LT(support::compare(picture, there, support::coveredPixels(there)).rmse, 4e-3);
    EXPECT_EQ(renderer.glError(), 0u);
    EXPECT_EQ(target->glError(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Models, PageThreads, ::testing::ValuesIn(THREADING_MODELS));

} // namespace PageThreadsTest
