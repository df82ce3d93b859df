// OpenVDB files, against the grids that were written to them.

#ifdef OSGVOLUMIZER_HAVE_OPENVDB

#include <osgVolumizer/Paging.h>
#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/core/voxels/BrickTree.h>
#include <osgVolumizer/core/voxels/Half.h>
#include <osgVolumizer/io/Placement.h>

#include <support/FolderTest.h>

#include <gtest/gtest.h>

#include <openvdb/openvdb.h>

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

namespace OpenVdbTest {

using namespace osgVolumizer;
using core::Box3i;
using openvdb::Coord;
namespace fs = std::filesystem;

namespace {

class OpenVdb : public support::FolderTest
{
protected:
    void SetUp() override
    {
        openvdb::initialize();
        FolderTest::SetUp();
    }
    void write(const std::string& name, const openvdb::GridPtrVec& grids,
               const std::string& gridName = {}) const
    {
        if (!gridName.empty()) grids.front()->setName(gridName);
        openvdb::io::File(path(name)).write(grids);
    }
    Result<osg::ref_ptr<Voxels>> read(const std::string& name,
                                      const std::string& options = {}) const
    {
        const osg::ref_ptr<osgDB::Options> o = new osgDB::Options(options);
        return readVoxels(path(name), o.get());
    }
    osg::ref_ptr<VoxelSource> open(const std::string& name, const std::string& options = {}) const
    {
        const auto voxels = read(name, options);
        EXPECT_TRUE(voxels.ok()) << voxels.status.text;
        return voxels.ok() ? (*voxels)->getSource() : nullptr;
    }
    template <class T>
    static std::vector<T> samples(const VoxelSource& source, const Box3i& region, int level = 0)
    {
        const glm::ivec3 size = region.size();
        std::vector<T> values(std::size_t(size.x) * size.y * size.z);
        EXPECT_EQ(voxelTypeSize(source.describe().type), sizeof(T));
        const Status status = source.readLevel(level, region, values.data());
        EXPECT_TRUE(status.ok()) << status.text;
        return values;
    }
    template <class T>
    static std::vector<T> all(const VoxelSource& source)
    {
        return samples<T>(source, {glm::ivec3(0), source.describe().size});
    }
    static void expectNear(const glm::dvec3& found, const openvdb::Vec3d& expected)
    {
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(found[axis], expected[axis],
                        1e-9 * std::max(1.0, std::fabs(expected[axis])));
    }
    /// A value that tells voxels apart.
    static float value(const Coord& at)
    {
        return float((3 * at.x() + 7 * at.y() + 31 * at.z()) % 251) + 0.5f;
    }
    /// Voxels from `first` to `last`, all active.
    template <class Grid = openvdb::FloatGrid>
    static typename Grid::Ptr block(const Coord& first, const Coord& last, double scale = 1.0)
    {
        auto grid = Grid::create(typename Grid::ValueType(0));
        auto to = grid->getAccessor();
        for (const Coord& at : openvdb::CoordBBox(first, last))
            to.setValue(at, typename Grid::ValueType(scale * value(at)));
        return grid;
    }
    /// A sphere of radius 6 about (1, 2, 3) of voxels of 0.25: its distance, up to three voxels
    /// from it, or a fog that gets as dense as it can within those.
    static openvdb::FloatGrid::Ptr sphere(openvdb::GridClass kind)
    {
        constexpr float BAND = 0.75f;
        const bool levelSet = kind == openvdb::GRID_LEVEL_SET;
        auto grid = openvdb::FloatGrid::create(levelSet ? BAND : 0.0f);
        grid->setGridClass(kind);
        grid->setTransform(openvdb::math::Transform::createLinearTransform(0.25));
        auto to = grid->getAccessor();
        for (const Coord& at : openvdb::CoordBBox({-24, -20, -16}, {32, 36, 40})) {
            const openvdb::Vec3d p = grid->indexToWorld(at) - openvdb::Vec3d(1, 2, 3);
            const float distance = float(p.length() - 6.0);
            if (levelSet && std::fabs(distance) < BAND)
                to.setValueOn(at, distance);
            else if (levelSet && distance < 0.0f)
                to.setValueOff(at, -BAND);
            else if (!levelSet && distance < 0.0f)
                to.setValueOn(at, std::min(-distance / BAND, 1.0f));
        }
        grid->pruneGrid();
        return grid;
    }
    /// The samples of a region as the tree has them, asked one after another.
    static std::size_t wrongIn(const VoxelSource& source, const openvdb::FloatGrid& grid,
                               const Box3i& region)
    {
        const std::vector<float> found = samples<float>(source, region);
        const Coord first = grid.evalActiveVoxelBoundingBox().min();
        std::size_t i = 0, wrong = 0;
        for (int z = region.min.z; z < region.max.z; ++z)
            for (int y = region.min.y; y < region.max.y; ++y)
                for (int x = region.min.x; x < region.max.x; ++x)
                    wrong += found[i++] != grid.tree().getValue(first + Coord(x, y, z));
        return wrong;
    }
};

// Of the process so far, in MiB.
double peakMemory()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_maxrss) / 1024.0;
}

} // namespace

