// Numbers that have no meaning, or that float arithmetic cannot carry, are refused with a sentence
// that says them; a bound that is none is taken.

#include <osgVolumizer/Error.h>
#include <osgVolumizer/VolumeAppearance.h>

#include <gtest/gtest.h>

#include <functional>
#include <limits>

namespace ValueLimitsTest {

using namespace osgVolumizer;

namespace {

constexpr double HUGE_NUMBER = 1e300, TINY_NUMBER = 1e-300;

void expectRefused(const Status& status, const char* number)
{
    EXPECT_EQ(status.code, ErrorCode::VALUE_INVALID) << number;
    EXPECT_NE(status.text.find(number), std::string::npos) << status.text;
}

osg::ref_ptr<MemoryVoxelSource> makeSource()
{
    VoxelSource::Description description;
    description.size = glm::ivec3(4);
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    EXPECT_TRUE(source->allocate(description));
    return source;
}

TEST(ValueLimits, OfLengthsInAnAppearance)
{
    const osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    for (const double good : {1e-18, 1.0, 1e18}) {
        EXPECT_TRUE(appearance->setSamplingPeriod({good, 1.0, good})) << good;
        EXPECT_TRUE(appearance->setOpacityUnit(good)) << good;
    }
    expectRefused(appearance->setSamplingPeriod({1.0, HUGE_NUMBER, 1.0}), "1e+300");
    expectRefused(appearance->setSamplingPeriod({1.0, 1.0, TINY_NUMBER}), "1e-300");
    expectRefused(appearance->setOpacityUnit(HUGE_NUMBER), "1e+300");
    expectRefused(appearance->setOpacityUnit(TINY_NUMBER), "1e-300");
    EXPECT_EQ(appearance->getSamplingPeriod(), osg::Vec3d(1e18, 1.0, 1e18));
    EXPECT_EQ(appearance->getOpacityUnit(), 1e18);
}

TEST(ValueLimits, OfMaterials)
{
    const osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    EXPECT_TRUE(appearance->setMaterial({1000.0, 1000.0, 1000.0, 1e7}));
    expectRefused(appearance->setMaterial({HUGE_NUMBER, 0.8, 0.3, 32.0}), "1e+300");
    expectRefused(appearance->setMaterial({0.2, 1001.0, 0.3, 32.0}), "1001");
    expectRefused(appearance->setMaterial({0.2, 0.8, HUGE_NUMBER, 32.0}), "1e+300");
    expectRefused(appearance->setMaterial({0.2, 0.8, 0.3, HUGE_NUMBER}), "1e+300");
    EXPECT_EQ(appearance->getMaterial().shininess, 1e7);
    EXPECT_EQ(appearance->getMaterial().diffuse, 1000.0);
}

TEST(ValueLimits, BoundsThatAreNoneAreTaken)
{
    const osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    const int most = std::numeric_limits<int>::max();
    EXPECT_TRUE(appearance->setMaximumSamples(most));
    EXPECT_EQ(appearance->getMaximumSamples(), most);
    for (const double number : {HUGE_NUMBER, TINY_NUMBER}) {
        EXPECT_TRUE(appearance->setErrorTolerance(number));
        EXPECT_TRUE(appearance->setTargetFrameTime(number));
        EXPECT_TRUE(appearance->setIsoValue(number));
        EXPECT_TRUE(appearance->setIsoValue(-number));
    }
}

TEST(ValueLimits, OfVoxels)
{
    const osg::ref_ptr<Voxels> voxels = new Voxels(makeSource());
    EXPECT_TRUE(voxels->setSpacing({1e-18, 1.0, 1e18}));
    expectRefused(voxels->setSpacing({1.0, HUGE_NUMBER, 1.0}), "1e+300");
    expectRefused(voxels->setSpacing({1.0, 1.0, TINY_NUMBER}), "1e-300");
    EXPECT_EQ(voxels->getSpacing(), osg::Vec3d(1e-18, 1.0, 1e18));
    EXPECT_TRUE(voxels->setOrigin({-1e18, 1e-300, 1e18}));
    expectRefused(voxels->setOrigin({0.0, -HUGE_NUMBER, 0.0}), "-1e+300");
    EXPECT_EQ(voxels->getOrigin(), osg::Vec3d(-1e18, 1e-300, 1e18));
    EXPECT_TRUE(voxels->setRange({-1e300, 1e300}));
    EXPECT_TRUE(voxels->setRange({0.0, 1e-30}));
    expectRefused(voxels->setRange({0.0, TINY_NUMBER}), "1e-300");
    EXPECT_EQ(voxels->getRange(), osg::Vec2d(0.0, 1e-30));
}

TEST(ValueLimits, OfWhatSourcesDescribe)
{
    VoxelSource::Description d;
    d.size = glm::ivec3(2);
    d.spacing.y = HUGE_NUMBER;
    expectRefused(d.validate(), "1e+300");
    d.spacing.y = TINY_NUMBER;
    expectRefused(d.validate(), "1e-300");
    d.spacing.y = 1.0;
    d.origin.z = HUGE_NUMBER;
    expectRefused(d.validate(), "1e+300");
}

TEST(ValueLimits, RangesThatAreFoundAreSuchAsCouldBeSet)
{
    VoxelSource::Description d;
    d.size = {2, 1, 1};
    d.type = VoxelType::FLOAT32;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    ASSERT_TRUE(source->allocate(d));
    static_cast<float*>(source->data())[1] = 1e-40f;
    const osg::ref_ptr<Voxels> voxels = new Voxels(source);
    const osg::Vec2d range = voxels->getRange();
    EXPECT_TRUE(voxels->setRange(range)) << range.x() << " " << range.y();
}

// A table at data values, asked for over any range.
TEST(ValueLimits, TablesStayFinite)
{
    const osg::ref_ptr<LookupTable> table = new LookupTable;
    const glm::dvec4 red(1, 0, 0, 0.5), blue(0, 0, 1, 0.5);
    ASSERT_TRUE(table->setPoints({{-1e308, red}, {1e308, blue}}, LookupTable::DATA_VALUES));
    const auto function = table->getNormalizedFunction(osg::Vec2d(0.0, 1e-30));
    for (const auto& point : function->points())
        EXPECT_TRUE(std::isfinite(point.value)) << point.value;
    for (const double value : {0.0, 0.5, 1.0})
        EXPECT_NEAR(function->evaluate(value).r, 0.5, 1e-9) << value;
}

// What is kept for a table or for voxels is told apart by their counts, which no other object has:
// a new one may well lie where an old one was.
TEST(ValueLimits, CountsAreOfOneObjectOnly)
{
    const osg::ref_ptr<LookupTable> a = new LookupTable, b = new LookupTable;
    EXPECT_NE(a->getModifiedCount(), b->getModifiedCount());
    const osg::ref_ptr<LookupTable> copy = osg::clone(a.get());
    EXPECT_NE(a->getModifiedCount(), copy->getModifiedCount());
    const osg::ref_ptr<Voxels> v = new Voxels(makeSource()), w = new Voxels(makeSource());
    EXPECT_NE(v->getLayoutCount(), w->getLayoutCount());
    const osg::ref_ptr<Voxels> voxelsCopy = osg::clone(v.get());
    EXPECT_NE(v->getLayoutCount(), voxelsCopy->getLayoutCount());
}

} // namespace

} // namespace ValueLimitsTest
