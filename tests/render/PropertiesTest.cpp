// No property of an appearance is without effect, or else it is said why.

#include "PagedScene.h"

#include <osgVolumizer/AppearanceProperties.h>
#include <osgVolumizer/interact/Pick.h>

#include <support/GLTest.h>
#include <support/Reports.h>

#include <map>

namespace PropertiesTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 25;

class Properties : public support::GLTest
{
};

RenderOptions view(double x = 55)
{
    return RenderOptions().size(60, 60).perspective(35.0).lookAt({x, -40, 45}, {12, 12, 12},
                                                                 {0, 0, 1});
}

const osg::ref_ptr<Voxels>& voxels()
{
    static const osg::ref_ptr<Voxels> made = makeVoxels(glm::ivec3(SIZE), bumps);
    return made;
}

// A table with a jump, so that it matters when it is asked.
osg::ref_ptr<A> plainVolume(Voxels* v = voxels())
{
    const osg::ref_ptr<A> volume = makeVolume(v);
    volume->setLookupTable(makeTable({{0.0, {0.2, 0.4, 0.9, 0.0}},
                                      {0.5, {0.2, 0.4, 0.9, 0.02}},
                                      {0.52, {1.0, 0.6, 0.1, 0.3}},
                                      {1.0, {0.9, 0.2, 0.1, 0.1}}}));
    return volume;
}

using Change = std::function<void(A&)>;
/// What has to hold for a property to be looked at, and how it is changed.
struct Case
{
    Change prepare, change;
    /// What is seen of a volume; by default its picture.
    std::function<FloatImage(A&)> show = [](A& a) { return support::renderScene(&a, view()); };
};

FloatImage inMotion(A& a)
{
    support::SceneRenderer renderer(&a, view());
    support::viewHooks(renderer.viewer()).reduction = 16.0;
    for (int i = 0; i < 3; ++i) {
        renderer.options() = view(55.0 - i);
        renderer.render();
    }
    renderer.options() = view(50.0);
    return renderer.render();
}

FloatImage withCoarseFilters(A& a)
{
    return support::renderScene(
        &a, support::limited(view(), [](render::ContextLimits& limits) { limits.filterBits = 4; }));
}

// Floats are accumulated where they are.
FloatImage inBytes(A& a)
{
    RenderOptions options = view();
    options.format = support::PictureTarget::BYTE;
    return support::renderScene(&a, options);
}

FloatImage overAnother(A& a)
{
    osg::ref_ptr<osg::Group> group = new osg::Group;
    group->addChild(&a);
    group->addChild(plainVolume());
    return support::renderScene(group, view());
}

// Of several time steps.
osg::ref_ptr<A> steppedVolume()
{
    const osg::ref_ptr<A> volume = plainVolume(new Voxels(new paged::FormulaSource(
        SIZE, 4, [](const glm::dvec3& p, int step) { return bumps(p + 3.0 * step); })));
    return volume;
}

FloatImage atTime(A& a)
{
    RenderOptions options = view();
    options.time = 1.5;
    support::SceneRenderer renderer(&a, options);
    return paged::settle(renderer);
}

// How deep a click goes.
FloatImage picked(A& a)
{
    const auto hit =
        pickVolume(*dynamic_cast<VolumeGeometry*>(a.getChild(0)), a, {30, 12, 12}, {-5, 11, 12});
    EXPECT_TRUE(hit.ok() && *hit);
    return FloatImage(1, 1, glm::vec4(float((*hit)->ratio)));
}

Case change(
    Change by, Change prepare = [](A&) {})
{
    return {std::move(prepare), std::move(by)};
}

const std::map<std::string, Case>& cases()
{
    const Change iso = [](A& a) { a.setRayFunction(A::ISOSURFACE); };
    const Change lit = [](A& a) { a.setShading(true); };
    const Change moving = [](A&) {};
    static const std::map<std::string, Case> all = {
        {"Technique", change([](A& a) { a.setTechnique(A::SLICES); })},
        {"Interpolation", change([](A& a) { a.setInterpolation(A::NEAREST); })},
        {"Lookup", change([](A& a) { a.setLookup(A::BEFORE_INTERPOLATION); })},
        {"ExactFiltering", {[](A&) {}, [](A& a) { a.setExactFiltering(true); }, withCoarseFilters}},
        {"SamplingMode", change([](A& a) { a.setSamplingMode(SamplingMode::SPHERICAL); })},
        {"SamplingSpace", change([](A& a) { a.setSamplingSpace(SamplingSpace::VIEW_VOLUME); })},
        {"SamplingPeriod", change([](A& a) {
             a.setSamplingPeriod({2, 2, 2});
         })},
        {"MaximumSamples", change([](A& a) { a.setMaximumSamples(5); })},
        {"OpacityUnit", change([](A& a) { a.setOpacityUnit(3.0); })},
        {"RayFunction", change([](A& a) { a.setRayFunction(A::MAXIMUM); })},
        {"IsoValue", change([](A& a) { a.setIsoValue(0.6); }, iso)},
        {"Shading", change(lit)},
        {"Material", change(
                         [](A& a) {
                             a.setMaterial({0.9, 0.1, 0.0, 1.0});
                         },
                         lit)},
        {"Gradients", change([](A& a) { a.setGradients(A::PRECOMPUTED); }, lit)},
        {"AccumulationBits",
         {[](A& a) { a.setTechnique(A::SLICES); }, [](A& a) { a.setAccumulationBits(8); },
          inBytes}},
        {"CombineRule", {[](A&) {}, [](A& a) { a.setCombineRule(A::PAINT); }, overAnother}},
        {"ErrorTolerance", change([](A& a) { a.setErrorTolerance(0.05); })},
        {"TargetFrameTime", {moving, [](A& a) { a.setTargetFrameTime(1e-9); }, inMotion}},
        {"PickOpacity", {[](A&) {}, [](A& a) { a.setPickOpacity(0.1); }, picked}}};
    return all;
}

