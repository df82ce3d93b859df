#include "HandMadeLeaves.h"

#include <osgVolumizer/render/merge/MergeGroups.h>

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <list>

namespace MergeGroupsTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using namespace osgVolumizer::render;

namespace {

// A bin with boxes that are volumes, and rectangles that are surfaces.
class Bin
{
public:
    /// Corners in the eye frame, as (x, y, depth).
    VolumeInstance* addVolume(const glm::dvec3& min, const glm::dvec3& max)
    {
        auto prepared = std::make_shared<PreparedGeometry>();
        prepared->regionBox.min = {min.x, min.y, -max.z};
        prepared->regionBox.max = {max.x, max.y, -min.z};
        _volumes.emplace_back();
        VolumeInstance& volume = _volumes.back();
        volume.prepared = prepared;
        volume.depth = {min.z, max.z};
        volume.leaf = keep(makeLeaf(makeRectangle({-1, -1}, {1, 1}, min.z)));
        return &volume;
    }
    osgUtil::RenderLeaf* addSurface(const osg::Vec2& min, const osg::Vec2& max, double depth,
                                    const osg::Matrixd& projection = boxProjection())
    {
        return keep(makeLeaf(makeRectangle(min, max, depth), projection));
    }
    MergeGroups groups()
    {
        std::vector<VolumeInstance*> volumes;
        for (VolumeInstance& volume : _volumes)
            volumes.push_back(&volume);
        std::vector<osgUtil::RenderLeaf*> leaves;
        for (const auto& leaf : _leaves)
            leaves.push_back(leaf.get());
        return findMergeGroups(volumes, leaves);
    }

private:
    osgUtil::RenderLeaf* keep(const osg::ref_ptr<osgUtil::RenderLeaf>& leaf)
    {
        _leaves.push_back(leaf);
        return leaf.get();
    }

    std::list<VolumeInstance> _volumes;
    std::vector<osg::ref_ptr<osgUtil::RenderLeaf>> _leaves;
};

const MergeGroup* groupOf(const MergeGroups& groups, const VolumeInstance* volume)
{
    for (const MergeGroup& group : groups.groups)
        if (std::count(group.volumes.begin(), group.volumes.end(), volume)) return &group;
    return nullptr;
}

bool holds(const MergeGroup& group, const osgUtil::RenderLeaf* leaf)
{
    return std::any_of(group.surfaces.begin(), group.surfaces.end(),
                       [&](const ForeignLeaf* surface) { return &surface->leaf() == leaf; });
}

} // namespace

TEST(MergeGroups, OverlapNeedsDepthAndScreen)
{
    const BoxInView a{{{0.0, 0.0}, {1.0, 1.0}}, {1.0, 2.0}};
    const BoxInView beside{{{1.0, 0.0}, {2.0, 1.0}}, {1.0, 2.0}};
    const BoxInView behind{{{0.0, 0.0}, {1.0, 1.0}}, {2.0, 3.0}};
    const BoxInView corner{{{0.9, 0.9}, {2.0, 2.0}}, {1.9, 3.0}};
    EXPECT_TRUE(overlaps(a, a));
    for (const BoxInView& b : {beside, behind}) {
        EXPECT_FALSE(overlaps(a, b));
        EXPECT_FALSE(overlaps(b, a));
    }
    EXPECT_TRUE(overlaps(a, corner) && overlaps(corner, a));
    EXPECT_TRUE(overlaps(beside, corner));
    EXPECT_TRUE(overlaps(behind, corner));
}

TEST(MergeGroups, VolumesInViewAreWhereTheirBoxIs)
{
    Bin bin;
    const BoxInView view = viewOf(*bin.addVolume({-5, 0, 20}, {5, 2, 30}));
    EXPECT_NEAR(glm::length(view.screen.min - glm::dvec2(-0.5, 0.0)), 0.0, 1e-12);
    EXPECT_NEAR(glm::length(view.screen.max - glm::dvec2(0.5, 0.2)), 0.0, 1e-12);
    EXPECT_EQ(view.depth.nearDepth, 20.0);
    EXPECT_EQ(view.depth.farDepth, 30.0);
}

