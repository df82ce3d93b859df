#include "VtkMeshRenderer.h"

#include "../support/VtkWindow.h"

#include <oracles/Table.h>

#include <vtkCamera.h>
#include <vtkCellType.h>
#include <vtkColorTransferFunction.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkProjectedTetrahedraMapper.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridLinearRayIntegrator.h>
#include <vtkUnstructuredGridPartialPreIntegration.h>
#include <vtkUnstructuredGridVolumeRayCastMapper.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>
#include <thread>

namespace osgVolumizer {
namespace bench {

namespace {

vtkSmartPointer<vtkUnstructuredGrid> gridOf(const oracle::TetraMesh& mesh)
{
    vtkNew<vtkPoints> points;
    points->SetDataTypeToFloat();
    vtkNew<vtkFloatArray> scalars;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        points->InsertNextPoint(&mesh.points[i].x);
        scalars->InsertNextValue(float(mesh.scalars[i]));
    }
    auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
    grid->SetPoints(points);
    grid->GetPointData()->SetScalars(scalars);
    grid->Allocate(vtkIdType(mesh.cells.size()));
    for (const oracle::TetraMesh::Cell& cell : mesh.cells) {
        const vtkIdType corners[4] = {cell[0], cell[1], cell[2], cell[3]};
        grid->InsertNextCell(VTK_TETRA, 4, corners);
    }
    return grid;
}

// What these renderers call opacity is extinction per unit distance, linear between points. Between
// two of the table's there are as many more as it takes for both to agree, and none where its
// opacity hardly changes, since the integrators search them one by one. Extinction is scaled to
// [0, 1], of which projected tetrahedra keep 8 bits.
void setTable(vtkVolumeProperty& property, const TablePoints& table, double unit)
{
    constexpr double STEP = 1.0 / 32.0; // of opacity
    TablePoints fine{table.front()};
    for (std::size_t i = 1; i < table.size(); ++i) {
        const auto &a = table[i - 1], &b = table[i];
        const int count = std::max(1, int(std::ceil(std::abs(b.color.a - a.color.a) / STEP)));
        for (int j = 1; j <= count; ++j) {
            const double f = double(j) / count;
            fine.push_back({a.value + f * (b.value - a.value), a.color + f * (b.color - a.color)});
        }
    }
    double most = 0.0;
    for (const auto& p : fine)
        most = std::max(most, oracle::Table::extinction(p.color.a));
    vtkNew<vtkColorTransferFunction> colors;
    vtkNew<vtkPiecewiseFunction> extinction;
    for (const auto& p : fine) {
        colors->AddRGBPoint(p.value, p.color.r, p.color.g, p.color.b);
        extinction->AddPoint(p.value, oracle::Table::extinction(p.color.a) / most);
    }
    property.SetColor(colors);
    property.SetScalarOpacity(extinction);
    property.SetScalarOpacityUnitDistance(unit / most);
    property.SetInterpolationTypeToLinear();
    property.SetShade(0);
}

vtkSmartPointer<vtkUnstructuredGridVolumeMapper> mapperOf(VtkMeshTechnique technique)
{
    if (technique == VtkMeshTechnique::PROJECTED)
        return vtkSmartPointer<vtkProjectedTetrahedraMapper>::New();
    const auto mapper = vtkSmartPointer<vtkUnstructuredGridVolumeRayCastMapper>::New();
    mapper->SetAutoAdjustSampleDistances(0);
    mapper->SetImageSampleDistance(1.0f);
    mapper->SetIntermixIntersectingGeometry(0); // there is none
    mapper->SetNumberOfThreads(int(std::max(1u, std::thread::hardware_concurrency())));
    if (technique == VtkMeshTechnique::RAYS_PARTIAL)
        mapper->SetRayIntegrator(vtkNew<vtkUnstructuredGridPartialPreIntegration>());
    if (technique == VtkMeshTechnique::RAYS_LINEAR)
        mapper->SetRayIntegrator(vtkNew<vtkUnstructuredGridLinearRayIntegrator>());
    return mapper;
}

class VtkMeshRenderer : public MeshRenderer
{
public:
    explicit VtkMeshRenderer(VtkMeshTechnique technique) : _technique(technique) {}

    std::string name() const override
    {
        switch (_technique) {
        case VtkMeshTechnique::PROJECTED:
            return "VTK projected tetrahedra";
        case VtkMeshTechnique::RAYS_PREINTEGRATED:
            return "VTK rays";
        case VtkMeshTechnique::RAYS_PARTIAL:
            return "VTK rays partial";
        case VtkMeshTechnique::RAYS_LINEAR:
            break;
        }
        return "VTK rays linear";
    }
    Status open(const MeshScene& scene) override
    {
        const support::RenderOptions view = scene.view(0);
        const Status status = _window.open(view.width, view.height);
        if (!status.ok()) return status;
        const auto mapper = mapperOf(_technique);
        mapper->SetInputData(gridOf(scene.mesh));
        vtkNew<vtkVolume> volume;
        setTable(*volume->GetProperty(), scene.table, scene.unit);
        volume->SetMapper(mapper);
        _window.renderer().AddVolume(volume);
        if (_technique != VtkMeshTechnique::PROJECTED) moveByHalfAPixel(view);
        _window.setView(view);
        return {};
    }
    void setView(const support::RenderOptions& view) override { _window.setView(view); }
    void frame() override { _window.frame(); }
    support::FloatImage picture() override { return _window.picture(); }

private:
    // Its rays go through the lower left corners of pixels, not through their centres.
    void moveByHalfAPixel(const support::RenderOptions& view)
    {
        _window.renderer().GetActiveCamera()->SetWindowCenter(1.0 / view.width, 1.0 / view.height);
    }

    VtkMeshTechnique _technique;
    VtkWindow _window;
};

} // namespace

MeshRendererPtr makeVtkMeshRenderer(VtkMeshTechnique technique)
{
    return std::make_unique<VtkMeshRenderer>(technique);
}

} // namespace bench
} // namespace osgVolumizer