TEST_F(OpenVdb, LevelSetAndFogOfASphere)
{
    const auto levelSet = sphere(openvdb::GRID_LEVEL_SET), fog = sphere(openvdb::GRID_FOG_VOLUME);
    levelSet->setName("distance");
    fog->setName("density");
    write("sphere.vdb", {levelSet, fog});
    for (const auto& grid : {levelSet, fog}) {
        const auto source = open("sphere.vdb", "dataset=" + grid->getName());
        ASSERT_TRUE(source);
        const VoxelSource::Description d = source->describe();
        EXPECT_EQ(d.type, VoxelType::FLOAT32);
        const auto box = grid->evalActiveVoxelBoundingBox();
        EXPECT_EQ(d.size, glm::ivec3(box.dim().x(), box.dim().y(), box.dim().z()));
        EXPECT_EQ(wrongIn(*source, *grid, {glm::ivec3(0), d.size}), 0u);
        EXPECT_EQ(wrongIn(*source, *grid, {{5, 9, 3}, {22, 30, 41}}), 0u);
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(d.spacing[axis], 0.25, 1e-12);
        expectNear(io::placeOf(d, {0, 0, 0}), grid->indexToWorld(box.min()));
        // The middle of the sphere is where it was made.
        const Coord middle = Coord::round(grid->worldToIndex(openvdb::Vec3d(1, 2, 3))) - box.min();
        expectNear(io::placeOf(d, {middle.x(), middle.y(), middle.z()}), {1, 2, 3});
    }
    // Inside of the band a level set has its background, with the other sign.
    const auto source = open("sphere.vdb", "dataset=distance");
    const glm::ivec3 half = source->describe().size / 2;
    EXPECT_EQ(samples<float>(*source, {half, half + 1})[0], -0.75f);
    const auto range = source->valueRange({glm::ivec3(0), source->describe().size});
    ASSERT_TRUE(range);
    EXPECT_EQ(range->second, 0.75);
    const auto entries = listVolumes(path("sphere.vdb"));
    ASSERT_TRUE(entries.ok()) << entries.status.text;
    ASSERT_EQ(entries->size(), 2u);
    for (const VolumeEntry& entry : *entries) {
        const auto& grid = entry.name == "density" ? fog : levelSet;
        const auto dim = grid->evalActiveVoxelBoundingBox().dim();
        EXPECT_EQ(entry.size, osg::Vec3i(dim.x(), dim.y(), dim.z()));
        const std::string what = entry.name == "density" ? "Fog Volume" : "Level Set";
        EXPECT_EQ(entry.text, what + " of Tree_float_5_4_3, " +
                                  std::to_string(grid->activeVoxelCount()) + " active voxels");
        EXPECT_EQ(entry.chosen, entry.name == "density"); // more voxels than a band
    }
}