TEST(MergeGroups, ApartOnTheScreenOrInDepthAreGroupsOfTheirOwn)
{
    Bin bin;
    const VolumeInstance* a = bin.addVolume({-5, -5, 10}, {0, 0, 20});
    const VolumeInstance* beside = bin.addVolume({1, -5, 10}, {5, 0, 20});
    const VolumeInstance* behind = bin.addVolume({-5, -5, 21}, {0, 0, 30});
    const MergeGroups groups = bin.groups();
    EXPECT_EQ(groups.groups.size(), 3u);
    EXPECT_TRUE(groups.surfaces.empty());
    for (const VolumeInstance* volume : {a, beside, behind})
        EXPECT_EQ(groupOf(groups, volume)->volumes.size(), 1u);
}

TEST(MergeGroups, OverlapIsPassedOn)
{
    // Each overlaps the next one only.
    Bin bin;
    for (int i = 0; i < 5; ++i)
        bin.addVolume({-9.0 + 3 * i, 0, 10}, {-5.0 + 3 * i, 1, 20});
    const VolumeInstance* away = bin.addVolume({-9, 2, 10}, {9, 3, 20});
    const MergeGroups groups = bin.groups();
    ASSERT_EQ(groups.groups.size(), 2u);
    EXPECT_EQ(groupOf(groups, away)->volumes.size(), 1u);
}

TEST(MergeGroups, ASurfaceJoinsTheVolumesThatItReachesInto)
{
    Bin bin;
    const VolumeInstance* left = bin.addVolume({-9, 0, 10}, {-5, 1, 20});
    const VolumeInstance* right = bin.addVolume({5, 0, 10}, {9, 1, 20});
    const VolumeInstance* low = bin.addVolume({-9, -5, 10}, {9, -4, 20});
    const osgUtil::RenderLeaf* through = bin.addSurface({-8, 0.2f}, {8, 0.8f}, 15);
    const MergeGroups groups = bin.groups();
    ASSERT_EQ(groups.groups.size(), 2u);
    EXPECT_EQ(groupOf(groups, left), groupOf(groups, right));
    EXPECT_TRUE(holds(*groupOf(groups, left), through));
    EXPECT_TRUE(groupOf(groups, low)->surfaces.empty());
}

TEST(MergeGroups, SurfacesThatReachIntoNoVolumeAreInNoGroup)
{
    Bin bin;
    const VolumeInstance* volume = bin.addVolume({-5, -5, 10}, {5, 5, 20});
    bin.addSurface({-9, -9}, {9, 9}, 25); // behind
    bin.addSurface({-9, -9}, {9, 9}, 5);  // in front
    bin.addSurface({6, -9}, {9, 9}, 15);  // beside
    const osgUtil::RenderLeaf* inside = bin.addSurface({4, 4}, {9, 9}, 15);
    const MergeGroups groups = bin.groups();
    ASSERT_EQ(groups.surfaces.size(), 1u);
    ASSERT_EQ(groupOf(groups, volume)->surfaces.size(), 1u);
    EXPECT_TRUE(holds(*groupOf(groups, volume), inside));
}

TEST(MergeGroups, WhatIsSeenInAnotherProjectionIsLeftAlone)
{
    Bin bin;
    bin.addVolume({-5, -5, 10}, {5, 5, 20});
    bin.addSurface({-4, -4}, {4, 4}, 15, osg::Matrixd::ortho(-11, 11, -10, 10, 0, 100));
    EXPECT_TRUE(bin.groups().surfaces.empty());
    // Near and far alone do not count.
    bin.addSurface({-4, -4}, {4, 4}, 15, osg::Matrixd::ortho(-10, 10, -10, 10, 3, 70));
    EXPECT_EQ(bin.groups().surfaces.size(), 1u);
}

TEST(MergeGroups, WithoutVolumesThereAreNone)
{
    Bin bin;
    bin.addSurface({-4, -4}, {4, 4}, 15);
    EXPECT_TRUE(bin.groups().groups.empty());
}

} // namespace MergeGroupsTest
