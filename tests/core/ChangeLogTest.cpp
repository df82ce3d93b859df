#include <osgVolumizer/core/voxels/ChangeLog.h>
#include <osgVolumizer/core/voxels/VoxelData.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace ChangeLogTest {

using namespace osgVolumizer;
using namespace osgVolumizer::core;

namespace {

// How often each sample of a cube is in a box.
class Counts
{
public:
    explicit Counts(int size) : _size(size), _counts(std::size_t(size) * size * size) {}
    void add(const std::vector<Box3i>& boxes)
    {
        for (const Box3i& box : boxes)
            for (int z = box.min.z; z < box.max.z; ++z)
                for (int y = box.min.y; y < box.max.y; ++y)
                    for (int x = box.min.x; x < box.max.x; ++x)
                        ++_counts[std::size_t(x + _size * (y + _size * z))];
    }
    double covered() const
    {
        double sum = 0.0;
        for (const int count : _counts)
            sum += count > 0;
        return sum;
    }
    bool covers(const Counts& o) const
    {
        for (std::size_t i = 0; i < _counts.size(); ++i)
            if (o._counts[i] > 0 && _counts[i] == 0) return false;
        return true;
    }

private:
    int _size;
    std::vector<int> _counts;
};

double samplesOf(const std::vector<Box3i>& boxes)
{
    double sum = 0.0;
    for (const Box3i& box : boxes)
        sum += double(sampleCount(box.size()));
    return sum;
}

// The rows of a ball.
void addBall(const glm::dvec3& middle, double radius, std::vector<Box3i>& rows)
{
    for (int z = 0; z < 64; ++z)
        for (int y = 0; y < 64; ++y) {
            const double d2 =
                radius * radius - (y - middle.y) * (y - middle.y) - (z - middle.z) * (z - middle.z);
            if (d2 <= 0.0) continue;
            const int first = static_cast<int>(std::ceil(middle.x - std::sqrt(d2)));
            const int last = static_cast<int>(std::floor(middle.x + std::sqrt(d2)));
            if (first <= last) rows.push_back({{first, y, z}, {last + 1, y + 1, z + 1}});
        }
}

} // namespace

TEST(ChangeLog, CoversRowsOfBallsWithFewBoxes)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(14.0, 50.0);
    for (const double radius : {6.0, 10.0, 13.0})
        for (int count : {1, 2, 12}) {
            std::vector<Box3i> rows;
            for (int i = 0; i < count; ++i)
                addBall({place(random), place(random), place(random)}, radius, rows);
            const std::vector<Box3i> boxes = coveringBoxes(rows);
            Counts wanted(64), found(64);
            wanted.add(rows);
            found.add(boxes);
            EXPECT_TRUE(found.covers(wanted));
            EXPECT_LE(samplesOf(boxes), 1.35 * wanted.covered()) << radius << ", " << count;
            EXPECT_LT(boxes.size(), rows.size());
        }
}

TEST(ChangeLog, CoversSolidBoxesExactly)
{
    const std::vector<Box3i> halves = {{{3, 5, 7}, {20, 31, 40}}, {{20, 5, 7}, {41, 31, 40}}};
    const std::vector<Box3i> boxes = coveringBoxes(halves);
    EXPECT_EQ(samplesOf(boxes), 38.0 * 26.0 * 33.0);
    EXPECT_EQ(boxes.size(), 1u);
    EXPECT_TRUE(coveringBoxes({}).empty());
    EXPECT_TRUE(coveringBoxes({Box3i{{4, 4, 4}, {4, 9, 9}}}).empty());
    // Too many samples to be exact about.
    const std::vector<Box3i> far =
        coveringBoxes({{{0, 0, 0}, {300, 300, 300}}, {{400, 0, 0}, {401, 1, 1}}});
    ASSERT_EQ(far.size(), 1u);
    EXPECT_EQ(far[0], (Box3i{{0, 0, 0}, {401, 300, 300}}));
}

TEST(ChangeLog, KnowsWhatChangedSinceWhen)
{
    const Box3i all{glm::ivec3(0), glm::ivec3(64)};
    const Box3i a{{1, 2, 3}, {4, 5, 6}}, b{{40, 2, 3}, {44, 5, 6}};
    ChangeLog log;
    ASSERT_TRUE(log.since(0, all));
    EXPECT_TRUE(log.since(0, all)->empty());
    log.add({a}, 5);
    log.add({b}, 7);
    EXPECT_EQ(samplesOf(*log.since(0, all)), 27.0 + 36.0);
    EXPECT_EQ(samplesOf(*log.since(4, all)), 27.0 + 36.0);
    EXPECT_EQ(samplesOf(*log.since(5, all)), 36.0);
    EXPECT_TRUE(log.since(7, all)->empty());
    EXPECT_EQ(samplesOf(*log.since(0, {{0, 0, 0}, {42, 4, 64}})), 18.0 + 12.0);
    log.forget(8);
    EXPECT_FALSE(log.since(7, all));
    EXPECT_TRUE(log.since(8, all)->empty());
}

TEST(ChangeLog, ForgetsTheOldestOfTooMany)
{
    const Box3i all{glm::ivec3(0), glm::ivec3(64)};
    ChangeLog log;
    const std::vector<Box3i> many(ChangeLog::MAXIMUM_BOXES / 2, Box3i{{1, 1, 1}, {2, 2, 2}});
    log.add(many, 1);
    log.add(many, 2);
    EXPECT_EQ(samplesOf(*log.since(0, all)), 1.0);
    log.add({{{5, 5, 5}, {6, 6, 6}}}, 3);
    EXPECT_FALSE(log.since(0, all));
    EXPECT_EQ(samplesOf(*log.since(1, all)), 2.0);
    EXPECT_EQ(samplesOf(*log.since(2, all)), 1.0);
}

} // namespace ChangeLogTest
