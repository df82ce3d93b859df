#include <osgVolumizer/AppearanceProperties.h>

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace AppearancePropertiesTest {

using namespace osgVolumizer;

namespace {

Status setText(VolumeAppearance& appearance, const char* option, const std::string& text)
{
    const AppearanceProperty* property = findAppearanceOption(option);
    if (!property) return {ErrorCode::VALUE_INVALID, std::string("no option ") + option};
    const auto values = parseAppearanceValues(*property, text);
    if (values.ok()) property->set(appearance, *values);
    return values.status;
}

TEST(AppearanceProperties, TextsSetThem)
{
    const osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    for (const auto& [option, text] : {std::pair<const char*, const char*>{"ray", "Maximum"},
                                       {"shading", "on"},
                                       {"period", "0.5"},
                                       {"tolerance", "1e-3"},
                                       {"technique", "slabs"},
                                       {"interpolation", "CUBIC"},
                                       {"lookup", "preintegrated"},
                                       {"exact", "true"},
                                       {"mode", "spherical"},
                                       {"space", "primitive"},
                                       {"samples", "77"},
                                       {"unit", "2.5"},
                                       {"iso", "-300"},
                                       {"material", "0.1,0.9,0.5,8"},
                                       {"gradients", "precomputed"},
                                       {"bits", "16"},
                                       {"combine", "paint"},
                                       {"frametime", "0.05"}})
        EXPECT_TRUE(setText(*a, option, text).ok()) << option;
    EXPECT_EQ(a->getRayFunction(), VolumeAppearance::MAXIMUM);
    EXPECT_TRUE(a->getShading());
    EXPECT_EQ(a->getSamplingPeriod(), osg::Vec3d(0.5, 0.5, 0.5));
    EXPECT_EQ(a->getErrorTolerance(), 1e-3);
    EXPECT_EQ(a->getTechnique(), VolumeAppearance::SLABS);
    EXPECT_EQ(a->getInterpolation(), VolumeAppearance::CUBIC);
    EXPECT_EQ(a->getLookup(), VolumeAppearance::PREINTEGRATED);
    EXPECT_TRUE(a->getExactFiltering());
    EXPECT_EQ(a->getSamplingMode(), SamplingMode::SPHERICAL);
    EXPECT_EQ(a->getSamplingSpace(), SamplingSpace::PRIMITIVE);
    EXPECT_EQ(a->getMaximumSamples(), 77);
    EXPECT_EQ(a->getOpacityUnit(), 2.5);
    EXPECT_EQ(a->getIsoValue(), -300.0);
    EXPECT_EQ(a->getMaterial().diffuse, 0.9);
    EXPECT_EQ(a->getMaterial().shininess, 8.0);
    EXPECT_EQ(a->getGradients(), VolumeAppearance::PRECOMPUTED);
    EXPECT_EQ(a->getAccumulationBits(), 16);
    EXPECT_EQ(a->getCombineRule(), VolumeAppearance::PAINT);
    EXPECT_EQ(a->getTargetFrameTime(), 0.05);
    EXPECT_TRUE(setText(*a, "technique", "auto").ok());
    EXPECT_EQ(a->getTechnique(), VolumeAppearance::AUTOMATIC);
    EXPECT_TRUE(setText(*a, "lookup", "automatic").ok());
    EXPECT_EQ(a->getLookup(), VolumeAppearance::AUTOMATIC_LOOKUP);
    EXPECT_TRUE(setText(*a, "period", "1,2,3").ok());
    EXPECT_EQ(a->getSamplingPeriod(), osg::Vec3d(1, 2, 3));
}

TEST(AppearanceProperties, BadTextsAreRefusedWithWhatIsExpected)
{
    const osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    const struct
    {
        const char *option, *text, *expected;
    } cases[] = {{"ray", "maximal", "composite, maximum"},
                 {"ray", "", "composite"},
                 {"shading", "perhaps", "on, off"},
                 {"period", "0", "1e-18"},
                 {"period", "1,2", "x,y,z"},
                 {"period", "nan", "1e-18"},
                 {"samples", "1.5", "whole number"},
                 {"samples", "0", "from 1"},
                 {"samples", "1e99", "from 1"},
                 {"bits", "12", "8, 16 or 32"},
                 {"material", "1,2,3", "four numbers"},
                 {"material", "-1,0,0,1", "1000"},
                 {"tolerance", "-1", "not negative"},
                 {"iso", "inf", "finite"},
                 {"technique", "1", "slices"}};
    for (const auto& c : cases) {
        const Status status = setText(*a, c.option, c.text);
        EXPECT_EQ(status.code, ErrorCode::VALUE_INVALID) << c.option << "=" << c.text;
        EXPECT_NE(status.text.find(c.expected), std::string::npos) << status.text;
        EXPECT_NE(status.text.find(c.option), std::string::npos) << status.text;
    }
    EXPECT_EQ(findAppearanceOption("spaceing"), nullptr);
}

TEST(AppearanceProperties, WhatIsGotMayBeSet)
{
    const osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance;
    std::set<std::string> names, options;
    for (const AppearanceProperty& p : appearanceProperties()) {
        const AppearanceProperty::Values values = p.get(*a);
        ASSERT_EQ(values.size(), p.count) << p.name;
        for (std::size_t i = 0; i < values.size(); ++i)
            EXPECT_EQ(p.expected(i, values[i]), "") << p.name;
        p.set(*a, values);
        EXPECT_EQ(p.get(*a), values) << p.name;
        EXPECT_TRUE(names.insert(p.name).second && options.insert(p.option).second) << p.name;
        EXPECT_FALSE(appearanceValueText(p).empty());
        EXPECT_EQ(findAppearanceOption(p.option), &p);
    }
}

} // namespace

} // namespace AppearancePropertiesTest
