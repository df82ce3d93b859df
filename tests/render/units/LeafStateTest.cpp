#include <osgVolumizer/render/context/LeafState.h>

#include <osg/ClipControl>
#include <osg/ColorMask>

#include <gtest/gtest.h>

#include <vector>

namespace LeafStateTest {

using namespace osgVolumizer::render;
using osg::StateAttribute;

namespace {

// State sets one below the other, and the graph's end.
class Path
{
public:
    osg::StateSet& below()
    {
        _sets.push_back(new osg::StateSet);
        _leaf = _leaf->find_or_insert(_sets.back());
        return *_sets.back();
    }
    const osgUtil::StateGraph* leaf() const { return _leaf; }

private:
    osg::ref_ptr<osgUtil::StateGraph> _root = new osgUtil::StateGraph;
    std::vector<osg::ref_ptr<osg::StateSet>> _sets;
    osgUtil::StateGraph* _leaf = _root.get();
};

constexpr unsigned ON = StateAttribute::ON, OFF = StateAttribute::OFF,
                   OVERRIDE = StateAttribute::OVERRIDE, PROTECTED = StateAttribute::PROTECTED;

} // namespace

TEST(LeafState, TheLowestModeCountsUnlessOneAboveOverrides)
{
    struct Case
    {
        unsigned above, below;
        bool expected;
    };
    for (const Case& c :
         {Case{ON, OFF, false}, Case{OFF, ON, true}, Case{ON | OVERRIDE, OFF, true},
          Case{OFF | OVERRIDE, ON, false}, Case{ON | OVERRIDE, OFF | PROTECTED, false},
          Case{OFF | OVERRIDE, ON | PROTECTED, true}, Case{OFF, ON | OVERRIDE, true}}) {
        Path path;
        path.below().setMode(GL_BLEND, c.above);
        path.below().setMode(GL_BLEND, c.below);
        path.below(); // says nothing about it
        EXPECT_EQ(isOn(path.leaf(), GL_BLEND, !c.expected), c.expected)
            << c.above << " " << c.below;
    }
    Path silent;
    silent.below();
    EXPECT_TRUE(isOn(silent.leaf(), GL_BLEND, true));
    EXPECT_FALSE(isOn(silent.leaf(), GL_BLEND, false));
    EXPECT_TRUE(isOn(nullptr, GL_BLEND, true));
}

TEST(LeafState, TheSameForAttributes)
{
    const auto depth = [](osg::Depth::Function function) { return new osg::Depth(function); };
    const auto found = [](const Path& path) {
        return effective<osg::Depth>(path.leaf(), StateAttribute::DEPTH)->getFunction();
    };
    Path plain;
    EXPECT_EQ(effectiveAttribute(plain.leaf(), StateAttribute::DEPTH), nullptr);
    plain.below().setAttribute(depth(osg::Depth::ALWAYS), ON);
    plain.below().setAttribute(depth(osg::Depth::NEVER), ON);
    EXPECT_EQ(found(plain), osg::Depth::NEVER);

    Path overridden;
    overridden.below().setAttribute(depth(osg::Depth::ALWAYS), ON | OVERRIDE);
    overridden.below().setAttribute(depth(osg::Depth::NEVER), ON);
    EXPECT_EQ(found(overridden), osg::Depth::ALWAYS);
    overridden.below().setAttribute(depth(osg::Depth::EQUAL), ON | PROTECTED);
    EXPECT_EQ(found(overridden), osg::Depth::EQUAL);
}

TEST(LeafState, DepthIsWrittenWhereItIsTestedAndNotMasked)
{
    Path path;
    EXPECT_TRUE(writesDepth(path.leaf()));
    path.below().setAttribute(new osg::Depth(osg::Depth::LESS, 0.0, 1.0, false), ON);
    EXPECT_FALSE(writesDepth(path.leaf()));
    Path untested;
    untested.below().setMode(GL_DEPTH_TEST, OFF);
    EXPECT_FALSE(writesDepth(untested.leaf()));
}

TEST(LeafState, AllChannelsMustBeWritten)
{
    for (int masked = 0; masked <= 4; ++masked) {
        Path path;
        path.below().setAttribute(
            new osg::ColorMask(masked != 0, masked != 1, masked != 2, masked != 3), ON);
        EXPECT_EQ(writesAllChannels(path.leaf()), masked == 4);
        EXPECT_EQ(stateAbove(path.leaf()).isUsual(), masked == 4);
    }
}

TEST(LeafState, WhatIsNotUsualAboveAVolume)
{
    EXPECT_TRUE(stateAbove(nullptr).isUsual());
    for (const GLenum mode : {GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_POLYGON_STIPPLE}) {
        Path path;
        path.below().setMode(mode, ON);
        EXPECT_FALSE(stateAbove(path.leaf()).isUsual()) << mode;
        path.below().setMode(mode, OFF);
        EXPECT_TRUE(stateAbove(path.leaf()).isUsual()) << mode;
    }
    Path untested;
    untested.below().setMode(GL_DEPTH_TEST, OFF);
    EXPECT_EQ(stateAbove(untested.leaf()).depthTest.function, osg::Depth::ALWAYS);
    EXPECT_FALSE(stateAbove(untested.leaf()).isUsual());
}

TEST(LeafState, WhichSidePassesADepthTest)
{
    using D = osg::Depth;
    EXPECT_TRUE((DepthTest{D::LESS, 0.0, 1.0}.isUsual()));
    EXPECT_FALSE((DepthTest{D::LESS, 0.0, 0.5}.isUsual()));
    EXPECT_FALSE((DepthTest{D::GREATER, 0.0, 1.0}.isUsual()));
    EXPECT_TRUE((DepthTest{D::LESS, 0.0, 1.0}.nearerPasses()));
    EXPECT_FALSE((DepthTest{D::GREATER, 0.0, 1.0}.nearerPasses()));
    // A range turned round turns the test round.
    EXPECT_FALSE((DepthTest{D::LESS, 1.0, 0.0}.nearerPasses()));
    EXPECT_TRUE((DepthTest{D::GREATER, 1.0, 0.0}.nearerPasses()));
}

TEST(LeafState, ClipSpacesBecomeTheUsualOne)
{
    using C = osg::ClipControl;
    for (const C::Origin origin : {C::LOWER_LEFT, C::UPPER_LEFT})
        for (const C::DepthMode mode : {C::NEGATIVE_ONE_TO_ONE, C::ZERO_TO_ONE}) {
            Path path;
            path.below().setAttribute(new C(origin, mode), ON);
            const glm::dmat4 map = toUsualClip(path.leaf());
            const double zNear = mode == C::ZERO_TO_ONE ? 0.0 : -1.0;
            const double up = origin == C::UPPER_LEFT ? -1.0 : 1.0;
            // The upper left corner of the near plane, and the lower right one of the far plane, at
            // w = 2.
            EXPECT_EQ(map * glm::dvec4(-2.0, 2.0 * up, 2.0 * zNear, 2.0),
                      glm::dvec4(-2.0, 2.0, -2.0, 2.0));
            EXPECT_EQ(map * glm::dvec4(2.0, -2.0 * up, 2.0, 2.0), glm::dvec4(2.0, -2.0, 2.0, 2.0));
        }
    EXPECT_EQ(toUsualClip(nullptr), glm::dmat4(1.0));
}

} // namespace LeafStateTest
