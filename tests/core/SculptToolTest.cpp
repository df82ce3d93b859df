#include <osgVolumizer/core/voxels/Half.h>
#include <osgVolumizer/core/voxels/SculptTool.h>
#include <osgVolumizer/core/voxels/VoxelData.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace SculptToolTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

const Box3i BOX{{2, 3, 4}, {25, 24, 26}};
const glm::dvec3 MIDDLE(12.3, 13.0, 14.75);

const SculptOperation OPERATIONS[] = {SculptOperation::PERLIN_ADD, SculptOperation::PERLIN_SUB,
                                      SculptOperation::MAX_ADD, SculptOperation::MIN_SUB,
                                      SculptOperation::ERASE};

// As the notes have it, with V and T in [0, 1].
double formula(SculptOperation operation, double v, double t)
{
    switch (operation) {
    case SculptOperation::PERLIN_ADD:
        return v + t - v * t;
    case SculptOperation::PERLIN_SUB:
        return v - v * t;
    case SculptOperation::MAX_ADD:
        return std::max(v, t);
    case SculptOperation::MIN_SUB:
        return std::min(v, 1.0 - t);
    case SculptOperation::ERASE:
        break;
    }
    return t > 0.0 ? 0.0 : v;
}

SculptTool makeTool(SculptOperation operation, double low, double high)
{
    SculptTool tool;
    tool.operation = operation;
    tool.radius = glm::dvec3(8.0, 6.5, 9.0);
    tool.strength = 0.8;
    tool.low = tool.erased = low;
    tool.high = high;
    return tool;
}

// T of a round tool.
double roundValue(const SculptTool& tool, const glm::ivec3& p)
{
    const glm::dvec3 d = (glm::dvec3(p) - MIDDLE) / tool.radius;
    return tool.strength * std::max(0.0, 1.0 - std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z));
}

std::vector<double> waves(std::size_t count, double low, double high)
{
    std::vector<double> values(count);
    for (std::size_t i = 0; i < count; ++i)
        values[i] = low + (high - low) * (0.5 + 0.5 * std::sin(0.37 * double(i)));
    return values;
}

bool isIn(const std::vector<Box3i>& boxes, const glm::ivec3& p)
{
    return std::any_of(boxes.begin(), boxes.end(), [&p](const Box3i& box) {
        return !intersection(box, Box3i{p, p + 1}).empty();
    });
}

template <class Function>
void forSamples(const Box3i& box, Function&& function)
{
    std::size_t i = 0;
    for (int z = box.min.z; z < box.max.z; ++z)
        for (int y = box.min.y; y < box.max.y; ++y)
            for (int x = box.min.x; x < box.max.x; ++x)
                function(glm::ivec3(x, y, z), i++);
}

} // namespace

class SculptEachType : public ::testing::TestWithParam<VoxelType>
{
};

TEST_P(SculptEachType, FollowsTheFormulas)
{
    const VoxelType type = GetParam();
    double low = 0.0, high = 1.0;
    voxelTypeRange(type, low, high);
    const auto count = static_cast<std::size_t>(sampleCount(BOX.size()));
    // What the type can hold: as drawn from numbers once before.
    std::vector<unsigned char> bytes(count * voxelTypeSize(type));
    convertVoxels(waves(count, low, high).data(), VoxelType::FLOAT64, bytes.data(), type, count);
    std::vector<double> before(count), after(count);
    convertVoxels(bytes.data(), type, before.data(), VoxelType::FLOAT64, count);
    const double tolerance = type == VoxelType::HALF      ? 1e-3
                             : type == VoxelType::FLOAT32 ? 1e-6
                             : type == VoxelType::FLOAT64 ? 1e-12
                                                          : 0.51;
    for (const SculptOperation operation : OPERATIONS) {
        std::vector<unsigned char> data = bytes;
        const SculptTool tool = makeTool(operation, low, high);
        std::vector<Box3i> changed;
        applyTool(tool, MIDDLE, data.data(), BOX, type, 1, changed);
        convertVoxels(data.data(), type, after.data(), VoxelType::FLOAT64, count);
        double worst = 0.0;
        int different = 0, unnoticed = 0;
        forSamples(BOX, [&](const glm::ivec3& p, std::size_t i) {
            const double v = (before[i] - low) / (high - low);
            const double expected = low + (high - low) * formula(operation, v, roundValue(tool, p));
            worst = std::max(worst, std::fabs(after[i] - expected));
            different += after[i] != before[i];
            unnoticed += after[i] != before[i] && !isIn(changed, p);
        });
        EXPECT_LE(worst, tolerance) << int(operation);
        EXPECT_GT(different, 200) << int(operation);
        EXPECT_EQ(unnoticed, 0) << int(operation);
    }
}

INSTANTIATE_TEST_SUITE_P(All, SculptEachType,
                         ::testing::Values(VoxelType::INT8, VoxelType::UINT8, VoxelType::INT16,
                                           VoxelType::UINT16, VoxelType::INT32, VoxelType::UINT32,
                                           VoxelType::HALF, VoxelType::FLOAT32, VoxelType::FLOAT64),
                         [](const auto& type) { return voxelTypeName(type.param); });

