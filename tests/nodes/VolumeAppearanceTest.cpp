#include <osgVolumizer/Error.h>
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/render/cull/AppearanceData.h>

#include <osg/observer_ptr>

#include <gtest/gtest.h>

#include <limits>

namespace VolumeAppearanceTest {

using namespace osgVolumizer;

namespace {

osg::ref_ptr<Voxels> makeVoxels(const glm::dvec3& spacing)
{
    VoxelSource::Description description;
    description.size = glm::ivec3(4);
    description.spacing = spacing;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    EXPECT_TRUE(source->allocate(description));
    return new Voxels(source);
}

TEST(VolumeAppearance, Defaults)
{
    const osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    EXPECT_EQ(appearance->getVoxels(), nullptr);
    ASSERT_NE(appearance->getLookupTable(), nullptr);
    EXPECT_EQ(appearance->getTechnique(), VolumeAppearance::AUTOMATIC);
    EXPECT_EQ(appearance->getInterpolation(), VolumeAppearance::LINEAR);
    EXPECT_EQ(appearance->getSamplingMode(), SamplingMode::VIEWPORT_ALIGNED);
    EXPECT_EQ(appearance->getSamplingSpace(), SamplingSpace::OBJECT);
    EXPECT_EQ(appearance->getSamplingPeriod(), osg::Vec3d(1.0, 1.0, 1.0));
    EXPECT_EQ(appearance->getMaximumSamples(), 4096);
    EXPECT_EQ(appearance->getOpacityUnit(), 0.0);
    EXPECT_EQ(appearance->getEffectiveOpacityUnit(), 1.0);
    EXPECT_STREQ(appearance->className(), "VolumeAppearance");
    EXPECT_STREQ(appearance->libraryName(), "osgVolumizer");
}

TEST(VolumeAppearance, TheTableIsNeverNull)
{
    const osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    osg::ref_ptr<LookupTable> table = new LookupTable;
    appearance->setLookupTable(table);
    EXPECT_EQ(appearance->getLookupTable(), table.get());
    appearance->setLookupTable(nullptr);
    ASSERT_NE(appearance->getLookupTable(), nullptr);
    EXPECT_NE(appearance->getLookupTable(), table.get());
}

TEST(VolumeAppearance, TheOpacityUnitIsTheMeanSpacingUnlessItIsSet)
{
    const osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->setVoxels(makeVoxels({1.0, 2.0, 6.0}));
    EXPECT_DOUBLE_EQ(appearance->getEffectiveOpacityUnit(), 3.0);
    EXPECT_TRUE(appearance->setOpacityUnit(0.25));
    EXPECT_EQ(appearance->getEffectiveOpacityUnit(), 0.25);
    EXPECT_TRUE(appearance->setOpacityUnit(0.0));
    EXPECT_DOUBLE_EQ(appearance->getEffectiveOpacityUnit(), 3.0);
}

TEST(VolumeAppearance, RefusesWhatHasNoMeaning)
{
    const osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->setName("bone");
    ASSERT_TRUE(appearance->setSamplingPeriod({0.5, 1.0, 2.0}));
    ASSERT_TRUE(appearance->setOpacityUnit(2.0));
    ASSERT_TRUE(appearance->setMaximumSamples(100));
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double bad : {0.0, -1.0, nan, infinity})
        for (int axis = 0; axis < 3; ++axis) {
            osg::Vec3d period(1.0, 1.0, 1.0);
            period[axis] = bad;
            clearLastError();
            const Status status = appearance->setSamplingPeriod(period);
            EXPECT_EQ(status.code, ErrorCode::VALUE_INVALID);
            EXPECT_NE(status.text.find("bone"), std::string::npos);
            EXPECT_NE(status.text.find("period"), std::string::npos);
            EXPECT_EQ(getLastError().text, status.text);
        }
    for (const double bad : {-1e-9, nan, infinity})
        EXPECT_EQ(appearance->setOpacityUnit(bad).code, ErrorCode::VALUE_INVALID);
    for (const int bad : {0, -4})
        EXPECT_EQ(appearance->setMaximumSamples(bad).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(appearance->getSamplingPeriod(), osg::Vec3d(0.5, 1.0, 2.0));
    EXPECT_EQ(appearance->getOpacityUnit(), 2.0);
    EXPECT_EQ(appearance->getMaximumSamples(), 100);
}

TEST(VolumeAppearance, CopiesShareVoxelsAndTable)
{
    const osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->setVoxels(makeVoxels({1.0, 1.0, 1.0}));
    appearance->setTechnique(VolumeAppearance::SLICES);
    appearance->setInterpolation(VolumeAppearance::NEAREST);
    appearance->setSamplingMode(SamplingMode::SPHERICAL);
    appearance->setSamplingSpace(SamplingSpace::VIEW_VOLUME);
    ASSERT_TRUE(appearance->setSamplingPeriod({0.5, 1.0, 2.0}));
    ASSERT_TRUE(appearance->setMaximumSamples(77));
    ASSERT_TRUE(appearance->setOpacityUnit(3.0));
    appearance->addChild(new osg::Group);
    const osg::ref_ptr<VolumeAppearance> copy = osg::clone(appearance.get());
    EXPECT_EQ(copy->getVoxels(), appearance->getVoxels());
    EXPECT_EQ(copy->getLookupTable(), appearance->getLookupTable());
    EXPECT_EQ(copy->getTechnique(), VolumeAppearance::SLICES);
    EXPECT_EQ(copy->getInterpolation(), VolumeAppearance::NEAREST);
    EXPECT_EQ(copy->getSamplingMode(), SamplingMode::SPHERICAL);
    EXPECT_EQ(copy->getSamplingSpace(), SamplingSpace::VIEW_VOLUME);
    EXPECT_EQ(copy->getSamplingPeriod(), osg::Vec3d(0.5, 1.0, 2.0));
    EXPECT_EQ(copy->getMaximumSamples(), 77);
    EXPECT_EQ(copy->getOpacityUnit(), 3.0);
    EXPECT_EQ(copy->getNumChildren(), 1u);
    EXPECT_NE(render::renderData<render::AppearanceData>(*copy),
              render::renderData<render::AppearanceData>(*appearance));
}

TEST(VolumeAppearance, OneTableHasOneTextureWhoeverHasIt)
{
    const osg::ref_ptr<VolumeAppearance> a = new VolumeAppearance, b = new VolumeAppearance;
    b->setLookupTable(a->getLookupTable());
    const osg::ref_ptr<LookupTable> table = a->getLookupTable();
    const osg::Vec2d range(0.0, 1.0);
    const auto textureOf = [&](VolumeAppearance& appearance, const osg::Vec2d& of) {
        return render::renderData<render::AppearanceData>(appearance)
            ->tables.get(*table, of, VolumeAppearance::AFTER_INTERPOLATION)
            .texture;
    };
    const osg::observer_ptr<osg::TextureBuffer> first = textureOf(*a, range).get();
    EXPECT_EQ(textureOf(*b, range).get(), first.get());
    // Of another range (in fractions it is the same function), or of a changed table: another one.
    EXPECT_NE(textureOf(*b, osg::Vec2d(0.0, 2.0)).get(), first.get());
    EXPECT_EQ(textureOf(*b, range).get(), first.get());
    table->setRamp(0.3, 0.1);
    const osg::observer_ptr<osg::TextureBuffer> second = textureOf(*a, range).get();
    EXPECT_NE(second.get(), first.get());
    EXPECT_EQ(textureOf(*b, range).get(), second.get());
    // Nothing outlives the appearances that use it, and these keep no more than a few.
    for (int i = 0; i < 4; ++i) {
        table->setRamp(0.3, 0.2 + 0.1 * i);
        textureOf(*a, range);
        textureOf(*b, range);
    }
    EXPECT_FALSE(first.valid());
    EXPECT_FALSE(second.valid());
}

} // namespace

} // namespace VolumeAppearanceTest
