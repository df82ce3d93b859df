#include <osgVolumizer/core/voxels/VoxelType.h>

#include <gtest/gtest.h>

namespace VoxelTypeTest {

using namespace osgVolumizer;

TEST(VoxelType, NamesRoundTrip)
{
    for (int i = 0; i <= static_cast<int>(VoxelType::FLOAT64); ++i) {
        const auto type = static_cast<VoxelType>(i);
        const Result<VoxelType> back = voxelTypeFromName(voxelTypeName(type));
        ASSERT_TRUE(back.ok());
        EXPECT_EQ(type, *back);
    }
}

TEST(VoxelType, SizesAndRanges)
{
    EXPECT_EQ(1u, voxelTypeSize(VoxelType::INT8));
    EXPECT_EQ(2u, voxelTypeSize(VoxelType::HALF));
    EXPECT_EQ(4u, voxelTypeSize(VoxelType::FLOAT32));
    EXPECT_EQ(8u, voxelTypeSize(VoxelType::FLOAT64));
    double low = 0, high = 0;
    voxelTypeRange(VoxelType::INT16, low, high);
    EXPECT_EQ(-32768.0, low);
    EXPECT_EQ(32767.0, high);
    voxelTypeRange(VoxelType::FLOAT32, low, high);
    EXPECT_EQ(0.0, low);
    EXPECT_EQ(1.0, high);
}

TEST(VoxelType, UnknownNameIsNamed)
{
    const Result<VoxelType> type = voxelTypeFromName("uint9");
    EXPECT_EQ(ErrorCode::VALUE_INVALID, type.status.code);
    EXPECT_NE(std::string::npos, type.status.text.find("uint9"));
}

} // namespace VoxelTypeTest
