// Pages that opaque geometry hides are neither read nor missing.

#include "MixedScene.h"
#include "PagedScene.h"

#include <osgVolumizer/Paging.h>

#include <support/GLTest.h>

namespace HiddenPagesTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using namespace osgVolumizer::test::paged;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 128;
const osg::Vec3d EYE(64, -250, 64);

RenderOptions viewFrom(const osg::Vec3d& eye)
{
    return viewOf(SIZE, eye).size(160, 140);
}

// A wall at y, from x on to beyond the volume.
osg::ref_ptr<osg::Geometry> wall(float x, float y)
{
    return makeGeometry(
        quadMesh({glm::vec3(x, y, -400), {900, y, -400}, {900, y, 500}, {x, y, 500}}),
        {0.4, 0.5, 0.3, 1.0}, true);
}

osg::ref_ptr<osg::Group> sceneOf(A* volume, osg::Node* other)
{
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->addChild(volume);
    if (other) scene->addChild(other);
    return scene;
}

osg::ref_ptr<A> inMemory()
{
    static const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), waves);
    const osg::ref_ptr<A> volume = makeVolume(voxels);
    volume->setLookupTable(makeTable(smoothPoints(0.05)));
    return volume;
}

class HiddenPages : public support::GLTest
{
protected:
    // One thread, which reads the most urgent first.
    void SetUp() override
    {
        GLTest::SetUp();
        PagingBudget budget = defaultPagingBudget();
        budget.threads = 1;
        setPagingBudget(budget);
        source->give(0);
    }
    void TearDown() override
    {
        source->giveAll();
        setPagingBudget(defaultPagingBudget());
    }

    // Draws until nothing is missing for some frames: what was final may be no longer a frame
    // later. The source answers a few reads a frame, so that it does not matter how fast it is.
    FloatImage settleSlowly(support::SceneRenderer& renderer) const
    {
        int inARow = 0;
        return renderUntil(renderer, [&](const FloatImage&) {
            source->give(6);
            const bool final = renderer.counters()["osgVolumizer pages missing"] == 0.0;
            inARow = final ? inARow + 1 : 0;
            return inARow > 6;
        });
    }

    osg::ref_ptr<FormulaSource> source = new FormulaSource(SIZE, waves);
    osg::ref_ptr<A> volume = volumeOf(source);
};

} // namespace

TEST_F(HiddenPages, BehindAWallNothingFineIsRead)
{
    support::SceneRenderer renderer(sceneOf(volume, wall(-900, -20)), viewFrom(EYE));
    const FloatImage picture = settleSlowly(renderer);
    source->giveAll();
    const int before = readsOf(*source);
    for (int frame = 0; frame < 20; ++frame)
        renderer.render();
    EXPECT_EQ(renderer.counters()["osgVolumizer pages missing"], 0.0);
    EXPECT_EQ(renderer.counters()["osgVolumizer pages waited for"], 0.0);
    EXPECT_GT(renderer.counters()["osgVolumizer pages hidden"], 0.0);
    EXPECT_EQ(readsOf(*source), before);
    EXPECT_LT(before, 100) << "of 585";
    EXPECT_LT(
        largest(picture, support::renderScene(sceneOf(inMemory(), wall(-900, -20)), viewFrom(EYE))),
        1e-5);
}

TEST_F(HiddenPages, WhatShowsIsExactAndTheRestComesWhenItShows)
{
    // Of the right half, what is behind the middle.
    const osg::ref_ptr<osg::Geometry> half = wall(64, 40);
    support::SceneRenderer renderer(sceneOf(volume, half), viewFrom(EYE));
    const auto compareFrom = [&](const osg::Vec3d& eye, osg::Node* other) {
        renderer.options().lookAt(eye, {63.5, 63.5, 63.5}, {0, 0, 1});
        const FloatImage picture = settleSlowly(renderer);
        const FloatImage expected = support::renderScene(sceneOf(inMemory(), other), viewFrom(eye));
        EXPECT_LT(largest(picture, expected), 1e-4);
        support::savePicture(picture, "pages_half_hidden");
    };
    compareFrom(EYE, half);
    const double hidden = renderer.counters()["osgVolumizer pages hidden"];
    EXPECT_GT(hidden, 10.0);
    EXPECT_LT(readsOf(*source), 480) << "of 585";
    const int before = readsOf(*source);
    // From the other side all of it shows.
    compareFrom({64, 380, 64}, half);
    EXPECT_GT(readsOf(*source), before);
    // And from here again once the wall has gone.
    compareFrom(EYE, half);
    half->setNodeMask(0);
    compareFrom(EYE, nullptr);
    EXPECT_EQ(renderer.counters()["osgVolumizer pages hidden"], 0.0);
}

// Details that coarser levels do not show are found all the same: what a coarse page does not show
// of a visible part is not hidden.
TEST_F(HiddenPages, SparksAreNotLost)
{
    const auto sparks = [](const glm::dvec3& p) {
        const glm::dvec3 d = glm::abs(p - glm::dvec3(39.5, 29.5, 69.5));
        return std::max({d.x, d.y, d.z}) < 0.6 ? 1.0 : 0.0;
    };
    source = new FormulaSource(SIZE, sparks);
    volume = volumeOf(source);
    source->give(0);
    volume->setLookupTable(
        makeTable({{0.0, {1, 1, 1, 0}}, {0.9, {1, 1, 1, 0}}, {1.0, {1, 1, 1, 1}}}));
    const osg::ref_ptr<osg::Geometry> half = wall(64, 40);
    const RenderOptions view = viewFrom(EYE).perspective(15.0);
    support::SceneRenderer renderer(sceneOf(volume, half), view);
    const FloatImage picture = settleSlowly(renderer);
    const osg::ref_ptr<A> expected = makeVolume(makeVoxels(glm::ivec3(SIZE), sparks));
    expected->setLookupTable(volume->getLookupTable());
    const FloatImage there = support::renderScene(sceneOf(expected, half), view);
    EXPECT_LT(largest(picture, there), 1e-4);
    const FloatImage without = support::renderScene(sceneOf(new A, half), view);
    EXPECT_GT(largest(there, without), 0.2);
}

} // namespace HiddenPagesTest
