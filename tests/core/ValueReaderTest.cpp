#include <osgVolumizer/core/voxels/ValueReader.h>

#include <glm/common.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

namespace ValueReaderTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

// Linear along each axis, with every product: trilinear interpolation has it exactly.
double trilinear(const glm::dvec3& p)
{
    return 20.0 + 0.5 * p.x + 0.25 * p.y + 0.75 * p.z + 0.03125 * p.x * p.y - 0.0625 * p.y * p.z +
           0.0078125 * p.x * p.y * p.z;
}

glm::dvec3 trilinearGradient(const glm::dvec3& p)
{
    return {0.5 + 0.03125 * p.y + 0.0078125 * p.y * p.z,
            0.25 + 0.03125 * p.x - 0.0625 * p.z + 0.0078125 * p.x * p.z,
            0.75 - 0.0625 * p.y + 0.0078125 * p.x * p.y};
}

// A volume of doubles, whose bricks are cut out when they are asked for.
class Volume
{
public:
    Volume(const glm::ivec3& size, double (*field)(const glm::dvec3&)) : _size(size)
    {
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x)
                    values.push_back(field(glm::dvec3(x, y, z)));
    }
    double& at(int x, int y, int z) { return values[std::size_t(x + _size.x * (y + _size.y * z))]; }
    ValueReader reader(const BrickLayout& layout,
                       ValueReader::Interpolation how = ValueReader::LINEAR, double hole = NAN)
    {
        const auto load = [this, layout](std::int64_t brick) {
            ++loads[brick];
            if (absent.count(brick)) return ValueReader::Brick();
            const Box3i samples = layout.brick(brick).samples;
            auto block = std::make_shared<std::vector<double>>(
                static_cast<std::size_t>(sampleCount(samples.size())));
            copyRegion({values.data(), VoxelType::FLOAT64, 1, _size}, samples, block->data());
            return ValueReader::Brick{{block->data(), VoxelType::FLOAT64, 1, samples.size()},
                                      block};
        };
        return ValueReader(layout, load, how, 0, hole);
    }

    std::vector<double> values;
    std::map<std::int64_t, int> loads;
    std::set<std::int64_t> absent;

private:
    glm::ivec3 _size;
};

const glm::ivec3 SIZE(23, 17, 12);

std::vector<BrickLayout> layouts()
{
    std::vector<BrickLayout> all;
    for (const int overlap : {1, 2, 3})
        for (const PartialBricks partial :
             {PartialBricks::SHRINK_TO_FIT, PartialBricks::AVERAGE_UP})
            all.push_back(*BrickLayout::create(SIZE, {6, 9, 5}, overlap, partial));
    all.push_back(*BrickLayout::create(SIZE, SIZE, 1));
    return all;
}

std::vector<glm::dvec3> positions()
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::vector<glm::dvec3> all;
    for (int i = 0; i < 500; ++i)
        all.push_back(glm::dvec3(uniform(random), uniform(random), uniform(random)) *
                      glm::dvec3(SIZE - 1));
    for (int i = 0; i < 200; ++i) // samples, on which bricks meet
        all.push_back(glm::floor(all[std::size_t(i)] + 0.5));
    return all;
}

} // namespace

TEST(ValueReader, InterpolatesAcrossBricks)
{
    for (const BrickLayout& layout : layouts()) {
        Volume volume(SIZE, trilinear);
        ValueReader reader = volume.reader(layout);
        for (const glm::dvec3& p : positions()) {
            EXPECT_NEAR(reader.value(p), trilinear(p), 1e-12);
        }
        for (const auto& load : volume.loads)
            EXPECT_EQ(load.second, 1);
        EXPECT_EQ(std::int64_t(volume.loads.size()), layout.brickCount());
    }
}