TEST(SculptTool, NeverGoesTheWrongWayBeyondTheRange)
{
    const auto count = static_cast<std::size_t>(sampleCount(BOX.size()));
    const std::vector<double> wide = waves(count, -3.0, 4.0);
    for (const SculptOperation operation : OPERATIONS) {
        std::vector<double> data = wide;
        std::vector<Box3i> changed;
        applyTool(makeTool(operation, 0.0, 1.0), MIDDLE, data.data(), BOX, VoxelType::FLOAT64, 1,
                  changed);
        const bool adds =
            operation == SculptOperation::PERLIN_ADD || operation == SculptOperation::MAX_ADD;
        if (operation == SculptOperation::ERASE) continue;
        for (std::size_t i = 0; i < count; ++i)
            EXPECT_TRUE(adds ? data[i] >= wide[i] : data[i] <= wide[i]) << i;
        EXPECT_FALSE(changed.empty());
    }
}

TEST(SculptTool, KeepsWithinTheType)
{
    std::vector<unsigned char> data(std::size_t(sampleCount(BOX.size())), 200);
    SculptTool tool = makeTool(SculptOperation::MAX_ADD, 0.0, 1000.0);
    tool.strength = 1.0;
    std::vector<Box3i> changed;
    applyTool(tool, glm::dvec3(12, 13, 14), data.data(), BOX, VoxelType::UINT8, 1, changed);
    EXPECT_EQ(*std::max_element(data.begin(), data.end()), 255);
    tool = makeTool(SculptOperation::ERASE, -50.0, 1000.0);
    applyTool(tool, glm::dvec3(12, 13, 14), data.data(), BOX, VoxelType::UINT8, 1, changed);
    EXPECT_EQ(*std::min_element(data.begin(), data.end()), 0);
}

TEST(SculptTool, FillsHolesByWhatAdds)
{
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const SculptOperation operation : OPERATIONS) {
        std::vector<float> data(std::size_t(sampleCount(BOX.size())), nan);
        const SculptTool tool = makeTool(operation, 1.0, 3.0);
        std::vector<Box3i> changed;
        applyTool(tool, MIDDLE, data.data(), BOX, VoxelType::FLOAT32, 1, changed);
        const bool fills =
            operation != SculptOperation::PERLIN_SUB && operation != SculptOperation::MIN_SUB;
        EXPECT_EQ(changed.empty(), !fills);
        forSamples(BOX, [&](const glm::ivec3& p, std::size_t i) {
            const double t = roundValue(tool, p);
            if (!fills || t == 0.0) {
                EXPECT_TRUE(std::isnan(data[i]));
            } else {
                EXPECT_NEAR(data[i], operation == SculptOperation::ERASE ? 1.0 : 1.0 + 2.0 * t,
                            1e-6);
            }
        });
    }
}

TEST(SculptTool, ChangesAlphaOnly)
{
    const auto count = static_cast<std::size_t>(sampleCount(BOX.size()));
    std::vector<unsigned char> data(4 * count);
    for (std::size_t i = 0; i < data.size(); ++i)
        data[i] = static_cast<unsigned char>(i * 7);
    const std::vector<unsigned char> before = data;
    std::vector<Box3i> changed;
    const SculptTool tool = makeTool(SculptOperation::PERLIN_ADD, 0.0, 255.0);
    applyTool(tool, MIDDLE, data.data(), BOX, VoxelType::UINT8, 4, changed);
    int different = 0;
    forSamples(BOX, [&](const glm::ivec3& p, std::size_t i) {
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(data[4 * i + c], before[4 * i + c]);
        const double v = before[4 * i + 3] / 255.0;
        const double expected = 255.0 * formula(tool.operation, v, roundValue(tool, p));
        EXPECT_NEAR(data[4 * i + 3], expected, 0.51);
        different += data[4 * i + 3] != before[4 * i + 3];
    });
    EXPECT_GT(different, 200);
}

TEST(SculptTool, ABoxHasCorners)
{
    SculptTool tool = makeTool(SculptOperation::MAX_ADD, 0.0, 1.0);
    tool.shape = SculptShape::BOX;
    tool.radius = glm::dvec3(4.0);
    tool.strength = 1.0;
    EXPECT_DOUBLE_EQ(toolValue(tool, {3.0, 3.0, -3.0}), 0.25);
    EXPECT_DOUBLE_EQ(toolValue(tool, {0.0, 0.0, -2.0}), 0.5);
    EXPECT_DOUBLE_EQ(toolValue(tool, {4.0, 0.0, 0.0}), 0.0);
    tool.shape = SculptShape::ROUND;
    EXPECT_DOUBLE_EQ(toolValue(tool, {3.0, 3.0, -3.0}), 0.0);
    const Box3i box = toolBox(tool, {10.0, 10.5, 1e30});
    EXPECT_EQ(box.min.x, 6);
    EXPECT_EQ(box.max.x, 15);
    EXPECT_EQ(box.min.y, 7);
    EXPECT_EQ(box.max.y, 15);
    EXPECT_TRUE(intersection(box, Box3i{glm::ivec3(0), glm::ivec3(100)}).empty());
}

} // namespace SculptToolTest
