// Picks of other ray functions, other regions, and deformed volumes.
#include "PickOracle.h"

#include <osgVolumizer/core/geometry/Solids.h>

#include <array>

namespace RayFunctionPickTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using A = VolumeAppearance;

namespace {

constexpr int SIZE = 32;

osg::ref_ptr<VolumeAppearance> volumeOf(Voxels* voxels, A::RayFunction function)
{
    osg::ref_ptr<VolumeAppearance> appearance = makeVolume(voxels);
    appearance->setRayFunction(function);
    return appearance;
}

// Values at equal distances on the part of a line in the box of voxels.
struct Dense
{
    std::vector<double> ratios, values;
    Dense(const oracle::Grid& grid, const Line& line, double step = 1.0 / 64.0)
    {
        const int count = static_cast<int>(line.length() / step);
        for (int i = 0; i <= count; ++i) {
            const double ratio = double(i) / count;
            if (!inside(line.at(ratio), glm::dvec3(0.0), glm::dvec3(grid.size() - 1))) continue;
            ratios.push_back(ratio);
            values.push_back(grid.value(line.at(ratio)));
        }
    }
};

TEST(RayFunctionPick, FindsTheFirstCrossingOfAnIsoValue)
{
    const auto voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    const auto grid = gridOf(*voxels);
    const auto appearance = volumeOf(voxels, A::ISOSURFACE);
    appearance->setIsoValue(0.62);
    RandomLines lines(glm::dvec3(0.0), glm::dvec3(SIZE - 1));
    int hits = 0;
    for (int i = 0; i < 1000; ++i) {
        const Line line = lines.next();
        const Dense dense(*grid, line);
        const auto found = pickLine(*appearance, line);
        std::optional<double> first;
        for (std::size_t k = 1; k < dense.values.size() && !first; ++k)
            if ((dense.values[k] < 0.62) != (dense.values[k - 1] < 0.62)) first = dense.ratios[k];
        const auto near = [&](double v) { return std::fabs(v - 0.62) < 2e-3; };
        // One that only touches is found by neither surely.
        if (first.has_value() != found.has_value() ||
            (found && std::fabs(*first - found->ratio) * line.length() > 0.05)) {
            EXPECT_TRUE(std::any_of(dense.values.begin(), dense.values.end(), near)) << i;
            continue;
        }
        if (!found) continue;
        ++hits;
        EXPECT_NEAR(found->value, 0.62, 1e-6);
    }
    EXPECT_GT(hits, 300);
}

TEST(RayFunctionPick, FindsTheExtremeValue)
{
    const auto voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    const auto grid = gridOf(*voxels);
    for (const double sign : {1.0, -1.0}) {
        const auto appearance = volumeOf(voxels, sign > 0.0 ? A::MAXIMUM : A::MINIMUM);
        appearance->setLookupTable(makeTable(constantPoints({1, 1, 1, 0.8})));
        RandomLines lines(glm::dvec3(0.0), glm::dvec3(SIZE - 1));
        for (int i = 0; i < 300; ++i) {
            const Line line = lines.next();
            const Dense dense(*grid, line);
            const auto found = pickLine(*appearance, line);
            if (dense.values.size() < 2) continue;
            std::size_t best = 0;
            for (std::size_t k = 1; k < dense.values.size(); ++k)
                if (sign * dense.values[k] > sign * dense.values[best]) best = k;
            ASSERT_TRUE(found.has_value());
            EXPECT_GT(sign * found->value, sign * dense.values[best] - 1e-5) << i;
            // Another place is as good only where the value is the same.
            const double off = std::fabs(found->ratio - dense.ratios[best]) * line.length();
            EXPECT_TRUE(off <= 0.1 || std::fabs(found->value - dense.values[best]) < 1e-4) << i;
        }
    }
}

TEST(RayFunctionPick, WantsTheExtremeToBeOpaque)
{
    const auto appearance = volumeOf(makeBlob(glm::ivec3(SIZE), 6.0), A::MAXIMUM);
    appearance->getLookupTable()->setRamp(0.5, 1.0); // opacity is the value
    const Line through{{15.5, 15.5, -10}, {15.5, 15.5, 50}}, beside{{1, 1, -10}, {1, 1, 50}};
    const auto found = pickLine(*appearance, through);
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->point.z(), 15.5, 0.6);
    EXPECT_FALSE(pickLine(*appearance, beside).has_value());
}