TEST(ValueReader, AgreesWithTheSamples)
{
    for (const BrickLayout& layout : layouts()) {
        Volume volume(SIZE, [](const glm::dvec3& p) { return std::sin(12.9 * p.x + p.y * p.z); });
        ValueReader linear = volume.reader(layout);
        ValueReader nearest = volume.reader(layout, ValueReader::NEAREST);
        for (int z = 0; z < SIZE.z; ++z)
            for (int y = 0; y < SIZE.y; ++y)
                for (int x = 0; x < SIZE.x; ++x) {
                    ASSERT_NEAR(linear.value(glm::dvec3(x, y, z)), volume.at(x, y, z), 1e-15);
                    ASSERT_EQ(nearest.value(glm::dvec3(x, y, z)), volume.at(x, y, z));
                }
    }
}

TEST(ValueReader, FindsTheNearestSample)
{
    Volume volume(SIZE, [](const glm::dvec3& p) { return p.x + 100.0 * p.y + 10000.0 * p.z; });
    for (const BrickLayout& layout : layouts()) {
        ValueReader reader = volume.reader(layout, ValueReader::NEAREST);
        EXPECT_EQ(reader.value({4.49, 8.51, 3.0}), 4.0 + 900.0 + 30000.0);
        EXPECT_EQ(reader.value({21.6, 15.4, 10.7}), 22.0 + 1500.0 + 110000.0);
    }
}

TEST(ValueReader, AnswersDoNotDependOnWhatWasAskedBefore)
{
    // Without overlap neighbours differ where they meet.
    const BrickLayout layout = *BrickLayout::create(SIZE, {6, 9, 5}, 0);
    Volume volume(SIZE, trilinear);
    const double below = std::nextafter(5.5, 0.0);
    for (const double from : {1.0, 8.0}) {
        ValueReader reader = volume.reader(layout);
        reader.value({from, 1, 1});
        EXPECT_EQ(reader.value({5.5, 1, 1}), volume.at(6, 1, 1)); // of the farther brick
        reader.value({from, 1, 1});
        EXPECT_EQ(reader.value({below, 1, 1}), volume.at(5, 1, 1));
    }
}

TEST(ValueReader, NothingIsKnownOutsideAndInAbsentBricks)
{
    const BrickLayout layout = *BrickLayout::create(SIZE, {6, 9, 5}, 1);
    Volume volume(SIZE, trilinear);
    volume.absent = {layout.index({1, 0, 0})};
    ValueReader reader = volume.reader(layout, ValueReader::LINEAR, 7.0);
    EXPECT_TRUE(std::isnan(reader.value({-1e-9, 3, 3})));
    EXPECT_TRUE(std::isnan(reader.value({3, 16.0 + 1e-9, 3})));
    EXPECT_TRUE(std::isnan(reader.value({3, NAN, 3})));
    EXPECT_FALSE(std::isnan(reader.value(glm::dvec3(SIZE - 1))));
    EXPECT_FALSE(std::isnan(reader.value(glm::dvec3(0.0))));
    EXPECT_TRUE(std::isnan(reader.value({5.0, 3, 3}))); // of the farther brick
    EXPECT_TRUE(std::isnan(reader.value({9.9, 3, 3})));
    EXPECT_FALSE(std::isnan(reader.value({4.9, 3, 3})));
    EXPECT_FALSE(std::isnan(reader.value({10.0, 3, 3})));
    EXPECT_EQ(volume.loads[layout.index({1, 0, 0})], 1);
    EXPECT_EQ(volume.loads.size(), 4u); // no brick that was not asked for

    ValueReader truncated =
        volume.reader(*BrickLayout::create(SIZE, {6, 9, 5}, 1, PartialBricks::TRUNCATE));
    EXPECT_FALSE(std::isnan(truncated.value({20.0, 16, 8})));
    EXPECT_TRUE(std::isnan(truncated.value({20.1, 16, 8})));
}

