#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/core/voxels/VoxelData.h>

#include "../support/FolderTest.h"

#include <cstring>
#include <numeric>

namespace NumpyTest {

using namespace osgVolumizer;

namespace {

class Numpy : public support::FolderTest
{
protected:
    std::string write(const std::string& header, const std::string& data, int version = 1) const
    {
        std::string head = header + std::string(15, ' ') + "\n";
        const auto length = static_cast<unsigned>(head.size());
        std::string bytes = "\x93NUMPY" + std::string(1, static_cast<char>(version)) + '\0';
        for (int i = 0; i < (version > 1 ? 4 : 2); ++i)
            bytes += static_cast<char>(length >> (8 * i) & 255);
        return writeBytes("a.npy", bytes + head + data);
    }
    static std::string shorts(int count, bool big = false)
    {
        std::string data;
        for (int i = 0; i < count; ++i) {
            const char low = static_cast<char>(i & 255), high = static_cast<char>(i >> 8);
            data += big ? std::string{high, low} : std::string{low, high};
        }
        return data;
    }
};

void expectCounted(const std::string& file, int first = 0, int step = 0)
{
    const auto voxels = readVoxels(file);
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_EQ(osg::Vec3i(4, 3, 2), (*voxels)->getSize());
    EXPECT_EQ(VoxelType::UINT16, (*voxels)->getType());
    std::vector<std::uint16_t> read(24), expected(24);
    ASSERT_TRUE(
        (*voxels)->getSource()->readStep(step, 0, {{0, 0, 0}, {4, 3, 2}}, read.data()).ok());
    std::iota(expected.begin(), expected.end(), static_cast<std::uint16_t>(first));
    EXPECT_EQ(expected, read);
}

} // namespace

TEST_F(Numpy, ArraysOfEitherOrder)
{
    const std::string c = "{'descr': '<u2', 'fortran_order': False, 'shape': (2, 3, 4), }";
    expectCounted(write(c, shorts(24)));
    expectCounted(write(c, shorts(24), 2));
    expectCounted(
        write("{'descr': '<u2', 'fortran_order': True, 'shape': (4, 3, 2), }", shorts(24)));
    expectCounted(write("{'descr': '>u2', 'fortran_order': False, 'shape': (1, 2, 3, 4), }",
                        shorts(24, true)));
}

TEST_F(Numpy, TheFourthDimensionIsTime)
{
    const std::string file =
        write("{'descr': '<u2', 'fortran_order': False, 'shape': (3, 2, 3, 4), }", shorts(72));
    const auto voxels = readVoxels(file);
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    EXPECT_EQ(3, (*voxels)->getStepCount());
    expectCounted(file, 48, 2);
}

TEST_F(Numpy, WhatIsNoVolumeIsRefusedInASentence)
{
    const std::pair<const char*, ErrorCode> cases[] = {
        {"{'descr': '<i8', 'fortran_order': False, 'shape': (2, 3, 4), }",
         ErrorCode::NOT_SUPPORTED},
        {"{'descr': '<c8', 'fortran_order': False, 'shape': (2, 3, 4), }",
         ErrorCode::NOT_SUPPORTED},
        {"{'descr': '|u1', 'fortran_order': False, 'shape': (24,), }", ErrorCode::NOT_SUPPORTED},
        {"{'descr': '|u1', 'fortran_order': False, 'shape': (2,1,2,3,4), }",
         ErrorCode::NOT_SUPPORTED},
        {"{'descr': '|u1', 'fortran_order': False, 'shape': (2, -3, 4), }",
         ErrorCode::FILE_UNREADABLE},
        {"{'descr': '|u1', 'fortran_order': False, 'shape': (999999999, 999999999, 9), }",
         ErrorCode::FILE_UNREADABLE},
        {"{'descr': '<u2', 'fortran_order': False, 'shape': (2, 3, 5), }",
         ErrorCode::FILE_UNREADABLE},
        {"{}", ErrorCode::FILE_UNREADABLE}};
    for (const auto& [header, code] : cases) {
        const auto voxels = readVoxels(write(header, shorts(24)));
        EXPECT_EQ(code, voxels.status.code) << header;
        EXPECT_NE(std::string::npos, voxels.status.text.find("a.npy")) << voxels.status.text;
    }
    EXPECT_EQ(
        ErrorCode::FILE_UNREADABLE,
        readVoxels(writeBytes("b.npy", std::string("\x93NUMPY\1\0\xff\xff{", 11))).status.code);
}

} // namespace NumpyTest