TEST_F(OpenVdb, GridsAreChosenByNameAndTwoMayHaveOne)
{
    const auto small = block({0, 0, 0}, {3, 4, 5}), large = block({0, 0, 0}, {7, 7, 7}, 2.0),
               twin = block({0, 0, 0}, {1, 1, 1}, 3.0);
    small->setName("a grid");
    large->setName("twin");
    twin->setName("twin");
    write("many.vdb", {small, large, twin});
    const auto entries = listVolumes(path("many.vdb"));
    ASSERT_TRUE(entries.ok());
    std::vector<std::string> names;
    for (const VolumeEntry& entry : *entries)
        names.push_back(entry.name);
    EXPECT_EQ(names.size(), 3u);
    const auto byName = open("many.vdb", "dataset=\"a grid\""), most = open("many.vdb");
    ASSERT_TRUE(byName && most);
    EXPECT_EQ(byName->describe().size, glm::ivec3(4, 5, 6));
    EXPECT_EQ(most->describe().size, glm::ivec3(8, 8, 8));
    std::vector<float> firsts;
    for (const std::string& name : names)
        if (name != "a grid") firsts.push_back(all<float>(*open("many.vdb", "dataset=" + name))[1]);
    std::sort(firsts.begin(), firsts.end());
    EXPECT_EQ(firsts, (std::vector<float>{7.0f, 10.5f}));
    const auto none = read("many.vdb", "dataset=other");
    EXPECT_EQ(none.status.code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(none.status.text.rfind(path("many.vdb"), 0), 0u) << none.status.text;
    EXPECT_NE(none.status.text.find("\"a grid\""), std::string::npos) << none.status.text;
    EXPECT_EQ(read("many.vdb", "channel=1").status.code, ErrorCode::INDEX_OUT_OF_RANGE);
}

TEST_F(OpenVdb, LiesAsItsTransformSays)
{
    const auto transforms = [] {
        std::vector<openvdb::math::Transform::Ptr> list;
        auto scaled = openvdb::math::Transform::createLinearTransform(0.1);
        scaled->postTranslate({5, -6, 7});
        list.push_back(scaled);
        auto rotated = openvdb::math::Transform::createLinearTransform(0.5);
        rotated->postRotate(0.3, openvdb::math::X_AXIS);
        rotated->postRotate(-1.1, openvdb::math::Z_AXIS);
        rotated->postTranslate({1, 2, 3});
        list.push_back(rotated);
        auto sheared = openvdb::math::Transform::createLinearTransform(
            openvdb::Mat4d(2., 0., 0., 0., 0.5, 1., 0., 0., 0.25, -0.5, 3., 0., 10., 20., 30., 1.));
        list.push_back(sheared);
        list.push_back(openvdb::math::Transform::createLinearTransform(openvdb::Mat4d(
            -1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.))); // left-handed
        return list;
    }();
    for (const auto& transform : transforms) {
        const auto grid = block({-3, 5, 2}, {4, 9, 12});
        grid->setTransform(transform);
        write("placed.vdb", {grid}, "g");
        const auto source = open("placed.vdb");
        ASSERT_TRUE(source);
        for (const Coord& at :
             {Coord(-3, 5, 2), Coord(4, 5, 2), Coord(-3, 9, 2), Coord(-3, 5, 12), Coord(1, 7, 9)}) {
            const Coord v = at - Coord(-3, 5, 2);
            expectNear(io::placeOf(source->describe(), {v.x(), v.y(), v.z()}),
                       transform->indexToWorld(at));
        }
        EXPECT_EQ(wrongIn(*source, *grid, {glm::ivec3(0), source->describe().size}), 0u);
    }
    const auto grid = block({0, 0, 0}, {4, 4, 4});
    grid->setTransform(openvdb::math::Transform::createFrustumTransform(
        openvdb::BBoxd({0, 0, 0}, {4, 4, 4}), 0.5, 10.0));
    write("frustum.vdb", {grid}, "camera");
    const auto frustum = read("frustum.vdb");
    EXPECT_EQ(frustum.status.code, ErrorCode::NOT_SUPPORTED);
    EXPECT_NE(frustum.status.text.find("frustum"), std::string::npos) << frustum.status.text;
}

TEST_F(OpenVdb, NumbersOfEveryType)
{
    const Coord first(-2, 1, 3), last(7, 6, 9);
    const auto size = glm::ivec3(10, 6, 7);
    const auto expected = [&](double scale) {
        std::vector<double> values;
        for (int z = 3; z <= 9; ++z)
            for (int y = 1; y <= 6; ++y)
                for (int x = -2; x <= 7; ++x)
                    values.push_back(scale * value({x, y, z}));
        return values;
    };
    write("double.vdb", {block<openvdb::DoubleGrid>(first, last, 0.1)}, "g");
    write("int.vdb", {block<openvdb::Int32Grid>(first, last, 1000.0)}, "g");
    write("long.vdb", {block<openvdb::Int64Grid>(first, last, 2.0)}, "g");
    write("longer.vdb", {block<openvdb::Int64Grid>(first, last, 1e12)}, "g");
    write("bool.vdb", {block<openvdb::BoolGrid>(first, last)}, "g");
    const auto halves = block(first, last);
    halves->setSaveFloatAsHalf(true);
    write("half.vdb", {halves}, "g");
    const auto d = open("double.vdb"), i = open("int.vdb"), l = open("long.vdb"),
               m = open("longer.vdb"), b = open("bool.vdb"), h = open("half.vdb");
    ASSERT_TRUE(d && i && l && m && b && h);
    for (const auto& source : {d, i, l, m, b, h})
        EXPECT_EQ(source->describe().size, size);
    EXPECT_EQ(d->describe().type, VoxelType::FLOAT64);
    EXPECT_EQ(all<double>(*d), expected(0.1));
    EXPECT_EQ(i->describe().type, VoxelType::INT32);
    EXPECT_EQ(all<std::int32_t>(*i)[1], std::int32_t(1000.0 * value({-1, 1, 3})));
    EXPECT_EQ(l->describe().type, VoxelType::UINT16);
    EXPECT_EQ(all<std::uint16_t>(*l)[1], std::uint16_t(2.0 * value({-1, 1, 3})));
    EXPECT_EQ(m->describe().type, VoxelType::FLOAT64);
    EXPECT_EQ(all<double>(*m), expected(1e12));
    EXPECT_EQ(b->describe().type, VoxelType::UINT8);
    EXPECT_EQ(all<std::uint8_t>(*b), std::vector<std::uint8_t>(420, 1));
    EXPECT_EQ(h->describe().type, VoxelType::HALF);
    const auto bits = all<std::uint16_t>(*h);
    const auto numbers = expected(1.0);
    for (std::size_t k = 0; k < bits.size(); ++k)
        EXPECT_EQ(core::Half::decode(bits[k]), float(numbers[k]));
}

TEST_F(OpenVdb, VectorsAreTheirLengthOrAComponent)
{
    auto grid = openvdb::Vec3SGrid::create(openvdb::Vec3f(0, 0, 0));
    auto to = grid->getAccessor();
    for (const Coord& at : openvdb::CoordBBox({0, 0, 0}, {3, 3, 3}))
        to.setValue(at, {float(at.x()), -2.0f * float(at.y()), 0.5f});
    const auto scalars = block({0, 0, 0}, {1, 1, 1});
    scalars->setName("few");
    grid->setName("velocity");
    write("vectors.vdb", {grid, scalars});
    EXPECT_EQ(open("vectors.vdb")->describe().size, glm::ivec3(2)); // numbers before vectors
    const auto length = open("vectors.vdb", "dataset=velocity");
    ASSERT_TRUE(length);
    const auto lengths = all<float>(*length);
    std::vector<std::vector<float>> components;
    for (const char* channel : {"0", "1", "2"})
        components.push_back(
            all<float>(*open("vectors.vdb", std::string("dataset=velocity channel=") + channel)));
    for (std::size_t i = 0; i < 64; ++i) {
        const double x = double(i % 4), y = -2.0 * double(i / 4 % 4);
        EXPECT_EQ(components[0][i], float(x));
        EXPECT_EQ(components[1][i], float(y));
        EXPECT_EQ(components[2][i], 0.5f);
        EXPECT_FLOAT_EQ(lengths[i], float(std::sqrt(x * x + y * y + 0.25)));
    }
    EXPECT_EQ(read("vectors.vdb", "dataset=velocity channel=3").status.code,
              ErrorCode::INDEX_OUT_OF_RANGE);
    const auto entries = listVolumes(path("vectors.vdb"));
    ASSERT_TRUE(entries.ok()) << entries.status.text;
    ASSERT_EQ(entries->size(), 2u);
    for (const VolumeEntry& entry : *entries)
        EXPECT_EQ(entry.channels, entry.name == "velocity" ? 3 : 1);
}

// Two islands of 20^3, 10000 voxels apart on every axis: 4 TB if it were dense.
TEST_F(OpenVdb, SparseGridsTakeWhatIsThere)
{
    constexpr int EDGE = 10000, ISLAND = 20;
    auto grid = block({0, 0, 0}, {ISLAND - 1, ISLAND - 1, ISLAND - 1});
    auto to = grid->getAccessor();
    for (const Coord& at : openvdb::CoordBBox::createCube(Coord(EDGE - ISLAND), ISLAND))
        to.setValue(at, 1000.0f);
    grid->tree().fill(openvdb::CoordBBox::createCube(Coord(4096), 256), 7.0f); // tiles
    write("sparse.vdb", {grid}, "islands");
    const double before = peakMemory();
    const auto voxels = read("sparse.vdb");
    ASSERT_TRUE(voxels.ok()) << voxels.status.text;
    ASSERT_TRUE((*voxels)->isPaged());
    EXPECT_EQ((*voxels)->getSize(), osg::Vec3i(EDGE, EDGE, EDGE));
    EXPECT_EQ((*voxels)->getRange(), osg::Vec2d(0.0, 1000.0));
    const VoxelSource& source = *(*voxels)->getSource();
    const int levels = source.levelCount();
    EXPECT_EQ(core::BrickTree::levelSize(glm::ivec3(EDGE), levels - 1), glm::ivec3(40));
    using Range = std::pair<double, double>;
    EXPECT_EQ(source.valueRange({glm::ivec3(100), glm::ivec3(4000)}), Range(0.0, 0.0));
    EXPECT_EQ(source.valueRange({glm::ivec3(4100), glm::ivec3(4300)}), Range(7.0, 7.0));
    EXPECT_EQ(source.valueRange({glm::ivec3(EDGE - 3), glm::ivec3(EDGE)}), Range(1000.0, 1000.0));
    // A part of the leaf at the corner, whose first two voxels are 0.5 and 3.5.
    EXPECT_EQ(source.valueRange({{0, 0, 0}, {2, 1, 1}}), Range(0.5, 3.5));
    EXPECT_EQ(wrongIn(source, *grid, {glm::ivec3(0), glm::ivec3(40)}), 0u);
    EXPECT_EQ(wrongIn(source, *grid, {glm::ivec3(4090), glm::ivec3(4110)}), 0u);
    EXPECT_EQ(wrongIn(source, *grid, {glm::ivec3(EDGE - 40), glm::ivec3(EDGE)}), 0u);
    // The sum of all is on every level what it is: islands do not fall between samples.
    double sum = 0.0;
    for (auto v = grid->cbeginValueOn(); v; ++v)
        sum += double(*v) * double(v.getVoxelCount());
    for (int level = levels - 1; level >= levels - 2; --level) {
        const glm::ivec3 size = core::BrickTree::levelSize(glm::ivec3(EDGE), level);
        const auto found = samples<float>(source, {glm::ivec3(0), size}, level);
        double whole = 0.0;
        const auto voxelsOf = [&](int i) {
            return std::min<double>(1 << level, EDGE - (double(i) * (1 << level)));
        };
        for (int z = 0, i = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x)
                    whole +=
                        double(found[std::size_t(i++)]) * voxelsOf(x) * voxelsOf(y) * voxelsOf(z);
        EXPECT_NEAR(whole / sum, 1.0, 1e-5) << level;
        EXPECT_EQ(source.levelRange(level, {glm::ivec3(0), size}), Range(0.0, 1000.0));
    }
    EXPECT_LT(peakMemory() - before, 64.0);
}

TEST_F(OpenVdb, CoarseLevelsAreMeansOfFloatsAndMiddlesOfIntegers)
{
    const auto floats = block({-5, 3, 8}, {94, 80, 70});
    const auto labels = block<openvdb::Int32Grid>({-5, 3, 8}, {94, 80, 70});
    write("floats.vdb", {floats}, "g");
    write("labels.vdb", {labels}, "g");
    const PagingBudget before = getPagingBudget();
    PagingBudget small = before;
    small.memoryBytes = 1 << 20;
    EXPECT_FALSE((*read("floats.vdb"))->isPaged());
    ASSERT_TRUE(setPagingBudget(small));
    const auto a = open("floats.vdb"), b = open("labels.vdb");
    ASSERT_TRUE(setPagingBudget(before));
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->levelCount(), 2);
    const glm::ivec3 size = core::BrickTree::levelSize({100, 78, 63}, 1);
    const auto means = samples<float>(*a, {glm::ivec3(0), size}, 1);
    for (int z = 0, i = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x, ++i) {
                double sum = 0.0, count = 0.0;
                for (int k = 2 * z; k < std::min(2 * z + 2, 63); ++k)
                    for (int j = 2 * y; j < std::min(2 * y + 2, 78); ++j)
                        for (int h = 2 * x; h < std::min(2 * x + 2, 100); ++h, ++count)
                            sum += value({h - 5, j + 3, k + 8});
                ASSERT_NEAR(means[std::size_t(i)], sum / count, 1e-4) << x << "," << y << "," << z;
            }
    const auto part = samples<float>(*a, {{3, 5, 7}, {9, 6, 8}}, 1);
    for (std::size_t i = 0; i < part.size(); ++i)
        EXPECT_EQ(part[i], means[(std::size_t(7) * size.y + 5) * size.x + 3 + i]);
    std::vector<std::int32_t> thinned(std::size_t(size.x) * size.y * size.z);
    ASSERT_TRUE(b->readThinned(1, {glm::ivec3(0), size}, thinned.data()).ok());
    EXPECT_EQ(samples<std::int32_t>(*b, {glm::ivec3(0), size}, 1), thinned);
    char byte = 0;
    EXPECT_EQ(a->readLevel(2, {glm::ivec3(0), glm::ivec3(1)}, &byte).code,
              ErrorCode::INDEX_OUT_OF_RANGE);
    EXPECT_EQ(a->read({glm::ivec3(0), glm::ivec3(101, 1, 1)}, &byte).code,
              ErrorCode::INDEX_OUT_OF_RANGE);
}

