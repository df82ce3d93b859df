#include <osgVolumizer/render/cull/FrameTimes.h>

#include <gtest/gtest.h>

using namespace osgVolumizer;
using render::FrameTimes;

namespace {

osg::Matrixd at(double position)
{
    return osg::Matrixd::translate(position, 0.0, 0.0);
}

TEST(FrameTimes, AreReachedWhileMovingAndForgottenAtRest)
{
    render::FrameTimes times;
    double now = 0.0, stretch = 1.0;
    unsigned frame = 1;
    const auto draw = [&](double position, double target) {
        const double before = stretch;
        stretch = times.stretch(7, frame++, osg::Matrixd::translate(position, 0, 0), now, target);
        now += 0.005 + 0.08 / stretch; // part of a frame does not depend on samples
        return stretch / before;
    };
    draw(0.0, 0.02);
    EXPECT_EQ(stretch, 1.0);
    for (int i = 1; i <= 60; ++i) {
        const double change = draw(0.1 * i, 0.02);
        EXPECT_LE(change, 2.0); // no leaps
        EXPECT_GE(change, 1.0 / 1.5);
    }
    EXPECT_NEAR(0.005 + 0.08 / stretch, 0.02, 0.002);
    // At rest all is as it was, at once and for good; then it goes on where it was.
    const double moving = stretch;
    for (int i = 0; i < 5; ++i) {
        draw(6.0, 0.02);
        EXPECT_EQ(stretch, 1.0);
    }
    draw(6.1, 0.02);
    EXPECT_NEAR(stretch, moving, 0.1 * moving);
    // A target that is out of reach has bounds; one that is easy changes nothing.
    for (int i = 0; i < 60; ++i)
        draw(7.0 + i, 1e-6);
    EXPECT_EQ(stretch, render::FrameTimes::LARGEST);
    for (int i = 0; i < 60; ++i)
        draw(70.0 + i, 10.0);
    EXPECT_EQ(stretch, 1.0);
}

TEST(FrameTimes, OtherEyesOfAFrameGetTheSame)
{
    FrameTimes times;
    times.stretch(1, 1, at(0), 0.0, 0.01);
    times.stretch(1, 2, at(1), 0.1, 0.01);
    const double left = times.stretch(1, 3, at(2), 0.2, 0.01);
    EXPECT_GT(left, 1.0);
    // A second look at the frame, from elsewhere and later, is no frame of its own.
    EXPECT_EQ(times.stretch(1, 3, at(2.1), 0.25, 0.01), left);
    EXPECT_GT(times.stretch(1, 4, at(3), 0.3, 0.01), left);
}

TEST(FrameTimes, ViewsDoNotKnowEachOther)
{
    FrameTimes times;
    for (unsigned frame = 1; frame < 6; ++frame) {
        times.stretch(1, frame, at(frame), 0.1 * frame, 0.01);
        EXPECT_EQ(times.stretch(2, frame, at(0), 0.1 * frame, 0.01), 1.0);
    }
    EXPECT_GT(times.stretch(1, 6, at(6), 0.6, 0.01), 1.0);
}

TEST(FrameTimes, AfterAPauseNothingIsKnown)
{
    FrameTimes times;
    for (unsigned frame = 1; frame < 6; ++frame)
        times.stretch(1, frame, at(frame), 0.1 * frame, 0.01);
    EXPECT_EQ(times.stretch(1, 9, at(9), 0.9, 0.01), 1.0); // frames 6 to 8 did not show it
}

} // namespace