TEST(RayFunctionPick, FindsTheMiddleOfWhatIsSummed)
{
    const auto voxels = makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3&) { return 0.75; });
    for (const A::RayFunction function : {A::AVERAGE, A::SUM}) {
        const auto appearance = volumeOf(voxels, function);
        appearance->getLookupTable()->setRamp(0.5, 1.0);
        appearance->setOpacityUnit(31.0);
        const Line all{{3, 4, -10}, {3, 4, 50}}, part{{3, 4, 21}, {3, 4, 50}};
        const auto found = pickLine(*appearance, all);
        ASSERT_TRUE(found.has_value());
        EXPECT_NEAR(found->point.z(), 15.5, 1e-6);
        const auto inPart = pickLine(*appearance, part); // 10 of 31 units: a third of the sum
        EXPECT_EQ(inPart.has_value(), function == A::AVERAGE);
        if (!inPart) continue;
        EXPECT_NEAR(inPart->point.z(), 26.0, 1e-6);
    }
}

TEST(RayFunctionPick, DoesNotFindPaint)
{
    const auto appearance = volumeOf(makeBlob(glm::ivec3(SIZE), 6.0), A::COMPOSITE);
    const Line line{{15.5, 15.5, -10}, {15.5, 15.5, 50}};
    EXPECT_TRUE(pickLine(*appearance, line).has_value());
    appearance->setCombineRule(A::PAINT);
    EXPECT_FALSE(pickLine(*appearance, line).has_value());
}

TEST(RayFunctionPick, StaysWithinARegion)
{
    const auto voxels = makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3&) { return 1.0; });
    const auto appearance = volumeOf(voxels, A::COMPOSITE);
    appearance->setLookupTable(makeTable(constantPoints({1, 1, 1, 0.9999})));
    ASSERT_TRUE(geometryBelow(*appearance).setBox(osg::BoundingBoxd(4, 5, 6, 20, 20, 20)).ok());
    const auto found = pickLine(*appearance, {{10, 10, -10}, {10, 10, 50}});
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->point.z(), 6.075, 0.01); // ln 2 / -ln(1 - 0.9999) behind the face
    EXPECT_FALSE(pickLine(*appearance, {{2, 2, -10}, {2, 2, 50}}).has_value());
    // Larger than the voxels: they end.
    ASSERT_TRUE(
        geometryBelow(*appearance).setBox(osg::BoundingBoxd(-50, -50, -50, 50, 50, 50)).ok());
    EXPECT_NEAR(pickLine(*appearance, {{10, 10, -10}, {10, 10, 50}})->point.z(), 0.075, 0.01);
}

// Not convex: two boxes with a gap, the first of which shows too little.
TEST(RayFunctionPick, GoesOnBehindAGap)
{
    const auto voxels = makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3&) { return 1.0; });
    const auto appearance = volumeOf(voxels, A::COMPOSITE);
    appearance->setLookupTable(makeTable(constantPoints({1, 1, 1, 0.1})));
    const auto low = VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, 31, 31, 4));
    const auto high = VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 10, 31, 31, 31));
    core::TetraSet set = *low->getTetraSet();
    const core::TetraSet other = *high->getTetraSet();
    const std::size_t first = set.vertices.size();
    set.vertices.resize(first + other.vertices.size());
    for (std::size_t i = 0; i < other.vertices.size(); ++i)
        set.vertices.setPosition(first + i, other.vertices.position(i));
    for (const auto i : other.indices)
        set.indices.push_back(i + core::TetraSet::Index(first));
    ASSERT_TRUE(geometryBelow(*appearance).setTetraSet(set).ok());
    const auto found = pickLine(*appearance, {{10, 11, -10}, {10, 11, 50}});
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->point.z(), 10.0 + std::log(0.5) / std::log(0.9) - 4.0, 1e-6);
    EXPECT_GE(found->tetrahedron, 5u); // of the second box
}

