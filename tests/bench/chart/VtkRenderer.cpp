#include "VtkRenderer.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkColorTransferFunction.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkMultiVolume.h>
#include <vtkNew.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkPiecewiseFunction.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkTextureObject.h>
#include <vtkVolume.h>
#include <vtkVolumeProperty.h>

#include <vtkAutoInit.h>
VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2)

#include <GL/gl.h>
#include <GL/glx.h>
#undef Status // of X11

#include <algorithm>
#include <cmath>
#include <cstdlib>

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
    ~VtkRenderer() override
    {
        if (!_window) return;
        _window->MakeCurrent();
        _window->Finalize();
    }

    std::string name() const override { return _gpu ? "VTK GPU" : "VTK CPU"; }
    Status open(const ChartScene& scene) override;
    Status setStep(double stepVoxel) override;
    void frame() override
    {
        _window->Render();
        glFinish();
        release();
    }
    support::FloatImage picture() override;

private:
    void makeVolumes(const ChartScene& scene);
    void addSurface(const ChartSurface& surface);
    void makeView(const ChartScene& scene);
    void makeFloatTarget();
    // The other renderers make contexts of EGL current in this thread.
    static void release()
    {
        if (Display* display = glXGetCurrentDisplay()) glXMakeCurrent(display, None, nullptr);
    }

    bool _gpu;
    ChartScene _scene;
    vtkSmartPointer<vtkRenderWindow> _window;
    vtkNew<vtkRenderer> _renderer;
    vtkNew<vtkTextureObject> _texture;
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
    _renderer->AddVolume(shown);
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
    _renderer->AddActor(actor);
}

void VtkRenderer::makeView(const ChartScene& scene)
{
    osg::Vec3d eye, center, up;
    scene.view.view.getLookAt(eye, center, up, 330.0);
    vtkCamera* camera = _renderer->GetActiveCamera();
    camera->SetPosition(eye.x(), eye.y(), eye.z());
    camera->SetFocalPoint(center.x(), center.y(), center.z());
    camera->SetViewUp(up.x(), up.y(), up.z());
    const osg::Matrixd& p = scene.view.projection;
    if (p(3, 3) != 0.0) {
        camera->ParallelProjectionOn();
        camera->SetParallelScale(1.0 / p(1, 1)); // half the height
    } else {
        camera->SetViewAngle(2.0 * std::atan(1.0 / p(1, 1)) * 180.0 / M_PI);
    }
    _renderer->ResetCameraClippingRange();
    _renderer->SetBackground(0.0, 0.0, 0.0);
    _renderer->SetBackgroundAlpha(0.0);
    if (!scene.shaded) return;
    vtkNew<vtkLight> light;
    light->SetLightTypeToHeadlight();
    _renderer->AddLight(light);
}

// The window draws to a framebuffer of 8 bits, and copies that to the screen: here its colours
// get 32.
void VtkRenderer::makeFloatTarget()
{
    _window->Render(); // makes the framebuffer
    auto* window = static_cast<vtkOpenGLRenderWindow*>(_window.Get());
    _texture->SetContext(window);
    _texture->Create2D(unsigned(_scene.view.width), unsigned(_scene.view.height), 4, VTK_FLOAT,
                       false);
    window->GetState()->PushFramebufferBindings();
    window->GetRenderFramebuffer()->Bind();
    window->GetRenderFramebuffer()->AddColorAttachment(0, _texture);
    window->GetState()->PopFramebufferBindings();
}

Status VtkRenderer::open(const ChartScene& scene)
{
    _scene = scene;
    if (!std::getenv("DISPLAY")) return Status(ErrorCode::NOT_SUPPORTED, "needs an X server");
    if (!_gpu && !scene.isOneVolume())
        return Status(ErrorCode::NOT_SUPPORTED, "draws one volume, and surfaces behind it");
    _window = vtkSmartPointer<vtkRenderWindow>::New();
    _window->SetOffScreenRendering(1);
    _window->SetMultiSamples(0);
    _window->SetSize(scene.view.width, scene.view.height);
    _window->AddRenderer(_renderer);
    _window->SetAlphaBitPlanes(1); // for peeling
    makeVolumes(scene);
    for (const ChartSurface& surface : scene.surfaces)
        addSurface(surface);
    if (!scene.surfaces.empty()) {
        _renderer->SetUseDepthPeeling(1);
        _renderer->SetUseDepthPeelingForVolumes(1);
        _renderer->SetMaximumNumberOfPeels(20);
        _renderer->SetOcclusionRatio(0.0);
    }
    makeView(scene);
    makeFloatTarget();
    release();
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

support::FloatImage VtkRenderer::picture()
{
    support::FloatImage image(_scene.view.width, _scene.view.height);
    _window->MakeCurrent();
    glBindTexture(GL_TEXTURE_2D, _texture->GetHandle());
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, image.pixels.data());
    glBindTexture(GL_TEXTURE_2D, 0);
    release();
    return image;
}

} // namespace

RendererPtr makeVtkRenderer(bool gpu)
{
    return std::make_unique<VtkRenderer>(gpu);
}

} // namespace bench
} // namespace osgVolumizer