// Beside a background that is large, or no number, and with voxels that are none.
TEST_F(OpenVdb, CoarseLevelsAreMeansOfWhatIsFinite)
{
    const float backgrounds[] = {std::numeric_limits<float>::max(), std::nanf(""), 1e30f, INFINITY};
    for (const float background : backgrounds) {
        auto grid = openvdb::FloatGrid::create(background);
        auto to = grid->getAccessor();
        for (const Coord& at : openvdb::CoordBBox({0, 0, 0}, {76, 63, 63}))
            to.setValue(at, value(at));
        for (const Coord& at : openvdb::CoordBBox({10, 10, 10}, {12, 11, 11}))
            to.setValue(at, std::nanf(""));
        to.setValue({99, 63, 63}, 7.0f);
        write("means.vdb", {grid}, "g");
        const PagingBudget before = getPagingBudget();
        PagingBudget small = before;
        small.memoryBytes = 1 << 20;
        ASSERT_TRUE(setPagingBudget(small));
        const auto source = open("means.vdb");
        ASSERT_TRUE(setPagingBudget(before));
        ASSERT_TRUE(source);
        ASSERT_EQ(source->levelCount(), 2);
        const auto found = samples<float>(*source, {glm::ivec3(0), {50, 32, 32}}, 1);
        const auto tree = grid->getConstAccessor();
        int wrong = 0;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const Coord first(2 * int(i % 50), 2 * int(i / 50 % 32), 2 * int(i / 1600));
            double sum = 0.0, count = 0.0;
            for (const Coord& at : openvdb::CoordBBox(first, first.offsetBy(1)))
                if (const double v = tree.getValue(at); std::isfinite(v)) {
                    sum += v;
                    count += 1.0;
                }
            wrong += count == 0.0 ? !std::isnan(found[i])
                                  : !(std::fabs(found[i] - sum / count) <= 1e-6 * sum / count);
        }
        EXPECT_EQ(wrong, 0) << background;
        EXPECT_EQ(std::isnan(found[(5 * 32 + 5) * 50 + 5]), true); // all eight
        EXPECT_EQ(std::isnan(found[(5 * 32 + 5) * 50 + 6]), false);
        EXPECT_EQ(std::isfinite(found[45]), std::isfinite(background));
    }
}