// A box of five tetrahedra, of which each vertex shows another place than where it is.
struct Deformed
{
    core::TetraSet set;

    Deformed()
    {
        const auto box = VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, 31, 31, 31));
        const auto plain = box->getTetraSet();
        set.vertices = core::VertexArray(core::VertexFormat::user(3, 0, 0));
        set.vertices.resize(plain->vertices.size());
        set.indices = plain->indices;
        for (std::size_t i = 0; i < plain->vertices.size(); ++i) {
            const glm::dvec3 p = plain->vertices.position(i);
            set.vertices.setVoxelCoordinate(i, p);
            set.vertices.setPosition(
                i, p + glm::dvec3(0.2 * p.y, 3.0 * std::sin(double(i)), 0.004 * p.x * p.y));
        }
    }
    // The voxel coordinate at a place, by solving for it in each tetrahedron; false outside.
    bool voxelAt(const glm::dvec3& p, glm::dvec3& voxel) const
    {
        for (std::size_t t = 0; t < set.tetraCount(); ++t) {
            std::array<glm::dvec3, 4> from, to;
            for (std::size_t i = 0; i < 4; ++i) {
                from[i] = set.vertices.position(set.indices[4 * t + i]);
                to[i] = set.vertices.voxelCoordinate(set.indices[4 * t + i]);
            }
            bool in = true;
            for (const core::Plane& plane : oracle::tetraRegion(from))
                in = in && plane.distance(p) >= 0.0;
            if (!in) continue;
            voxel = glm::dvec3(oracle::tetraMap(from, to) * glm::dvec4(p, 1.0));
            return true;
        }
        return false;
    }
};

TEST(RayFunctionPick, FollowsADeformation)
{
    const auto voxels = makeVoxels(glm::ivec3(SIZE), bumps);
    const auto appearance = volumeOf(voxels, A::COMPOSITE);
    const Points points = {{0.55, {1, 1, 1, 0.0}}, {0.9, {1, 1, 1, 0.7}}};
    appearance->setLookupTable(makeTable(points));
    const Deformed deformed;
    ASSERT_TRUE(geometryBelow(*appearance).setTetraSet(deformed.set).ok());
    const auto grid = gridOf(*voxels);
    const oracle::Table table(points);
    const auto extinction = [&](const glm::dvec3& p) {
        glm::dvec3 voxel;
        if (!deformed.voxelAt(p, voxel)) return 0.0;
        return oracle::Table::extinction(table.color(grid->value(voxel)).a);
    };
    EXPECT_GT(comparePicks(*appearance, extinction, glm::dvec3(2.0), glm::dvec3(29.0), 100, 0.1,
                           1.0 / 32.0),
              40);
}

TEST(RayFunctionPick, ShowsColoursOfVerticesWithoutVoxels)
{
    osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    osg::ref_ptr<VolumeGeometry> geometry =
        VolumeGeometry::createBox(osg::BoundingBoxd(0, 0, 0, 8, 8, 8));
    appearance->addChild(geometry);
    const Line line{{3, 4, -2}, {3, 4, 18}};
    // Without colours a unit lets half of the light through.
    ASSERT_TRUE(pickLine(*appearance, line).has_value());
    EXPECT_NEAR(pickLine(*appearance, line)->point.z(), 1.0, 1e-6);
    core::TetraSet set;
    const auto plain = geometry->getTetraSet();
    set.vertices = core::VertexArray(core::VertexFormat::user(0, 4, 0));
    set.vertices.resize(plain->vertices.size());
    set.indices = plain->indices;
    for (std::size_t i = 0; i < plain->vertices.size(); ++i) {
        set.vertices.setPosition(i, plain->vertices.position(i));
        double* color = set.vertices.record(i) + set.vertices.format().colorOffset();
        color[3] = 0.1;
    }
    ASSERT_TRUE(geometry->setTetraSet(set).ok());
    EXPECT_NEAR(pickLine(*appearance, line)->point.z(), std::log(0.5) / std::log(0.9), 1e-5);
}

