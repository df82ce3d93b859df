// Files of VTK with several time steps.

#ifdef OSGVOLUMIZER_HAVE_VTK_IMAGES

#include "VtkFiles.h"

#include <osgVolumizer/VolumeAppearance.h>

#include <osgDB/ReadFile>

#include <vtkCellType.h>
#include <vtkPoints.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include <atomic>
#include <thread>

namespace VtkTimeTest {

using namespace osgVolumizer;

namespace {

using VtkTime = VtkFolderTest;

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
        return appearance ? appearance->getVoxels()->getRange().y() : -1.0;
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