const std::map<std::string, Case>& casesOfTime()
{
    static const std::map<std::string, Case> all = {
        {"TimeStep", {[](A&) {}, [](A& a) { a.setTimeStep(2.0); }, atTime}},
        {"TimeRate", {[](A&) {}, [](A& a) { a.setTimeRate(1.0); }, atTime}},
        {"TimeBlending",
         {[](A& a) { a.setTimeStep(1.5); }, [](A& a) { a.setTimeBlending(true); }, atTime}}};
    return all;
}

} // namespace

TEST_F(Properties, AllHaveAnEffect)
{
    for (const AppearanceProperty& property : appearanceProperties()) {
        const bool ofTime = casesOfTime().count(property.name) > 0;
        const auto& known = ofTime ? casesOfTime() : cases();
        ASSERT_TRUE(known.count(property.name)) << property.name << " has no case here";
        const Case& c = known.at(property.name);
        const auto make = [&] { return ofTime ? steppedVolume() : plainVolume(); };
        const osg::ref_ptr<A> before = make(), after = make();
        c.prepare(*before);
        c.prepare(*after);
        c.change(*after);
        EXPECT_NE(property.get(*before), property.get(*after)) << property.name;
        const FloatImage plain = c.show(*before), changed = c.show(*after);
        double worst = 0.0;
        for (std::size_t i = 0; i < plain.pixels.size(); ++i)
            for (int k = 0; k < 4; ++k)
                worst =
                    std::max(worst, double(std::abs(plain.pixels[i][k] - changed.pixels[i][k])));
        EXPECT_GT(worst, 1e-6) << property.name;
        // It is the property that does it.
        const osg::ref_ptr<A> again = make();
        c.prepare(*again);
        const FloatImage same = c.show(*again);
        EXPECT_EQ(same.pixels.size(), plain.pixels.size());
        for (std::size_t i = 0; i < plain.pixels.size(); ++i)
            ASSERT_LT(glm::length(plain.pixels[i] - same.pixels[i]), 1e-6) << property.name;
    }
}

// What cannot be done as asked is said, once, by the name of the appearance.
TEST_F(Properties, WhatIsIgnoredIsReportedOnce)
{
    struct Ignored
    {
        const char* words;
        Change change;
    };
    const std::vector<Ignored> all = {{"sampling mode and space are those of slices",
                                       [](A& a) {
                                           a.setTechnique(A::SLABS);
                                           a.setSamplingMode(SamplingMode::SPHERICAL);
                                       }},
                                      {"sampling mode and space are those of slices",
                                       [](A& a) {
                                           a.setTechnique(A::SLABS);
                                           a.setSamplingSpace(SamplingSpace::PRIMITIVE);
                                       }},
                                      {"ray function ISOSURFACE needs slabs",
                                       [](A& a) {
                                           a.setTechnique(A::SLICES);
                                           a.setRayFunction(A::ISOSURFACE);
                                       }},
                                      {"is not lit",
                                       [](A& a) {
                                           a.setShading(true);
                                           a.setRayFunction(A::MAXIMUM);
                                       }},
                                      {"another lookup needs",
                                       [](A& a) {
                                           a.setLookup(A::PREINTEGRATED);
                                           a.setInterpolation(A::NEAREST);
                                       }},
                                      {"an error tolerance needs slabs", [](A& a) {
                                           a.setErrorTolerance(1e-2);
                                           a.setRayFunction(A::AVERAGE);
                                       }}};
    int number = 0;
    for (const Ignored& ignored : all) {
        const support::Reports reports;
        const osg::ref_ptr<A> volume = plainVolume();
        const std::string name = "ignoring " + std::to_string(number++);
        volume->setName(name);
        ignored.change(*volume);
        support::renderScene(volume, view());
        support::renderScene(volume, view(50));
        EXPECT_EQ(reports.count(name), 1) << ignored.words;
        EXPECT_EQ(reports.count(ignored.words), 1) << ignored.words;
        const auto* geometry = dynamic_cast<VolumeGeometry*>(volume->getChild(0));
        const auto settings = volume->getSettingsInForce(*geometry);
        EXPECT_TRUE(std::any_of(settings.reasons.begin(), settings.reasons.end(),
                                [&](const std::string& reason) {
                                    return reason.find(ignored.words) != std::string::npos;
                                }))
            << ignored.words;
    }
}

} // namespace PropertiesTest
