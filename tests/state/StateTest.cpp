// Every state of OSG above a volume, against the same above geometry.

#include "Stage.h"

#include <support/Compare.h>
#include <support/GLTest.h>

#include <tuple>

namespace StateTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;

namespace {

std::string nameOf(Target target)
{
    static const char* const names[] = {"Float", "Byte", "Samples"};
    return names[static_cast<int>(target)];
}

FramebufferFormat formatOf(Target target)
{
    FramebufferFormat format;
    if (target != Target::ANY) format.colors = {GL_RGBA8};
    if (target == Target::SAMPLES) format.samples = 4;
    return format;
}

class States : public support::GLTest,
               public ::testing::WithParamInterface<std::tuple<Content, Target>>
{
protected:
    States() : _stage(std::get<0>(GetParam()), formatOf(std::get<1>(GetParam())))
    {
        _stage.setSurfacesBare(std::get<1>(GetParam()) == Target::SAMPLES);
    }

    void SetUp() override
    {
        GLTest::SetUp();
        _plain = _stage.volume(nullptr, 0);
        _plainGeometry = _stage.geometry(nullptr, 0, true);
        ASSERT_FALSE(_plain.empty() || _plainGeometry.empty());
        ASSERT_EQ(_plain.glError, 0u);
        support::savePicture(_plain.colors[0], "state_" + name());
        support::savePicture(_plainGeometry.colors[0], "state_" + name() + "_geometry");
        // Else nothing below means anything.
        ASSERT_LE(difference(_plain, _plainGeometry), tolerance());
    }

    static std::string name()
    {
        return nameOf(std::get<0>(GetParam())) + nameOf(std::get<1>(GetParam()));
    }
    static bool isShownBy(const StateRow& row)
    {
        const Target target = std::get<1>(GetParam());
        const Content content = std::get<0>(GetParam());
        const bool surfaces = content == Content::SURFACE || content == Content::BARE_SURFACE;
        if (row.scope == Scope::ELSEWHERE || (row.scope == Scope::VOLUMES && surfaces))
            return false;
        return row.target == target || (row.target == Target::ANY && target != Target::SAMPLES);
    }
    // 8 bits are rounded once where all is composited, and once a layer of geometry.
    static double tolerance()
    {
        return std::get<1>(GetParam()) == Target::ANY ? 2e-4 : 2.6 / 255.0;
    }

    /// Whether the state changes geometry.
    bool check(const StateRow& row, unsigned value)
    {
        SCOPED_TRACE(row.state + (value & osg::StateAttribute::OVERRIDE ? ", overriding" : ""));
        const FramebufferContents geometry = _stage.geometry(&row, value, true);
        const FramebufferContents expected =
            row.effect == Effect::AS_ON_GEOMETRY ? geometry : _stage.geometry(&row, value, false);
        const FramebufferContents shown = _stage.volume(&row, value);
        const double error = difference(shown, expected);
        EXPECT_LE(error, tolerance());
        EXPECT_EQ(shown.glError, geometry.glError);
        if (error > tolerance()) {
            const std::string file = "state_" + name() + "_" + row.state;
            support::savePicture(shown.colors[0], file);
            support::savePicture(expected.colors[0], file + "_expected");
        }
        checkNothingIsLeft();
        return difference(geometry, _plainGeometry) > 0.02;
    }

    // What the frame before left in the context.
    void checkNothingIsLeft()
    {
        const bool left = difference(_stage.volume(nullptr, 0), _plain) > 0.0;
        // Some states OSG itself does not take back.
        const bool takenBack = difference(_stage.geometry(nullptr, 0, true), _plainGeometry) == 0.0;
        EXPECT_FALSE(takenBack && left) << "the next frame differs";
        if (!takenBack || left) _stage.restart();
    }

    Stage _stage;
    FramebufferContents _plain, _plainGeometry;
};

TEST_P(States, AreHonouredOrWithoutEffect)
{
    for (const StateRow& row : stateRows()) {
        if (!isShownBy(row)) continue;
        bool shows = false;
        for (const unsigned value :
             {unsigned(osg::StateAttribute::ON),
              unsigned(osg::StateAttribute::ON) | unsigned(osg::StateAttribute::OVERRIDE)})
            shows = check(row, value) || shows;
        if (!row.driverDecides) {
            EXPECT_EQ(shows, row.shows) << row.state;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Above, States,
    ::testing::Combine(::testing::Values(Content::SLABS, Content::SLICES, Content::MAXIMUM,
                                         Content::SURFACE, Content::BARE_SURFACE, Content::OVERLAP),
                       ::testing::Values(Target::ANY, Target::BYTE, Target::SAMPLES)),
    [](const auto& tested) {
        return nameOf(std::get<0>(tested.param)) + nameOf(std::get<1>(tested.param));
    });

} // namespace

} // namespace StateTest