TEST(ValueReader, HolesReachAsFarAsTheirCells)
{
    const BrickLayout layout = *BrickLayout::create(SIZE, {6, 9, 5}, 1);
    for (const double hole : {double(NAN), double(INFINITY)}) {
        Volume volume(SIZE, trilinear);
        volume.at(5, 4, 3) = hole; // in two bricks
        ValueReader reader = volume.reader(layout, ValueReader::LINEAR, -4.0);
        ValueReader unknown = volume.reader(layout);
        for (const glm::dvec3& p :
             {glm::dvec3(4.5, 4, 3), glm::dvec3(5.5, 3.5, 2.5), glm::dvec3(5, 4, 3)}) {
            EXPECT_EQ(reader.value(p), -4.0);
            EXPECT_TRUE(std::isnan(unknown.value(p)));
        }
        EXPECT_NEAR(reader.value({3.9, 4, 3}), trilinear({3.9, 4, 3}), 1e-12);
        EXPECT_NEAR(reader.value({6.1, 4, 3}), trilinear({6.1, 4, 3}), 1e-12);
    }
}

TEST(ValueReader, ReadsEveryTypeAndComponent)
{
    const glm::ivec3 size(4, 3, 5);
    const BrickLayout layout = *BrickLayout::create(size, size);
    for (int type = 0; type <= int(VoxelType::FLOAT64); ++type)
        for (const int components : {1, 4})
            for (int component = 0; component < components; ++component) {
                const VoxelType voxelType = VoxelType(type);
                std::vector<double> values;
                for (std::int64_t i = 0; i < sampleCount(size); ++i)
                    for (int c = 0; c < components; ++c)
                        values.push_back(double(i) + 10.0 * c);
                std::vector<unsigned char> block(values.size() * voxelTypeSize(voxelType));
                convertVoxels(values.data(), VoxelType::FLOAT64, block.data(), voxelType,
                              values.size());
                ValueReader reader(
                    layout,
                    [&](std::int64_t) {
                        return ValueReader::Brick{{block.data(), voxelType, components, size}, {}};
                    },
                    ValueReader::LINEAR, component);
                const glm::dvec3 p(1.25, 0.5, 3.75); // linear in the index of the sample
                EXPECT_EQ(reader.value(p), 1.25 + 4 * 0.5 + 12 * 3.75 + 10.0 * component)
                    << "type " << type << ", component " << component << " of " << components;
            }
}

TEST(ValueReader, ReadsVolumesOfOneLayer)
{
    const glm::ivec3 size(5, 1, 1);
    const BrickLayout layout = *BrickLayout::create(size, {3, 3, 3});
    const std::vector<float> values = {0, 1, 4, 9, 16};
    ValueReader reader(
        layout,
        [&](std::int64_t brick) {
            return ValueReader::Brick{{&values[std::size_t(layout.brick(brick).samples.min.x)],
                                       VoxelType::FLOAT32, 1, layout.brick(brick).samples.size()},
                                      {}};
        },
        ValueReader::LINEAR);
    EXPECT_EQ(reader.value({1.5, 0, 0}), 2.5);
    EXPECT_EQ(reader.value({3.5, 0, 0}), 12.5);
    EXPECT_EQ(reader.value({4.0, 0, 0}), 16.0);
    // A layer is as thick as the distance to a next one would be.
    EXPECT_EQ(reader.value({1.5, 0.4, -0.5}), 2.5);
    EXPECT_TRUE(std::isnan(reader.value({1.5, 0.6, 0})));
    EXPECT_EQ(reader.gradient({2.0, 0, 0}).x, 4.0);
}

TEST(ValueReader, GradientsAreDifferencesAcrossBricks)
{
    const BrickLayout layout = *BrickLayout::create(SIZE, {6, 9, 5}, 1);
    Volume volume(SIZE, trilinear);
    ValueReader reader = volume.reader(layout);
    for (const glm::dvec3& p : positions()) { // to one side at the edges
        const glm::dvec3 gradient = reader.gradient(p), expected = trilinearGradient(p);
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(gradient[axis], expected[axis], 1e-11);
    }
    EXPECT_TRUE(std::isnan(reader.gradient({-1, 0, 0}).x));
    volume.absent = {layout.index({1, 0, 0})};
    ValueReader partly = volume.reader(layout);
    EXPECT_NEAR(partly.gradient({4.5, 3, 3}).x, trilinearGradient({4.5, 3, 3}).x, 1e-11);
}

} // namespace ValueReaderTest