TEST_F(OpenVdb, WhatIsNoVolumeSaysSo)
{
    const auto points = openvdb::GridBase::createGrid("Tree_ptdataidx32_5_4_3");
    write("points.vdb", {points}, "particles");
    const auto refused = read("points.vdb");
    EXPECT_EQ(refused.status.code, ErrorCode::NOT_SUPPORTED) << refused.status.text;
    EXPECT_EQ(read("points.vdb", "dataset=particles").status.code, ErrorCode::NOT_SUPPORTED);
    write("empty.vdb", {openvdb::FloatGrid::create(0.0f)}, "nothing");
    const auto empty = read("empty.vdb");
    EXPECT_EQ(empty.status.code, ErrorCode::FILE_UNREADABLE);
    EXPECT_NE(empty.status.text.find("no active voxels"), std::string::npos) << empty.status.text;
    auto far = openvdb::FloatGrid::create(0.0f);
    far->tree().setValue({-2000000000, 0, 0}, 1.0f);
    far->tree().setValue({2000000000, 0, 0}, 1.0f);
    write("far.vdb", {far}, "far");
    EXPECT_EQ(read("far.vdb").status.code, ErrorCode::TOO_LARGE);
    openvdb::io::File(path("none.vdb")).write(openvdb::GridPtrVec());
    EXPECT_EQ(read("none.vdb").status.code, ErrorCode::FILE_UNREADABLE);
}

