#include "HandMadeLeaves.h"

#include <osgVolumizer/render/merge/SurfaceMesh.h>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

namespace SurfaceMeshTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using namespace osgVolumizer::render;

namespace {

std::unique_ptr<SurfaceMesh> meshOf(osg::Drawable* drawable)
{
    const osg::ref_ptr<osgUtil::RenderLeaf> leaf = makeLeaf(drawable);
    const auto foreign = ForeignLeaf::examine(*leaf, boxProjection());
    return foreign ? SurfaceMesh::of(*foreign) : nullptr;
}

// A box of device coordinates, turned about its middle.
VolumeOutline outline(const glm::dvec2& middle, const glm::dvec2& halfSize, double degrees,
                      const core::DepthInterval& depth)
{
    VolumeOutline result;
    const double c = glm::cos(glm::radians(degrees)), s = glm::sin(glm::radians(degrees));
    for (int i = 0; i < 8; ++i) {
        const glm::dvec2 p(i & 1 ? halfSize.x : -halfSize.x, i & 2 ? halfSize.y : -halfSize.y);
        result.corners[i] = middle + glm::dvec2(c * p.x - s * p.y, s * p.x + c * p.y);
    }
    result.depth = depth;
    return result;
}

osg::ref_ptr<osg::Geometry> makeTriangle(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c)
{
    osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
    osg::ref_ptr<osg::Vec3Array> vertices = new osg::Vec3Array;
    for (const osg::Vec3& p : {a, b, c})
        vertices->push_back(p);
    geometry->setVertexArray(vertices);
    geometry->addPrimitiveSet(new osg::DrawArrays(GL_TRIANGLES, 0, 3));
    return geometry;
}

} // namespace

TEST(SurfaceMesh, LayersAreCounted)
{
    for (const int layers : {1, 2, 5}) {
        osg::ref_ptr<osg::Geometry> geometry = new osg::Geometry;
        for (int i = 0; i < layers; ++i)
            addRectangle(*geometry, {-5, -3}, {7, 4}, 10.0 + i, 24);
        const auto mesh = meshOf(geometry);
        ASSERT_TRUE(mesh);
        EXPECT_EQ(mesh->triangleCount(), 2u * 24u * 24u * unsigned(layers));
        EXPECT_NEAR(mesh->coverEstimate(), layers, 1e-4 * layers);
    }
}

TEST(SurfaceMesh, LayersAreCountedWhereTheyAreMost)
{
    osg::ref_ptr<osg::Geometry> geometry = makeRectangle({-6, -6}, {6, 6}, 10.0, 24);
    for (int i = 1; i <= 3; ++i)
        addRectangle(*geometry, {-6, -6}, {-3, 0}, 10.0 + i, 24);
    EXPECT_NEAR(meshOf(geometry)->coverEstimate(), 4.0, 1e-3);
    // What is seen from the side covers nothing.
    osg::ref_ptr<osg::Geometry> edge = makeTriangle({0, 0, -10}, {0, 0, -20}, {0, 5, -10});
    EXPECT_NEAR(meshOf(edge)->coverEstimate(), 0.0, 1e-6);
}

TEST(SurfaceMesh, IsWhereItsTrianglesAre)
{
    const auto mesh = meshOf(makeTriangle({-2, 0, -10}, {4, 0, -30}, {0, 5, -20}));
    ASSERT_TRUE(mesh);
    const BoxInView& view = mesh->view();
    EXPECT_NEAR(glm::length(view.screen.min - glm::dvec2(-0.2, 0.0)), 0.0, 1e-6);
    EXPECT_NEAR(glm::length(view.screen.max - glm::dvec2(0.4, 0.5)), 0.0, 1e-6);
    EXPECT_NEAR(view.depth.nearDepth, 10.0, 1e-4);
    EXPECT_NEAR(view.depth.farDepth, 30.0, 1e-4);
    EXPECT_LT(view.depth.nearDepth, 10.0); // what is flat still has a range
}

TEST(SurfaceMesh, TouchesWhatItOverlapsInDepthAndOnTheScreen)
{
    const auto mesh = meshOf(makeRectangle({-5, -5}, {5, 5}, 20.0, 4));
    EXPECT_TRUE(mesh->touches(outline({0, 0}, {0.1, 0.1}, 0, {10, 30}))); // within
    EXPECT_TRUE(mesh->touches(outline({0, 0}, {0.9, 0.9}, 0, {10, 30}))); // around
    EXPECT_TRUE(mesh->touches(outline({0.6, 0.6}, {0.2, 0.2}, 0, {10, 30})));
    EXPECT_FALSE(mesh->touches(outline({0, 0}, {0.9, 0.9}, 0, {21, 30})));
    EXPECT_FALSE(mesh->touches(outline({0, 0}, {0.9, 0.9}, 0, {10, 19})));
    EXPECT_FALSE(mesh->touches(outline({0.8, 0}, {0.2, 0.2}, 0, {10, 30})));
    EXPECT_FALSE(mesh->touches(outline({0, -0.8}, {0.2, 0.2}, 0, {10, 30})));
}

