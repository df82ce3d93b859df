// Numbers at the ends of what is accepted still make a picture; no pixel is NaN, and GL has no
// error.

#include "Volumes.h"

#include <osgVolumizer/Error.h>

#include <support/GLTest.h>

#include <osg/MatrixTransform>

#include <limits>

namespace ExtremeValuesTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

RenderOptions view()
{
    return RenderOptions().size(48, 48).perspective(45.0).lookAt({24, -14, 20}, {6, 6, 6},
                                                                 {0, 0, 1});
}

class ExtremeValues : public support::GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        _voxels = makeVoxels(glm::ivec3(13), bumps);
        _volume = makeVolume(_voxels);
        _volume->setLookupTable(makeTable(smoothPoints(0.2)));
        clearLastError();
    }
    FloatImage picture() { return picture(_volume, view()); }
    static FloatImage picture(osg::Node* scene, const RenderOptions& options)
    {
        support::SceneRenderer renderer(scene, options);
        const FloatImage image = renderer.render();
        EXPECT_EQ(renderer.glError(), 0u);
        for (const glm::vec4& p : image.pixels)
            for (int c = 0; c < 4; ++c)
                EXPECT_TRUE(std::isfinite(p[c]));
        return image;
    }
    static std::size_t shown(const FloatImage& image)
    {
        return support::coveredPixels(image, 0.01f).count();
    }

    osg::ref_ptr<Voxels> _voxels;
    osg::ref_ptr<VolumeAppearance> _volume;
};

const VolumeAppearance::Technique techniques[] = {VolumeAppearance::SLABS,
                                                  VolumeAppearance::SLICES};

TEST_F(ExtremeValues, ABoundOfSamplesThatIsNone)
{
    for (const auto mode :
         {SamplingMode::VIEWPORT_ALIGNED, SamplingMode::AXIS_ALIGNED, SamplingMode::SPHERICAL})
        for (const auto technique : techniques) {
            _volume->setTechnique(technique);
            _volume->setSamplingMode(mode);
            ASSERT_TRUE(_volume->setMaximumSamples(4096));
            const FloatImage expected = picture();
            ASSERT_GT(shown(expected), 300u);
            for (int less = 0; less < 4; ++less) {
                ASSERT_TRUE(_volume->setMaximumSamples(std::numeric_limits<int>::max() - less));
                EXPECT_EQ(compare(picture(), expected).maximum, 0.0);
            }
        }
}

// No view takes more than 65536, whatever it asks for: neither is it waited for, nor is there no
// memory.
TEST_F(ExtremeValues, ABoundOfSamplesThatIsNoneAndTheShortestPeriod)
{
    const RenderOptions small = view().size(4, 4);
    ASSERT_TRUE(_volume->setMaximumSamples(4096));
    const FloatImage expected = picture(_volume, small);
    ASSERT_TRUE(_volume->setSamplingPeriod(osg::Vec3d(1e-18, 1e-18, 1e-18)));
    ASSERT_TRUE(_volume->setMaximumSamples(std::numeric_limits<int>::max()));
    for (const auto technique : techniques) {
        _volume->setTechnique(technique);
        support::SceneRenderer renderer(_volume, small);
        EXPECT_LT(compare(renderer.render(), expected).maximum, 0.02);
        EXPECT_EQ(renderer.glError(), 0u);
    }
}

TEST_F(ExtremeValues, Periods)
{
    for (const auto technique : techniques)
        for (const double period : {1e-18, 1e18}) {
            _volume->setTechnique(technique);
            ASSERT_TRUE(_volume->setSamplingPeriod(osg::Vec3d(period, period, period)));
            EXPECT_GT(shown(picture()), 300u) << period;
        }
}

// All that shows is opaque where the unit is nothing, and all but nothing where it is endless.
TEST_F(ExtremeValues, OpacityUnits)
{
    for (const auto technique : techniques)
        for (const auto lookup :
             {VolumeAppearance::AFTER_INTERPOLATION, VolumeAppearance::PREINTEGRATED}) {
            _volume->setTechnique(technique);
            _volume->setLookup(lookup);
            ASSERT_TRUE(_volume->setOpacityUnit(1e-18));
            const FloatImage opaque = picture();
            EXPECT_GT(support::coveredPixels(opaque, 0.999f).count(), 300u);
            ASSERT_TRUE(_volume->setOpacityUnit(1e18));
            EXPECT_EQ(shown(picture()), 0u);
        }
}

TEST_F(ExtremeValues, OpacityUnitsAgainstSpacings)
{
    const double spacing = 1e18;
    ASSERT_TRUE(_voxels->setSpacing(osg::Vec3d(spacing, spacing, spacing)));
    _volume = makeVolume(_voxels);
    _volume->setLookupTable(makeTable(smoothPoints(0.2)));
    ASSERT_TRUE(_volume->setOpacityUnit(1e-18));
    osg::ref_ptr<osg::MatrixTransform> back =
        new osg::MatrixTransform(osg::Matrixd::scale(1e-18, 1e-18, 1e-18));
    back->addChild(_volume);
    for (const auto technique : techniques) {
        _volume->setTechnique(technique);
        EXPECT_GT(support::coveredPixels(picture(back, view()), 0.999f).count(), 300u);
    }
}