TEST_F(OpenVdb, DamagedFilesAreRefused)
{
    write("whole.vdb", {block({0, 0, 0}, {20, 20, 20})}, "density");
    const auto bytes = fs::file_size(path("whole.vdb"));
    for (int i = 0; i <= 40; ++i) {
        const auto length = i < 40 ? bytes * std::uintmax_t(i) / 40 : bytes - 1;
        fs::copy_file(path("whole.vdb"), path("cut.vdb"), fs::copy_options::overwrite_existing);
        fs::resize_file(path("cut.vdb"), length);
        for (const Status& status : {read("cut.vdb").status, listVolumes(path("cut.vdb")).status}) {
            EXPECT_EQ(status.code, ErrorCode::FILE_UNREADABLE) << length << ": " << status.text;
            EXPECT_EQ(status.text.rfind(path("cut.vdb"), 0), 0u) << status.text;
            EXPECT_EQ(status.text.find('\n'), std::string::npos) << status.text;
        }
    }
    unsigned state = 1;
    for (int i = 0; i < 60; ++i) {
        std::string noise(" BDV\0\0\0\0", 8);
        const std::uint32_t version = 218 + std::uint32_t(i % 7);
        if (i % 3) noise.append(reinterpret_cast<const char*>(&version), 4);
        for (int k = 0; k < 400; ++k) {
            state = state * 1664525u + 1013904223u;
            const unsigned byte = state >> 24;
            // Small numbers get further than large ones.
            noise += i % 2 ? char(byte) : char(k % 4 ? 0 : byte % 5);
        }
        writeBytes("noise.vdb", noise);
        const auto refused = read("noise.vdb");
        ASSERT_FALSE(refused.ok());
        EXPECT_EQ(refused.status.text.rfind(path("noise.vdb"), 0), 0u) << refused.status.text;
    }
}

TEST_F(OpenVdb, ThreadsReadSideBySide)
{
    const auto grid = block({0, 0, 0}, {59, 59, 59});
    write("threads.vdb", {grid}, "g");
    const auto source = open("threads.vdb");
    ASSERT_TRUE(source);
    std::vector<std::size_t> wrong(4);
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < wrong.size(); ++t)
        threads.emplace_back([&, t] {
            for (int i = 0; i < 40; ++i) {
                const int first = (i * 7 + int(t)) % 44;
                wrong[t] += wrongIn(*source, *grid, {glm::ivec3(first), glm::ivec3(first + 16)});
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, std::vector<std::size_t>(4));
}

} // namespace OpenVdbTest

#endif
