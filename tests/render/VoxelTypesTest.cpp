// The same data in every type of voxel shows the same picture.

#include "Volumes.h"

#include <osgVolumizer/core/voxels/VoxelData.h>

#include <support/GLTest.h>

#include <cstring>
#include <limits>

namespace VoxelTypesTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 17;
constexpr double HIGHEST = 51.0; // small whole numbers: every type holds them

RenderOptions view()
{
    return RenderOptions().size(72, 72).perspective(45.0).lookAt({28, -16, 24}, {8, 8, 8},
                                                                 {0, 0, 1});
}

std::vector<float> wholeNumbers()
{
    std::vector<float> values;
    for (int z = 0; z < SIZE; ++z)
        for (int y = 0; y < SIZE; ++y)
            for (int x = 0; x < SIZE; ++x)
                values.push_back(
                    static_cast<float>(std::round(HIGHEST * bumps(glm::dvec3(x, y, z)))));
    return values;
}

osg::ref_ptr<Voxels> voxelsOf(VoxelType type, int components, const void* data, std::size_t bytes)
{
    VoxelSource::Description description;
    description.size = glm::ivec3(SIZE);
    description.type = type;
    description.components = components;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    EXPECT_TRUE(source->allocate(description));
    EXPECT_EQ(std::size_t(description.sizeInBytes()), bytes);
    std::memcpy(source->data(), data, bytes);
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    EXPECT_TRUE(voxels->setRange(osg::Vec2d(0.0, HIGHEST)));
    EXPECT_TRUE(voxels->setBrickSize({9, 9, 9}));
    return voxels;
}

osg::ref_ptr<Voxels> scalars(VoxelType type, const std::vector<float>& values)
{
    std::vector<unsigned char> bytes(values.size() * voxelTypeSize(type));
    core::convertVoxels(values.data(), VoxelType::FLOAT32, bytes.data(), type, values.size(), 1.0,
                        0.0);
    return voxelsOf(type, 1, bytes.data(), bytes.size());
}

// One colour, with an opacity of value / 255.
Points points()
{
    return {{0.0, {1.0, 0.6, 0.2, 0.0}}, {1.0, {1.0, 0.6, 0.2, HIGHEST / 255.0}}};
}

FloatImage pictureOf(Voxels* voxels, VolumeAppearance::Technique technique)
{
    osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
    volume->setLookupTable(makeTable(points()));
    volume->setTechnique(technique);
    support::SceneRenderer renderer(volume, view());
    const FloatImage image = renderer.render();
    EXPECT_EQ(renderer.glError(), 0u);
    return image;
}

class VoxelTypes : public support::GLTest,
                   public ::testing::WithParamInterface<VolumeAppearance::Technique>
{
};

TEST_P(VoxelTypes, AllShowTheSame)
{
    const std::vector<float> values = wholeNumbers();
    const FloatImage expected = pictureOf(scalars(VoxelType::FLOAT32, values), GetParam());
    EXPECT_GT(support::coveredPixels(expected, 0.2f).count(), 1000u);
    for (const VoxelType type :
         {VoxelType::UINT8, VoxelType::INT8, VoxelType::UINT16, VoxelType::INT16, VoxelType::UINT32,
          VoxelType::INT32, VoxelType::HALF, VoxelType::FLOAT64}) {
        const FloatImage image = pictureOf(scalars(type, values), GetParam());
        // Texels of 16 bits come back as floats of 24; their range is 1285 times the data's.
        EXPECT_LT(compare(image, expected).maximum, 1e-4) << int(type);
    }
}

TEST_P(VoxelTypes, ColouredVoxelsNeedNoTable)
{
    const std::vector<float> values = wholeNumbers();
    std::vector<unsigned char> texels;
    for (const float v : values)
        for (const int c : {255, 153, 51, int(v)})
            texels.push_back(static_cast<unsigned char>(c));
    const FloatImage expected = pictureOf(scalars(VoxelType::FLOAT32, values), GetParam());
    const FloatImage image =
        pictureOf(voxelsOf(VoxelType::UINT8, 4, texels.data(), texels.size()), GetParam());
    support::savePicture(image, "voxels_rgba");
    EXPECT_LT(compare(image, expected).maximum, 1e-4);
}

TEST_P(VoxelTypes, NegativeDataKeepTheirValues)
{
    // The same picture of data and range moved down together.
    const std::vector<float> values = wholeNumbers();
    const FloatImage expected = pictureOf(scalars(VoxelType::FLOAT32, values), GetParam());
    std::vector<float> moved = values;
    for (float& v : moved)
        v -= 100.0f;
    for (const VoxelType type :
         {VoxelType::INT8, VoxelType::INT16, VoxelType::INT32, VoxelType::FLOAT32}) {
        osg::ref_ptr<Voxels> voxels = scalars(type, moved);
        ASSERT_TRUE(voxels->setRange(osg::Vec2d(-100.0, HIGHEST - 100.0)));
        EXPECT_LT(compare(pictureOf(voxels, GetParam()), expected).maximum, 1e-4) << int(type);
    }
}

TEST_P(VoxelTypes, HugeIntegersAreScaledBeforeTheyBecomeFloats)
{
    // Values 2^31 - 52 .. 2^31 - 1: as floats they would all be the same.
    const std::vector<float> values = wholeNumbers();
    std::vector<std::int32_t> huge;
    for (const float v : values)
        huge.push_back(std::numeric_limits<std::int32_t>::max() - int(HIGHEST) + int(v));
    osg::ref_ptr<Voxels> voxels = voxelsOf(VoxelType::INT32, 1, huge.data(), huge.size() * 4);
    const double highest = std::numeric_limits<std::int32_t>::max();
    ASSERT_TRUE(voxels->setRange(osg::Vec2d(highest - HIGHEST, highest)));
    const FloatImage expected = pictureOf(scalars(VoxelType::FLOAT32, values), GetParam());
    EXPECT_LT(compare(pictureOf(voxels, GetParam()), expected).maximum, 1e-4);
}

TEST_P(VoxelTypes, HolesDoNotSpread)
{
    // NaN and infinite voxels show what the lowest value shows: nothing.
    std::vector<float> values = wholeNumbers(), filled = values;
    const auto at = [](int x, int y, int z) { return std::size_t(x + SIZE * (y + SIZE * z)); };
    const float holes[] = {std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::infinity(),
                           -std::numeric_limits<float>::infinity()};
    const std::size_t places[] = {at(8, 8, 8), at(3, 12, 5), at(0, 0, 16)};
    for (int i = 0; i < 3; ++i) {
        values[places[i]] = holes[i];
        filled[places[i]] = 0.0f;
    }
    const FloatImage expected = pictureOf(scalars(VoxelType::FLOAT32, filled), GetParam());
    for (const VoxelType type : {VoxelType::FLOAT32, VoxelType::FLOAT64, VoxelType::HALF}) {
        const FloatImage image = pictureOf(scalars(type, values), GetParam());
        EXPECT_LT(compare(image, expected).maximum, 1e-4) << int(type); // infinite where NaN
    }
}

INSTANTIATE_TEST_SUITE_P(Techniques, VoxelTypes,
                         ::testing::Values(VolumeAppearance::SLABS, VolumeAppearance::SLICES),
                         techniqueName);

} // namespace

} // namespace VoxelTypesTest
