// Rectilinear grids of VTK: as they are where they are even, else resampled.

#ifdef OSGVOLUMIZER_HAVE_VTK_IMAGES

#include "VtkFiles.h"

#include <osgVolumizer/Paging.h>
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/io/Placement.h>

#include <osgDB/ReadFile>

#include <vtkUnsignedCharArray.h>

#include <cmath>
#include <functional>

namespace VtkRectilinearTest {

using namespace osgVolumizer;

namespace {

using Axis = std::vector<double>;

class VtkRectilinear : public VtkFolderTest
{
protected:
    static vtkSmartPointer<vtkRectilinearGrid> grid(const Axis (&axes)[3])
    {
        const auto set = vtkSmartPointer<vtkRectilinearGrid>::New();
        set->SetDimensions(int(axes[0].size()), int(axes[1].size()), int(axes[2].size()));
        vtkSmartPointer<vtkDoubleArray> coordinates[3];
        for (int i = 0; i < 3; ++i) {
            coordinates[i] = vtkSmartPointer<vtkDoubleArray>::New();
            for (const double x : axes[i])
                coordinates[i]->InsertNextValue(x);
        }
        set->SetXCoordinates(coordinates[0]);
        set->SetYCoordinates(coordinates[1]);
        set->SetZCoordinates(coordinates[2]);
        return set;
    }
    static Axis sampled(const Axis (&axes)[3],
                        const std::function<double(double, double, double)>& f)
    {
        Axis values;
        for (const double z : axes[2])
            for (const double y : axes[1])
                for (const double x : axes[0])
                    values.push_back(f(x, y, z));
        return values;
    }
    /// Trilinear, at a place in the frame of the file; the axes are not turned.
    static double at(const VoxelSource::Description& d, const Axis& values, const glm::dvec3& place)
    {
        const glm::dvec3 v = (glm::inverse(d.axes) * place - d.origin) / d.spacing;
        double sum = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            double weight = 1.0;
            std::int64_t index = 0;
            for (int axis = 2; axis >= 0; --axis) {
                const double p = std::min(std::max(v[axis], 0.0), d.size[axis] - 1.0);
                const double below = std::min(std::floor(p), std::max(d.size[axis] - 2.0, 0.0));
                const bool after = (corner >> axis & 1) != 0;
                weight *= after ? p - below : 1.0 - (p - below);
                index = index * d.size[axis] +
                        std::min(std::int64_t(below) + after, std::int64_t(d.size[axis]) - 1);
            }
            if (weight > 0.0) sum += weight * values[std::size_t(index)];
        }
        return sum;
    }
    /// The error that was told, as a fraction.
    double toldError() const
    {
        const std::string words = "wrong by at most ";
        const std::size_t start = told().find(words);
        EXPECT_NE(start, std::string::npos) << told();
        if (start == std::string::npos) return -1.0;
        const std::string number = told().substr(start + words.size());
        EXPECT_NE(number.find("% of the range"), std::string::npos) << number;
        return std::stod(number) / 100.0;
    }
};

double ball(double x, double y, double z)
{
    return std::exp(-(x * x + y * y + z * z) / 18.0);
}

} // namespace

TEST_F(VtkRectilinear, EvenOnesAreImages)
{
    const Axis axes[3] = {{1, 3, 5, 7}, {4, 3, 2}, {0, 0.1f, 0.2f, 0.3f}};
    const auto set = grid(axes);
    const Axis values = sampled(axes, [](double x, double y, double z) { return x + 10 * y + z; });
    addArray<vtkFloatArray>(set->GetPointData(), "a", 1, values);
    addArray<vtkFloatArray>(set->GetCellData(), "c", 1, Axis(18, 2.0));
    const std::string file = writeGrid("a.vtr", set);
    const Source source = open(file), cells = open(file, "dataset=c");
    ASSERT_TRUE(source && cells);
    EXPECT_EQ(told(), "");
    const VoxelSource::Description d = source->describe(), c = cells->describe();
    EXPECT_EQ(d.size, glm::ivec3(4, 3, 4));
    EXPECT_EQ(c.size, glm::ivec3(3, 2, 3));
    const Axis found = valuesOf(source);
    for (std::size_t i = 0; i < values.size(); ++i)
        EXPECT_EQ(found[i], double(float(values[i])));
    const glm::dvec3 last = io::placeOf(d, {3, 2, 3}), middle = io::placeOf(c, {0, 0, 0});
    EXPECT_NEAR(last.x, 7.0, 1e-12);
    EXPECT_NEAR(last.y, 2.0, 1e-12); // y falls
    EXPECT_NEAR(last.z, double(0.3f), 1e-7);
    EXPECT_NEAR(middle.x, 2.0, 1e-12);
    EXPECT_NEAR(middle.y, 3.5, 1e-12);
    EXPECT_NEAR(middle.z, 0.05, 1e-7);
}