TEST(RayFunctionPick, ShowsNothingOfHoles)
{
    const auto voxels = makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3& p) {
        return p.z < 16.0 ? std::nan("") : p.z < 20.0 ? 0.9 : 0.2;
    });
    const auto appearance = volumeOf(voxels, A::COMPOSITE);
    appearance->setLookupTable(makeTable({{0.5, {1, 1, 1, 0.0}}, {0.5, {1, 1, 1, 0.9999}}}));
    const auto found = pickLine(*appearance, {{10, 11, -10}, {10, 11, 50}});
    ASSERT_TRUE(found.has_value());
    EXPECT_NEAR(found->point.z(), 15.63, 0.1); // where the fill of the hole gives way
    // Nothing but holes.
    const auto none = makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3&) { return std::nan(""); });
    EXPECT_FALSE(
        pickLine(*volumeOf(none, A::COMPOSITE), {{10, 11, -10}, {10, 11, 50}}).has_value());
}

TEST(RayFunctionPick, SeesChangesOfVoxels)
{
    const auto voxels = makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3&) { return 0.0; });
    const auto appearance = volumeOf(voxels, A::COMPOSITE);
    const Line line{{10, 11, -10}, {10, 11, 50}};
    EXPECT_FALSE(pickLine(*appearance, line).has_value());
    auto* source = dynamic_cast<MemoryVoxelSource*>(voxels->getSource());
    auto* data = static_cast<float*>(source->data());
    std::fill(data, data + SIZE * SIZE * SIZE, 1.0f);
    voxels->dirty();
    EXPECT_TRUE(pickLine(*appearance, line).has_value());
    ASSERT_TRUE(voxels->setRange({0.0, 1e6}).ok());
    EXPECT_FALSE(pickLine(*appearance, line).has_value());
}

TEST(RayFunctionPick, RefusesWhatIsNoSegment)
{
    const auto appearance = volumeOf(makeBlob(glm::ivec3(SIZE), 6.0), A::COMPOSITE);
    const VolumeGeometry& geometry = geometryBelow(*appearance);
    const osg::Vec3d p(1, 2, 3), nan(std::nan(""), 0, 0), far(1e308, 1e308, 1e308);
    EXPECT_EQ(pickVolume(geometry, *appearance, p, p).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(pickVolume(geometry, *appearance, p, nan).status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(pickVolume(geometry, *appearance, -far, far).status.code, ErrorCode::VALUE_INVALID);
    PickOptions options;
    options.opacity = 1.0;
    EXPECT_FALSE(pickVolume(geometry, *appearance, p, -p, options).ok());
    options.opacity = std::nan("");
    EXPECT_FALSE(pickVolume(geometry, *appearance, p, -p, options).ok());
    const osg::ref_ptr<VolumeGeometry> empty = new VolumeGeometry;
    EXPECT_FALSE(pickVolume(*empty, *appearance, p, -p)->has_value());
    const osg::ref_ptr<VolumeAppearance> without = new VolumeAppearance;
    without->setVoxels(new Voxels);
    EXPECT_FALSE(pickVolume(geometry, *without, p, -p)->has_value());
    EXPECT_FALSE(appearance->setPickOpacity(0.0).ok());
    EXPECT_FALSE(appearance->setPickOpacity(1.0).ok());
    EXPECT_FALSE(appearance->setPickOpacity(std::nan("")).ok());
    EXPECT_EQ(appearance->getPickOpacity(), 0.5);
}

} // namespace

} // namespace RayFunctionPickTest