TEST(SurfaceMesh, HullsAreNotTheirRectangles)
{
    const auto mesh = meshOf(makeRectangle({0, 0}, {1, 1}, 20.0));
    // A thin box across the corner at (0.1, 0.1), whose rectangle holds it all.
    const VolumeOutline clear = outline({0.16, 0.16}, {0.5, 0.02}, -45, {10, 30});
    EXPECT_FALSE(mesh->touches(clear));
    EXPECT_TRUE(mesh->touches(outline({0.1, 0.1}, {0.5, 0.02}, -45, {10, 30})));
    // Pixels beside the hull count too.
    VolumeOutline wide = clear;
    wide.margin = glm::dvec2(0.06);
    EXPECT_TRUE(mesh->touches(wide));
    // A triangle's own edges separate as well.
    const auto triangle = meshOf(makeTriangle({0, 0, -20}, {4, 0, -20}, {0, 4, -20}));
    EXPECT_FALSE(triangle->touches(outline({0.35, 0.35}, {0.1, 0.1}, 0, {10, 30})));
    EXPECT_TRUE(triangle->touches(outline({0.25, 0.25}, {0.1, 0.1}, 0, {10, 30})));
}

TEST(SurfaceMesh, NeedsDepthOfOneTriangleOnly)
{
    // The mesh's depths overlap the box's, but no triangle's do where they meet on the screen.
    osg::ref_ptr<osg::Geometry> geometry = makeRectangle({-5, -5}, {-1, 5}, 10.0);
    addRectangle(*geometry, {1, -5}, {5, 5}, 30.0);
    const auto mesh = meshOf(geometry);
    EXPECT_FALSE(mesh->touches(outline({0, 0}, {0.9, 0.9}, 0, {15, 25})));
    EXPECT_FALSE(mesh->touches(outline({-0.3, 0}, {0.15, 0.9}, 0, {25, 35})));
    EXPECT_TRUE(mesh->touches(outline({0.3, 0}, {0.15, 0.9}, 0, {25, 35})));
}

TEST(SurfaceMesh, BehindTheEyeDepthAloneDecides)
{
    const auto mesh = meshOf(makeRectangle({-5, -5}, {-4, -4}, 20.0));
    VolumeOutline everywhere = outline({0.5, 0.5}, {0.1, 0.1}, 0, {10, 30});
    EXPECT_FALSE(mesh->touches(everywhere));
    everywhere.everywhere = true;
    EXPECT_TRUE(mesh->touches(everywhere));
    everywhere.depth = {21, 30};
    EXPECT_FALSE(mesh->touches(everywhere));
}

TEST(SurfaceMesh, IsNothingWhereTrianglesAreNotKnown)
{
    osg::ref_ptr<osg::Geometry> lines = makeTriangle({0, 0, -20}, {4, 0, -20}, {0, 4, -20});
    lines->setPrimitiveSet(0, new osg::DrawArrays(GL_LINE_LOOP, 0, 3));
    EXPECT_FALSE(meshOf(lines));
    osg::ref_ptr<osg::Geometry> instances = makeTriangle({0, 0, -20}, {4, 0, -20}, {0, 4, -20});
    instances->getPrimitiveSet(0)->setNumInstances(2);
    EXPECT_FALSE(meshOf(instances));
    osg::ref_ptr<osg::Geometry> called = makeTriangle({0, 0, -20}, {4, 0, -20}, {0, 4, -20});
    called->setDrawCallback(new osg::Drawable::DrawCallback);
    EXPECT_FALSE(meshOf(called));
    osg::ref_ptr<osg::Geometry> broken = makeRectangle({0, 0}, {1, 1}, 20.0);
    static_cast<osg::DrawElementsUInt*>(broken->getPrimitiveSet(0))->push_back(99);
    static_cast<osg::DrawElementsUInt*>(broken->getPrimitiveSet(0))->push_back(1);
    static_cast<osg::DrawElementsUInt*>(broken->getPrimitiveSet(0))->push_back(2);
    EXPECT_FALSE(meshOf(broken));
}

} // namespace SurfaceMeshTest