TEST_F(VtkRectilinear, PiecesOfAParallelFile)
{
    const Axis axes[3] = {{0, 1, 2}, {0, 1}, {0, 2}};
    const auto set = grid(axes);
    addArray<vtkFloatArray>(set->GetPointData(), "a", 1,
                            Axis{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
    writeGrid("piece.vtr", set);
    const std::string file = writeBytes(
        "all.pvtr",
        "<?xml version=\"1.0\"?><VTKFile type=\"PRectilinearGrid\" version=\"0.1\">"
        "<PRectilinearGrid WholeExtent=\"0 2 0 1 0 1\" GhostLevel=\"0\"><PPointData><PDataArray "
        "type=\"Float32\" Name=\"a\"/></PPointData><PCoordinates><PDataArray type=\"Float64\"/>"
        "<PDataArray type=\"Float64\"/><PDataArray type=\"Float64\"/></PCoordinates>"
        "<Piece Extent=\"0 2 0 1 0 1\" Source=\"piece.vtr\"/></PRectilinearGrid></VTKFile>");
    const Source source = open(file);
    ASSERT_TRUE(source);
    EXPECT_EQ(valuesOf(source), (Axis{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11}));
    EXPECT_EQ(io::placeOf(source->describe(), {2, 1, 1}), glm::dvec3(2, 1, 2));
    for (const char* name : {"all.pvtr", "piece.vtr"}) {
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(path(name));
        const auto* appearance = dynamic_cast<VolumeAppearance*>(node.get());
        ASSERT_TRUE(appearance) << name;
        EXPECT_EQ(appearance->getVoxels()->getSize(), osg::Vec3i(3, 2, 2));
    }
}

TEST_F(VtkRectilinear, LegacyOnes)
{
    const std::string file = writeBytes(
        "a.vtk",
        "# vtk DataFile Version 3.0\na\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 3 2 1\n"
        "X_COORDINATES 3 float\n0 1 3\nY_COORDINATES 2 double\n5 7\nZ_COORDINATES 1 int\n"
        "4\nPOINT_DATA 6\nSCALARS a float\nLOOKUP_TABLE default\n0 1 3 10 11 13\n");
    const Source source = open(file);
    ASSERT_TRUE(source);
    EXPECT_EQ(source->describe().size, glm::ivec3(4, 2, 1));
    EXPECT_EQ(valuesOf(source), (Axis{0, 1, 2, 3, 10, 11, 12, 13}));
    EXPECT_EQ(io::placeOf(source->describe(), {3, 1, 0}), glm::dvec3(3, 7, 4));
    EXPECT_NE(told().find("from 3,2,1 to 4,2,1"), std::string::npos) << told();
    EXPECT_EQ(toldError(), 0.0);
    forgetTold();
}

TEST_F(VtkRectilinear, TheErrorOfResamplingIsTold)
{
    Axis axes[3];
    for (int i = 0; i <= 24; ++i)
        axes[0].push_back(std::sinh(0.2 * (i - 12))); // rises

    for (int i = 0; i <= 20; ++i)
        axes[1].push_back(6.0 - i * (0.4 + 0.01 * i)); // falls
    for (int i = 0; i < 9; ++i)
        axes[2].push_back(i - 4.0); // even
    const auto set = grid(axes);
    const Axis values = sampled(axes, ball);
    addArray<vtkFloatArray>(set->GetPointData(), "a", 1, values);
    const Source source = open(writeGrid("a.vtr", set));
    ASSERT_TRUE(source);
    const VoxelSource::Description d = source->describe();
    // As the shortest spacing calls for: 2 sinh(2.4) / sinh(0.2), 12 / 0.41.
    EXPECT_EQ(d.size, glm::ivec3(56, 31, 9));
    const Axis found = valuesOf(source);
    double worst = 0.0, low = 1.0, high = 0.0, between = 0.0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::size_t n = axes[0].size(), m = axes[1].size();
        const glm::dvec3 place(axes[0][i % n], axes[1][i / n % m], axes[2][i / n / m]);
        worst = std::max(worst, std::abs(at(d, found, place) - double(float(values[i]))));
        low = std::min(low, values[i]);
        high = std::max(high, values[i]);
    }
    const double told = toldError();
    EXPECT_GT(told, 0.0);
    EXPECT_NEAR(told, worst / (high - low), 0.006 * told); // three digits
    EXPECT_LT(told, 0.02);
    // And it is the ball, in its place, within what the old samples tell of it.
    for (int i = 0; i < 500; ++i) {
        const glm::dvec3 place(5.0 * std::sin(i), -4.0 * std::cos(3.0 * i),
                               4.0 * std::sin(7.0 * i));
        between =
            std::max(between, std::abs(at(d, found, place) - ball(place.x, place.y, place.z)));
    }
    EXPECT_LT(between, 0.06);
    EXPECT_GT(between, 0.0);
}

TEST_F(VtkRectilinear, NoMoreThanFourTimesTheSamples)
{
    const Axis axes[3] = {{0, 1e-3, 10, 20}, {0, 1}, {0, 1}};
    const auto set = grid(axes);
    addArray<vtkUnsignedCharArray>(
        set->GetPointData(), "a", 1,
        Axis{0, 200, 100, 0, 0, 200, 100, 0, 0, 200, 100, 0, 0, 200, 100, 0});
    const std::string file = writeGrid("a.vtr", set);
    const Source source = open(file);
    ASSERT_TRUE(source);
    EXPECT_EQ(source->describe().size, glm::ivec3(16, 2, 2));
    EXPECT_EQ(source->describe().type, VoxelType::FLOAT32);
    // The peak at 1e-3 is lost.
    EXPECT_GT(toldError(), 0.9);
    EXPECT_LE(toldError(), 1.0);
    const auto entries = listVolumes(file);
    ASSERT_TRUE(entries.ok());
    EXPECT_EQ(entries->front().size, osg::Vec3i(16, 2, 2));
    EXPECT_EQ(entries->front().type, VoxelType::FLOAT32);
    EXPECT_EQ(entries->front().text, "points, from 0 to 200, resampled from 4,2,2");
}

// Four times along each axis were 64 times in all.
TEST_F(VtkRectilinear, NoMoreSamplesThanMemoryHas)
{
    Axis stretched;
    for (int i = 0; i < 20; ++i)
        stretched.push_back(std::pow(1.5, i));
    const Axis axes[3] = {stretched, stretched, stretched};
    const auto set = grid(axes);
    addArray<vtkFloatArray>(set->GetPointData(), "a", 1,
                            sampled(axes, [](double x, double, double) { return x; }));
    const std::string file = writeGrid("a.vtr", set);
    const auto sizeOf = [&] {
        const auto entries = listVolumes(file);
        return entries.ok() ? entries->front().size : osg::Vec3i();
    };
    EXPECT_EQ(sizeOf(), osg::Vec3i(80, 80, 80));
    const PagingBudget before = getPagingBudget();
    PagingBudget small = before;
    small.memoryBytes = 1 << 20;
    ASSERT_TRUE(setPagingBudget(small));
    const osg::Vec3i listed = sizeOf();
    const Source source = open(file);
    ASSERT_TRUE(setPagingBudget(before));
    ASSERT_TRUE(source);
    const glm::ivec3 size = source->describe().size;
    EXPECT_EQ(listed, osg::Vec3i(size.x, size.y, size.z));
    EXPECT_LE(source->describe().sizeInBytes(), 1 << 19);
    EXPECT_GT(source->describe().sizeInBytes(), 1 << 18); // as many as there may be
    EXPECT_NE(told().find("wrong by at most"), std::string::npos);
    EXPECT_FLOAT_EQ(float(valuesOf(source).back()), float(stretched.back()));
}

TEST_F(VtkRectilinear, NoMoreThanEightTimesTheSamplesOfLargeOnes)
{
    Axis stretched;
    for (int i = 0; i < 70; ++i)
        stretched.push_back(std::pow(1.2, i));
    const Axis axes[3] = {stretched, stretched, stretched};
    const auto set = grid(axes);
    addArray<vtkFloatArray>(set->GetPointData(), "a", 1, Axis(70 * 70 * 70, 1.0));
    const auto entries =
        listVolumes(write<vtkXMLRectilinearGridWriter>("a.vtr", set.Get(), vtkXMLWriter::Appended));
    ASSERT_TRUE(entries.ok()) << entries.status.text;
    const osg::Vec3i size = entries->front().size; // 280^3 without a bound
    EXPECT_LE(double(size.x()) * size.y() * size.z(), double(1 << 24));
    EXPECT_GT(double(size.x()) * size.y() * size.z(), double(1 << 23));
}

TEST_F(VtkRectilinear, HolesStayWhereTheyAre)
{
    const Axis axes[3] = {{0, 1, 3, 4}, {0, 1}, {0, 1}};
    const auto set = grid(axes);
    Axis values(16, 1.0);
    values[0] = NAN;
    addArray<vtkFloatArray>(set->GetPointData(), "a", 1, values);
    const Source source = open(writeGrid("a.vtr", set));
    ASSERT_TRUE(source);
    const Axis found = valuesOf(source);
    ASSERT_EQ(found.size(), 20u);
    for (std::size_t i = 0; i < 20; ++i)
        EXPECT_EQ(std::isnan(found[i]), i == 0) << i;
}

TEST_F(VtkRectilinear, CoordinatesOutOfOrderAreRefused)
{
    for (const Axis& bad : {Axis{0, 2, 1, 3}, Axis{0, 1, 1, 2}, Axis{0, NAN, 1, 2}}) {
        const Axis axes[3] = {{0, 1, 2}, bad, {0, 1}};
        const auto set = grid(axes);
        addArray<vtkFloatArray>(set->GetPointData(), "a", 1, Axis(24, 1.0));
        EXPECT_NE(refusal(writeGrid("a.vtr", set), "", ErrorCode::VALUE_INVALID)
                      .find("its y coordinates"),
                  std::string::npos);
    }
}

} // namespace VtkRectilinearTest

#endif