// The same picture, whatever unit lengths are in.
TEST_F(ExtremeValues, SpacingsAndOrigins)
{
    const FloatImage expected = picture();
    ASSERT_GT(shown(expected), 300u);
    for (const double unit : {1e-18, 1e-9, 1e9, 1e16}) {
        ASSERT_TRUE(_voxels->setSpacing(osg::Vec3d(unit, unit, unit)));
        ASSERT_TRUE(_voxels->setOrigin(osg::Vec3d(unit, 2 * unit, -5 * unit)));
        const osg::ref_ptr<VolumeAppearance> volume = makeVolume(_voxels);
        volume->setLookupTable(_volume->getLookupTable());
        osg::ref_ptr<osg::MatrixTransform> back =
            new osg::MatrixTransform(osg::Matrixd::translate(-unit, -2 * unit, 5 * unit) *
                                     osg::Matrixd::scale(1 / unit, 1 / unit, 1 / unit));
        back->addChild(volume);
        EXPECT_LT(compare(picture(back, view()), expected).maximum, 2e-3) << unit;
    }
}

TEST_F(ExtremeValues, Ranges)
{
    for (const osg::Vec2d& range : {osg::Vec2d(-1e300, 1e300), osg::Vec2d(0.0, 1e-30),
                                    osg::Vec2d(1e10, 1e10 + 1e-5), osg::Vec2d(-8e307, 8e307)}) {
        ASSERT_TRUE(_voxels->setRange(range)) << range.x() << " " << range.y();
        for (const auto lookup :
             {VolumeAppearance::AFTER_INTERPOLATION, VolumeAppearance::BEFORE_INTERPOLATION,
              VolumeAppearance::PREINTEGRATED, VolumeAppearance::AUTOMATIC_LOOKUP}) {
            _volume->setLookup(lookup);
            EXPECT_EQ(shown(picture()) > 300, range.x() < 1.0) << range.x() << " " << range.y();
        }
    }
}

TEST_F(ExtremeValues, TablesAtDataValues)
{
    osg::ref_ptr<LookupTable> table = new LookupTable;
    const glm::dvec4 color(1.0, 0.5, 0.2, 0.1);
    ASSERT_TRUE(table->setPoints({{-1e308, color}, {1e308, color}}, LookupTable::DATA_VALUES));
    _volume->setLookupTable(table);
    for (const osg::Vec2d& range : {osg::Vec2d(0.0, 1.0), osg::Vec2d(0.0, 1e-30)}) {
        ASSERT_TRUE(_voxels->setRange(range));
        for (const auto lookup :
             {VolumeAppearance::AFTER_INTERPOLATION, VolumeAppearance::PREINTEGRATED}) {
            _volume->setLookup(lookup);
            EXPECT_GT(shown(picture()), 300u);
        }
    }
}

TEST_F(ExtremeValues, IsoValues)
{
    _volume->setRayFunction(VolumeAppearance::ISOSURFACE);
    ASSERT_TRUE(_volume->setIsoValue(0.5));
    ASSERT_GT(shown(picture()), 100u);
    for (const double value : {-1e300, 1e300}) { // no such value is there
        ASSERT_TRUE(_volume->setIsoValue(value));
        EXPECT_EQ(shown(picture()), 0u) << value;
    }
    ASSERT_TRUE(_volume->setIsoValue(1e-300));
    picture();
}

TEST_F(ExtremeValues, Materials)
{
    _volume->setShading(true);
    for (const int bits : {16, 32})
        for (const double shininess : {0.0, 1e-300, 1e7}) {
            ASSERT_TRUE(_volume->setAccumulationBits(bits));
            ASSERT_TRUE(_volume->setMaterial({1000.0, 1000.0, 1000.0, shininess}));
            EXPECT_GT(shown(picture()), 300u) << bits << " " << shininess;
        }
}

TEST_F(ExtremeValues, TolerancesAndTimes)
{
    const FloatImage expected = picture();
    for (const double value : {1e-300, 1e300}) { // the second allows any error
        ASSERT_TRUE(_volume->setErrorTolerance(value));
        EXPECT_GT(shown(picture()), 300u) << value;
        EXPECT_LT(compare(picture(), expected).maximum, value < 1.0 ? 0.02 : 0.5) << value;
        ASSERT_TRUE(_volume->setTargetFrameTime(value));
        EXPECT_GT(shown(picture()), 300u) << value;
    }
}

// Boxes of the size that vertices may have.
TEST_F(ExtremeValues, Vertices)
{
    const FloatImage expected = picture();
    for (const double unit : {1e-17, 1e16}) {
        const osg::BoundingBoxd box(0, 0, 0, 12 * unit, 12 * unit, 12 * unit);
        ASSERT_TRUE(_voxels->setSpacing(osg::Vec3d(unit, unit, unit)));
        _volume->setChild(0, VolumeGeometry::createBox(box));
        osg::ref_ptr<osg::MatrixTransform> back =
            new osg::MatrixTransform(osg::Matrixd::scale(1 / unit, 1 / unit, 1 / unit));
        back->addChild(_volume);
        EXPECT_LT(compare(picture(back, view()), expected).maximum, 2e-3) << unit;
    }
}

} // namespace

} // namespace ExtremeValuesTest
