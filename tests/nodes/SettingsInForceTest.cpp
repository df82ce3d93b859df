// VolumeAppearance::getSettingsInForce(): what is drawn in place of what was asked for, and why.
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

#include <gtest/gtest.h>

namespace SettingsInForceTest {

using namespace osgVolumizer;

namespace {

using A = VolumeAppearance;

class SettingsInForce : public testing::Test
{
protected:
    SettingsInForce() { fill(1); }

    void fill(int components)
    {
        VoxelSource::Description description;
        description.size = {8, 8, 8};
        description.components = components;
        const osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
        EXPECT_TRUE(source->allocate(description));
        _appearance->setVoxels(new Voxels(source));
        _geometry = VolumeGeometry::createBox(*_appearance->getVoxels());
    }
    /// Two tetrahedra apart: no convex region.
    void breakGeometry()
    {
        core::TetraSet set = *_geometry->getTetraSet();
        set.indices = {0, 1, 2, 4, 3, 2, 1, 7};
        ASSERT_TRUE(_geometry->setTetraSet(set));
    }
    A::Settings settings() const { return _appearance->getSettingsInForce(*_geometry); }
    bool hasReason(const std::string& text) const
    {
        for (const std::string& reason : settings().reasons)
            if (reason.find(text) != std::string::npos) return true;
        return false;
    }

    osg::ref_ptr<A> _appearance = new A;
    osg::ref_ptr<VolumeGeometry> _geometry;
};

} // namespace

TEST_F(SettingsInForce, WhatCanBeHadIsAsItWasAskedFor)
{
    _appearance->setTechnique(A::SLABS);
    _appearance->setInterpolation(A::CUBIC);
    _appearance->setLookup(A::PREINTEGRATED);
    _appearance->setShading(true);
    const A::Settings s = settings();
    EXPECT_EQ(s.technique, A::SLABS);
    EXPECT_EQ(s.interpolation, A::CUBIC);
    EXPECT_EQ(s.lookup, A::PREINTEGRATED);
    EXPECT_EQ(s.rayFunction, A::COMPOSITE);
    EXPECT_TRUE(s.shading);
    EXPECT_TRUE(s.reasons.empty()) << s.reasons.front();
}

TEST_F(SettingsInForce, AutomaticSettingsAreResolved)
{
    _appearance->getLookupTable()->setRamp(0.5, 1.0);
    EXPECT_EQ(settings().technique, A::SLABS);
    EXPECT_TRUE(hasReason("convex"));
    EXPECT_EQ(settings().lookup, A::AFTER_INTERPOLATION);
    EXPECT_TRUE(hasReason("smooth"));
    _appearance->getLookupTable()->setRamp(0.5, 0.0);
    EXPECT_EQ(settings().lookup, A::PREINTEGRATED);
    EXPECT_TRUE(hasReason("jumps"));
}

TEST_F(SettingsInForce, TheGeometryDecidesAboutSlabs)
{
    breakGeometry();
    _appearance->setRayFunction(A::ISOSURFACE);
    EXPECT_EQ(settings().technique, A::SLABS);
    EXPECT_TRUE(hasReason("walk through the tetrahedra"));
    EXPECT_EQ(settings().rayFunction, A::ISOSURFACE);
    _appearance->setTechnique(A::SLICES);
    EXPECT_EQ(settings().technique, A::SLICES);
    EXPECT_EQ(settings().rayFunction, A::COMPOSITE);
    EXPECT_TRUE(hasReason("ISOSURFACE needs slabs"));
}

TEST_F(SettingsInForce, ScalarsAreNeverSlices)
{
    ASSERT_TRUE(
        _geometry->setScalars(std::vector<float>(_geometry->getTetraSet()->vertices.size(), 1.0f)));
    _appearance->setTechnique(A::SLICES);
    EXPECT_EQ(settings().technique, A::SLABS);
    EXPECT_TRUE(hasReason("are not drawn as slices"));
}

TEST_F(SettingsInForce, TheVoxelsDecideAboutInterpolationAndRays)
{
    ASSERT_TRUE(_appearance->getVoxels()->setBrickSize({5, 5, 5}));
    _appearance->setInterpolation(A::CUBIC);
    EXPECT_EQ(settings().interpolation, A::CUBIC); // the overlap that it needs was chosen
    ASSERT_TRUE(_appearance->getVoxels()->setOverlap(1));
    EXPECT_EQ(settings().interpolation, A::LINEAR);
    EXPECT_TRUE(hasReason("interpolation is linear"));
    fill(4);
    _appearance->setRayFunction(A::SUM);
    _appearance->setLookup(A::PREINTEGRATED);
    EXPECT_EQ(settings().rayFunction, A::COMPOSITE);
    EXPECT_TRUE(hasReason("one component, but these have 4"));
    EXPECT_EQ(settings().lookup, A::AFTER_INTERPOLATION);
    EXPECT_TRUE(hasReason("lookup is after interpolation"));
}

TEST_F(SettingsInForce, LookupBeforeInterpolationOfWhatVaries)
{
    _appearance->setLookup(A::BEFORE_INTERPOLATION);
    EXPECT_EQ(settings().lookup, A::BEFORE_INTERPOLATION);
    _appearance->setInterpolation(A::NEAREST);
    EXPECT_EQ(settings().lookup, A::AFTER_INTERPOLATION);
}

TEST_F(SettingsInForce, AVolumeThatPaintsIsSampledBySimplerMeans)
{
    _appearance->setCombineRule(A::PAINT);
    _appearance->setInterpolation(A::CUBIC);
    _appearance->setLookup(A::BEFORE_INTERPOLATION);
    EXPECT_EQ(settings().interpolation, A::LINEAR);
    EXPECT_EQ(settings().lookup, A::AFTER_INTERPOLATION);
}

TEST_F(SettingsInForce, NothingIsDrawnOfAnEmptyVolume)
{
    const osg::ref_ptr<VolumeGeometry> empty = new VolumeGeometry;
    ASSERT_EQ(_appearance->getSettingsInForce(*empty).reasons.size(), 1u);
    _appearance->setVoxels(new Voxels);
    EXPECT_TRUE(hasReason("nothing is drawn"));
}

// Nothing is known of any context here, so that weights are taken to have 8 bits.
TEST_F(SettingsInForce, FilteringIsExactForAToleranceThatTexturesMayNotKeep)
{
    auto* source = static_cast<MemoryVoxelSource*>(_appearance->getVoxels()->getSource());
    auto* values = static_cast<unsigned char*>(source->data());
    for (int i = 0; i < 8 * 8 * 8; ++i)
        values[i] = static_cast<unsigned char>(i * 101);
    EXPECT_FALSE(settings().exactFiltering);
    ASSERT_TRUE(_appearance->setErrorTolerance(1e-3));
    EXPECT_TRUE(settings().exactFiltering);
    EXPECT_TRUE(hasReason("filtering is exact"));
    _appearance->setInterpolation(A::NEAREST);
    EXPECT_FALSE(settings().exactFiltering);
    EXPECT_FALSE(hasReason("filtering is exact"));
    _appearance->setInterpolation(A::LINEAR);
    _appearance->setExactFiltering(true);
    EXPECT_TRUE(settings().exactFiltering);
    EXPECT_FALSE(hasReason("filtering is exact"));
}

} // namespace SettingsInForceTest
