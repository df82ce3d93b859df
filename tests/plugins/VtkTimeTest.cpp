// Files of VTK with several time steps.

#ifdef OSGVOLUMIZER_HAVE_VTK_IMAGES

#include "VtkFiles.h"

#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>
#include <osgVolumizer/io/Placement.h>

#include <osgDB/ReadFile>

#include <vtkCellType.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <atomic>
#include <cmath>
#include <thread>

namespace VtkTimeTest {

using namespace osgVolumizer;

namespace {

class VtkTime : public VtkFolderTest
{
protected:
    /// An image of 2 x 2 x 2 points of two time steps, with arrays of XML.
    std::string twoSteps(const std::string& name, const std::string& arrays,
                         const std::string& more = {}) const
    {
        return writeBytes(name,
                          "<?xml version=\"1.0\"?><VTKFile type=\"ImageData\" version=\"1.0\">"
                          "<ImageData WholeExtent=\"3 4 0 1 0 1\" TimeValues=\"0 1\" " +
                              more + "><Piece Extent=\"3 4 0 1 0 1\"><PointData>" + arrays +
                              "</PointData></Piece></ImageData></VTKFile>");
    }
    static std::string array(const std::string& type, int step, const std::string& numbers,
                             const std::string& name = "a", int components = 1)
    {
        return "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
               std::to_string(components) + "\" format=\"ascii\" TimeStep=\"" +
               std::to_string(step) + "\">" + numbers + "</DataArray>";
    }
};

} // namespace

TEST_F(VtkTime, StepsOfAnImage)
{
    const auto set = image(3, 2, 2);
    vtkNew<vtkXMLImageDataWriter> writer;
    writer->SetFileName(path("a.vti").c_str());
    writer->SetNumberOfTimeSteps(3);
    writer->SetDataModeToAppended();
    writer->SetInputData(set);
    writer->Start();
    for (int step = 0; step < 3; ++step) {
        set->GetPointData()->Initialize();
        addArray<vtkFloatArray>(set->GetPointData(), "a", 1, std::vector<double>(12, 100.0 * step));
        set->Modified();
        writer->WriteNextTime(0.5 * step);
    }
    writer->Stop();
    const Source source = open(path("a.vti"));
    ASSERT_TRUE(source);
    ASSERT_EQ(source->stepCount(), 3);
    for (const int step : {2, 0, 1})
        EXPECT_EQ(valuesOf(*source, step), std::vector<double>(12, 100.0 * step)) << step;
    EXPECT_EQ(listVolumes(path("a.vti"))->front().steps, 3);
}

TEST_F(VtkTime, ImagesOfStepsLieWhereTheFileSays)
{
    const Source source = open(twoSteps(
        "a.vti", array("Float32", 0, "0 1 2 3 4 5 6 7") + array("Float32", 1, "7 6 5 4 3 2 1 0"),
        "Origin=\"1 2 3\" Spacing=\"2 4 8\" Direction=\"0 -1 0 1 0 0 0 0 -1\""));
    ASSERT_TRUE(source);
    EXPECT_EQ(valuesOf(*source, 1), (std::vector<double>{7, 6, 5, 4, 3, 2, 1, 0}));
    // Index 3 of x is the first: 1 - 4 y, 2 + 2 x, 3 - 8 z.
    const auto expectAt = [&](const glm::dvec3& voxel, const glm::dvec3& expected) {
        const glm::dvec3 place = io::placeOf(source->describe(), voxel);
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_NEAR(place[axis], expected[axis], 1e-9);
    };
    expectAt({0, 0, 0}, {1, 8, 3});
    expectAt({1, 1, 1}, {-3, 10, -5});
}

// The narrowest type that holds a step does not hold another.
TEST_F(VtkTime, StepsHaveOneType)
{
    const std::string small = "0 1 2 3 4 5 6 7", large = "0 1 2 3 4 5 6 70000",
                      fine = "0 1 2 3 4 5 6 1000000.1";
    const auto expect = [this](const std::string& arrays, VoxelType type, double last) {
        const std::string file = twoSteps("a.vti", arrays);
        const Source source = open(file);
        if (!source) return;
        EXPECT_EQ(source->describe().type, type);
        EXPECT_EQ(valuesOf(*source, 0).back(), 7.0);
        EXPECT_EQ(valuesOf(*source, 1).back(), last);
        const osg::ref_ptr<osgDB::Options> a = new osgDB::Options("dataset=a");
        EXPECT_EQ(listVolumes(file, a.get())->front().type, type);
    };
    expect(array("Int64", 0, small) + array("Int64", 1, large), VoxelType::FLOAT64, 70000.0);
    expect(array("Float64", 0, small) + array("Float64", 1, fine), VoxelType::FLOAT64, 1000000.1);
    expect(array("Int16", 0, small) + array("Int16", 1, "0 0 0 0 0 0 0 9"), VoxelType::INT16, 9.0);
    // Hidden points in one of them alone.
    const std::string file =
        twoSteps("b.vti", array("UInt8", 0, small) + array("UInt8", 1, small) +
                              array("UInt8", 0, "0 0 0 0 0 0 0 0", "vtkGhostType") +
                              array("UInt8", 1, "0 2 0 0 0 0 0 0", "vtkGhostType"));
    const Source source = open(file);
    ASSERT_TRUE(source);
    EXPECT_EQ(source->describe().type, VoxelType::FLOAT32);
    EXPECT_EQ(valuesOf(*source, 0)[1], 1.0);
    const std::vector<double> hidden = valuesOf(*source, 1);
    EXPECT_TRUE(std::isnan(hidden[1]));
    EXPECT_EQ(hidden[7], 7.0);
    EXPECT_EQ(listVolumes(file)->front().type, VoxelType::FLOAT32);
}

TEST_F(VtkTime, NumberedFilesAreASeries)
{
    for (int step = 0; step < 3; ++step) {
        const auto set = image(3, 2, 2);
        addArray<vtkFloatArray>(set->GetPointData(), "other", 1, std::vector<double>(12, -1.0));
        addArray<vtkFloatArray>(set->GetPointData(), "a", 1, std::vector<double>(12, step));
        writeImage("flow" + std::to_string(step) + ".vti", set);
    }
    const Source source = open(path("flow%d.vti"), "series=on dataset=a");
    ASSERT_TRUE(source);
    ASSERT_EQ(source->stepCount(), 3);
    for (const int step : {2, 0, 1})
        EXPECT_EQ(valuesOf(*source, step), std::vector<double>(12, step));
}

// As the steps of a series are read.
TEST_F(VtkTime, SeveralThreadsReadAtOnce)
{
    const auto set = image(20, 20, 20);
    std::vector<double> values(8000);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = double(i);
    addArray<vtkFloatArray>(set->GetPointData(), "a", 1, values);
    const std::string file = writeImage("a.vti", set, vtkXMLWriter::Appended, vtkXMLWriter::ZLIB);
    std::atomic<int> wrong{0}, right{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
        threads.emplace_back([&]() {
            for (int i = 0; i < 10; ++i) {
                const auto voxels = readVoxels(file);
                const bool good = voxels.ok() && valuesOf(*(*voxels)->getSource()) == values;
                ++(good ? right : wrong);
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(wrong, 0);
    EXPECT_EQ(right, 40);
}

// Tetrahedra whose scalar is the number of the step.
TEST_F(VtkTime, StepsOfCells)
{
    vtkNew<vtkUnstructuredGrid> cells;
    vtkNew<vtkPoints> points;
    for (const auto& p :
         {glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)})
        points->InsertNextPoint(p.x, p.y, p.z);
    cells->SetPoints(points);
    const vtkIdType corners[] = {0, 1, 2, 3};
    cells->InsertNextCell(VTK_TETRA, 4, corners);
    vtkNew<vtkXMLUnstructuredGridWriter> writer;
    writer->SetFileName(path("a.vtu").c_str());
    writer->SetNumberOfTimeSteps(3);
    writer->SetInputData(cells);
    writer->Start();
    for (int step = 0; step < 3; ++step) {
        cells->GetPointData()->Initialize();
        addArray<vtkDoubleArray>(cells->GetPointData(), "a", 1,
                                 std::vector<double>{0.0, 1.0, 2.0, 10.0 * (step + 1)});
        cells->Modified();
        writer->WriteNextTime(step);
    }
    writer->Stop();
    const auto load = [this](const std::string& options) {
        const osg::ref_ptr<osgDB::Options> o = new osgDB::Options(options);
        const osg::ref_ptr<osg::Node> node = osgDB::readRefNodeFile(path("a.vtu"), o);
        const auto* appearance = dynamic_cast<VolumeAppearance*>(node.get());
        const auto* volume =
            appearance ? dynamic_cast<const VolumeGeometry*>(appearance->getChild(0)) : nullptr;
        return volume ? volume->getScalarRange().y() : -1.0;
    };
    EXPECT_EQ(load(""), 10.0);
    EXPECT_NE(told().find("3 time steps, the first of which"), std::string::npos) << told();
    forgetTold();
    EXPECT_EQ(load("step=2"), 30.0);
    EXPECT_EQ(load("step=1"), 20.0);
    EXPECT_EQ(told(), "");
    EXPECT_EQ(load("step=3"), -1.0);
    EXPECT_EQ(load("step=-1"), -1.0);
}

} // namespace VtkTimeTest

#endif
