#include "VtkRenderer.h"

#include "../support/VtkWindow.h"

#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkColorTransferFunction.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkMultiVolume.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <algorithm>

namespace osgVolumizer {
namespace bench {

namespace {

int vtkTypeOf(VoxelType type)
{
    return type == VoxelType::UINT8    ? VTK_UNSIGNED_CHAR
           : type == VoxelType::UINT16 ? VTK_UNSIGNED_SHORT
                                       : VTK_FLOAT;
}

vtkSmartPointer<vtkImageData> imageOf(const ChartVolume& volume)
{
    auto image = vtkSmartPointer<vtkImageData>::New();
    const glm::ivec3 n = volume.size;
    image->SetDimensions(n.x, n.y, n.z);
    image->SetOrigin(volume.origin.x, volume.origin.y, volume.origin.z);
    image->AllocateScalars(vtkTypeOf(volume.type), 1);
    std::copy(volume.voxels.begin(), volume.voxels.end(),
              static_cast<unsigned char*>(image->GetScalarPointer()));
    return image;
}

vtkSmartPointer<vtkVolume> volumeOf(const ChartVolume& volume, const ChartScene& scene)
{
    vtkNew<vtkColorTransferFunction> colors;
    vtkNew<vtkPiecewiseFunction> opacity;
    for (const auto& p : volume.table) {
        const double value = volume.range.x + p.value * (volume.range.y - volume.range.x);
        colors->AddRGBPoint(value, p.color.r, p.color.g, p.color.b);
        opacity->AddPoint(value, p.color.a);
    }
    auto result = vtkSmartPointer<vtkVolume>::New();
    vtkVolumeProperty* property = result->GetProperty();
    property->SetColor(colors);
    property->SetScalarOpacity(opacity);
    property->SetScalarOpacityUnitDistance(1.0);
    property->SetInterpolationTypeToLinear();
    property->SetShade(scene.shaded ? 1 : 0);
    if (scene.shaded) {
        property->SetAmbient(scene.ambient);
        property->SetDiffuse(scene.diffuse);
        property->SetSpecular(0.0);
    }
    return result;
}

class VtkRenderer : public Renderer
{
public:
    explicit VtkRenderer(bool gpu) : _gpu(gpu) {}

    std::string name() const override { return _gpu ? "VTK GPU" : "VTK CPU"; }
    Status open(const ChartScene& scene) override;
    Status setStep(double stepVoxel) override;
    void frame() override { _window.frame(); }
    support::FloatImage picture() override { return _window.picture(); }

private:
    void makeVolumes(const ChartScene& scene);
    void addSurface(const ChartSurface& surface);

    bool _gpu;
    VtkWindow _window;
    vtkSmartPointer<vtkGPUVolumeRayCastMapper> _gpuMapper;
    vtkSmartPointer<vtkFixedPointVolumeRayCastMapper> _cpuMapper;
};

// Several are one vtkMultiVolume, whose mapper has an input for each.
void VtkRenderer::makeVolumes(const ChartScene& scene)
{
    vtkSmartPointer<vtkVolume> shown = volumeOf(scene.volumes.front(), scene);
    if (!_gpu) {
        _cpuMapper = vtkSmartPointer<vtkFixedPointVolumeRayCastMapper>::New();
        _cpuMapper->SetInputData(imageOf(scene.volumes.front()));
        _cpuMapper->SetAutoAdjustSampleDistances(0);
        _cpuMapper->SetLockSampleDistanceToInputSpacing(0);
        _cpuMapper->SetImageSampleDistance(1.0f);
        shown->SetMapper(_cpuMapper);
    } else {
        _gpuMapper = vtkSmartPointer<vtkGPUVolumeRayCastMapper>::New();
        _gpuMapper->SetAutoAdjustSampleDistances(0);
        _gpuMapper->SetUseJittering(0);
        _gpuMapper->SetLockSampleDistanceToInputSpacing(0);
        const int count = int(scene.volumes.size());
        const auto several = vtkSmartPointer<vtkMultiVolume>::New();
        for (int i = 0; i < count; ++i) {
            const ChartVolume& volume = scene.volumes[std::size_t(i)];
            _gpuMapper->SetInputDataObject(i, imageOf(volume));
            if (count > 1) several->SetVolume(volumeOf(volume, scene), i);
        }
        if (count > 1) shown = several;
        shown->SetMapper(_gpuMapper);
    }
    _window.renderer().AddVolume(shown);
}

void VtkRenderer::addSurface(const ChartSurface& surface)
{
    vtkNew<vtkPoints> points;
    for (const glm::vec3& p : surface.mesh.points)
        points->InsertNextPoint(p.x, p.y, p.z);
    vtkNew<vtkCellArray> cells;
    for (const auto& t : surface.mesh.triangles) {
        const vtkIdType corners[3] = {vtkIdType(t[0]), vtkIdType(t[1]), vtkIdType(t[2])};
        cells->InsertNextCell(3, corners);
    }
    vtkNew<vtkPolyData> data;
    data->SetPoints(points);
    data->SetPolys(cells);
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(data);
    vtkNew<vtkActor> actor;
    actor->SetMapper(mapper);
    actor->GetProperty()->SetLighting(false);
    actor->GetProperty()->SetColor(surface.color.r, surface.color.g, surface.color.b);
    actor->GetProperty()->SetOpacity(surface.color.a);
    _window.renderer().AddActor(actor);
}

Status VtkRenderer::open(const ChartScene& scene)
{
    if (!_gpu && !scene.isOneVolume())
        return Status(ErrorCode::NOT_SUPPORTED, "draws one volume, and surfaces behind it");
    const Status status = _window.open(scene.view.width, scene.view.height);
    if (!status.ok()) return status;
    makeVolumes(scene);
    for (const ChartSurface& surface : scene.surfaces)
        addSurface(surface);
    vtkRenderer& renderer = _window.renderer();
    if (!scene.surfaces.empty()) {
        renderer.SetUseDepthPeeling(1);
        renderer.SetUseDepthPeelingForVolumes(1);
        renderer.SetMaximumNumberOfPeels(20);
        renderer.SetOcclusionRatio(0.0);
    }
    if (scene.shaded) {
        vtkNew<vtkLight> light;
        light->SetLightTypeToHeadlight();
        renderer.AddLight(light);
    }
    _window.setView(scene.view);
    return {};
}

Status VtkRenderer::setStep(double stepVoxel)
{
    if (_gpuMapper)
        _gpuMapper->SetSampleDistance(float(stepVoxel));
    else
        _cpuMapper->SetSampleDistance(float(stepVoxel));
    if (_cpuMapper) _cpuMapper->SetInteractiveSampleDistance(float(stepVoxel));
    return {};
}

} // namespace

RendererPtr makeVtkRenderer(bool gpu)
{
    return std::make_unique<VtkRenderer>(gpu);
}

} // namespace bench
} // namespace osgVolumizer
