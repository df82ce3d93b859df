#include <osgVolumizer/render/cull/FrameTimes.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace FrameTimesTest {

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
    double now = 0.0, reduction = 1.0;
    unsigned frame = 1;
    const auto draw = [&](double position, double target) {
        const double before = reduction;
        reduction =
            times.reduction(7, frame++, osg::Matrixd::translate(position, 0, 0), now, target);
        now += 0.005 + 0.08 / reduction; // part of a frame does not depend on samples
        return reduction / before;
    };
    draw(0.0, 0.02);
    EXPECT_EQ(reduction, 1.0);
    for (int i = 1; i <= 60; ++i) {
        const double change = draw(0.1 * i, 0.02);
        // No leaps, once frames at rest have told where to begin.
        EXPECT_LE(change, i == 1 ? FrameTimes::LARGEST_AT_FIRST : 2.0);
        EXPECT_GE(change, 1.0 / 1.5);
    }
    EXPECT_NEAR(0.005 + 0.08 / reduction, 0.02, 0.002);
    // At rest all is as it was, at once and for good; then it goes on where it was.
    const double moving = reduction;
    for (int i = 0; i < 5; ++i) {
        draw(6.0, 0.02);
        EXPECT_EQ(reduction, 1.0);
    }
    draw(6.1, 0.02);
    EXPECT_NEAR(reduction, moving, 0.1 * moving);
    // One that is easy changes nothing.
    for (int i = 0; i < 60; ++i)
        draw(70.0 + i, 10.0);
    EXPECT_EQ(reduction, 1.0);
}

TEST(FrameTimes, ATargetOutOfReachHasBounds)
{
    FrameTimes times;
    double reduction = 1.0;
    for (unsigned frame = 1; frame <= 60; ++frame)
        reduction = times.reduction(1, frame, at(frame), 0.1 * frame, 1e-6);
    EXPECT_EQ(reduction, FrameTimes::LARGEST);
}

// Threads that cull ahead learn late what a reduction was good for.
TEST(FrameTimes, AreReachedThoughFramesAreCulledAhead)
{
    FrameTimes times;
    double now = 0.0;
    std::vector<double> drawn;
    for (unsigned frame = 1; frame <= 80; ++frame) {
        drawn.push_back(0.01 + 0.7 / times.reduction(1, frame, at(frame), now, 0.05));
        now += drawn[drawn.size() < 3 ? 0 : drawn.size() - 3];
    }
    double mean = 0.0;
    for (std::size_t i = 40; i < 80; ++i)
        mean += drawn[i] / 40.0;
    EXPECT_NEAR(mean, 0.05, 0.015);
}

TEST(FrameTimes, AFrameThatWaitedForSomethingElseIsForgotten)
{
    // The first frames with fewer samples wait for a shader.
    FrameTimes times;
    double now = 0.0, reduction = 1.0, seconds = 0.0;
    for (unsigned frame = 1; frame <= 40; ++frame) {
        reduction = times.reduction(1, frame, at(frame > 3 ? frame : 0), now, 0.05);
        seconds = 0.01 + 0.7 / reduction;
        now += seconds + (frame == 4 || frame == 5 ? 1.5 : 0.0);
    }
    EXPECT_LT(seconds, 0.065);
    EXPECT_GT(seconds, 0.03);
}

TEST(FrameTimes, ViewsThatAreRoundedAnewAreAtRest)
{
    FrameTimes times;
    for (unsigned frame = 1; frame < 20; ++frame)
        EXPECT_EQ(times.reduction(1, frame, at(122.0 + (frame % 2) * 6e-14), 0.1 * frame, 0.01),
                  1.0);
    EXPECT_GT(times.reduction(1, 20, at(122.0 + 1e-6), 2.0, 0.01), 1.0);
}

TEST(FrameTimes, MayBeFixedForMovingViews)
{
    FrameTimes times;
    EXPECT_EQ(times.reduction(1, 1, at(0), 0.0, 0.1, 27.0), 1.0);
    EXPECT_EQ(times.reduction(1, 2, at(1), 0.1, 0.1, 27.0), 27.0);
    EXPECT_EQ(times.reduction(1, 3, at(1), 0.2, 0.1, 27.0), 1.0);
}

TEST(FrameTimes, FramesAtRestTellWhereToBegin)
{
    const auto firstOfMoving = [](const std::vector<double>& secondsAtRest) {
        FrameTimes times;
        double now = 0.0;
        unsigned frame = 1;
        times.reduction(1, frame++, at(0), now, 0.1);
        for (const double seconds : secondsAtRest)
            EXPECT_EQ(times.reduction(1, frame++, at(0), now += seconds, 0.1), 1.0);
        return times.reduction(1, frame++, at(1), now += 0.8, 0.1);
    };
    EXPECT_NEAR(firstOfMoving({0.8, 0.8}), 8.0, 1e-9);
    // The fastest counts: one of them may have waited, for a shader or for its user.
    EXPECT_NEAR(firstOfMoving({30.0, 0.2}), 2.0, 1e-9);
    EXPECT_EQ(firstOfMoving({0.05}), 1.0);
    EXPECT_NEAR(firstOfMoving({}), 8.0, 1e-9); // the one that lasted until it moved
}

TEST(FrameTimes, AReductionIsSharedOut)
{
    double before = 1.0;
    for (double reduction = 1.0; reduction <= FrameTimes::LARGEST; reduction *= 1.05) {
        const render::ReducedSampling reduced = render::reducedSampling(reduction);
        const double distance = reduced.rayDistance;
        EXPECT_NEAR(distance * distance * reduced.stretch, reduction, 1e-12 * reduction);
        EXPECT_GE(distance, before);
        EXPECT_LE(distance, 4.0);
        EXPECT_GE(reduced.stretch, 1.0);
        before = distance;
    }
    EXPECT_EQ(before, 4.0);
}

TEST(FrameTimes, OtherEyesOfAFrameGetTheSame)
{
    FrameTimes times;
    times.reduction(1, 1, at(0), 0.0, 0.01);
    times.reduction(1, 2, at(1), 0.1, 0.01);
    const double left = times.reduction(1, 3, at(2), 0.2, 0.01);
    EXPECT_GT(left, 1.0);
    // A second look at the frame, from elsewhere and later, is no frame of its own.
    EXPECT_EQ(times.reduction(1, 3, at(2.1), 0.25, 0.01), left);
    EXPECT_GT(times.reduction(1, 4, at(3), 0.3, 0.01), left);
}

TEST(FrameTimes, ViewsDoNotKnowEachOther)
{
    FrameTimes times;
    for (unsigned frame = 1; frame < 6; ++frame) {
        times.reduction(1, frame, at(frame), 0.1 * frame, 0.01);
        EXPECT_EQ(times.reduction(2, frame, at(0), 0.1 * frame, 0.01), 1.0);
    }
    EXPECT_GT(times.reduction(1, 6, at(6), 0.6, 0.01), 1.0);
}

TEST(FrameTimes, AfterAPauseNothingIsKnown)
{
    FrameTimes times;
    for (unsigned frame = 1; frame < 6; ++frame)
        times.reduction(1, frame, at(frame), 0.1 * frame, 0.01);
    EXPECT_EQ(times.reduction(1, 9, at(9), 0.9, 0.01), 1.0); // frames 6 to 8 did not show it
}

} // namespace

} // namespace FrameTimesTest
