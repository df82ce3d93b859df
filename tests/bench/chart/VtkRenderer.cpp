#include "VtkRenderer.h"

#include <vtkCamera.h>
#include <vtkColorTransferFunction.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>
#include <vtkPiecewiseFunction.h>
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
    void makeVolume(const ChartScene& scene);
    void makeMapper(vtkImageData* image);
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
    vtkNew<vtkVolume> _volume;
    vtkNew<vtkTextureObject> _texture;
    vtkSmartPointer<vtkGPUVolumeRayCastMapper> _gpuMapper;
    vtkSmartPointer<vtkFixedPointVolumeRayCastMapper> _cpuMapper;
};

void VtkRenderer::makeVolume(const ChartScene& scene)
{
    vtkNew<vtkImageData> image;
    const glm::ivec3 n = scene.size;
    image->SetDimensions(n.x, n.y, n.z);
    image->SetOrigin(scene.origin.x, scene.origin.y, scene.origin.z);
    image->AllocateScalars(vtkTypeOf(scene.type), 1);
    std::copy(scene.voxels.begin(), scene.voxels.end(),
              static_cast<unsigned char*>(image->GetScalarPointer()));

    vtkNew<vtkColorTransferFunction> colors;
    vtkNew<vtkPiecewiseFunction> opacity;
    for (const auto& p : scene.table) {
        const double value = scene.range.x + p.value * (scene.range.y - scene.range.x);
        colors->AddRGBPoint(value, p.color.r, p.color.g, p.color.b);
        opacity->AddPoint(value, p.color.a);
    }
    vtkVolumeProperty* property = _volume->GetProperty();
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
    makeMapper(image);
}

void VtkRenderer::makeMapper(vtkImageData* image)
{
    if (_gpu) {
        _gpuMapper = vtkSmartPointer<vtkGPUVolumeRayCastMapper>::New();
        _gpuMapper->SetInputData(image);
        _gpuMapper->SetAutoAdjustSampleDistances(0);
        _gpuMapper->SetUseJittering(0);
        _gpuMapper->SetLockSampleDistanceToInputSpacing(0);
        _volume->SetMapper(_gpuMapper);
    } else {
        _cpuMapper = vtkSmartPointer<vtkFixedPointVolumeRayCastMapper>::New();
        _cpuMapper->SetInputData(image);
        _cpuMapper->SetAutoAdjustSampleDistances(0);
        _cpuMapper->SetLockSampleDistanceToInputSpacing(0);
        _cpuMapper->SetImageSampleDistance(1.0f);
        _volume->SetMapper(_cpuMapper);
    }
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
    _window = vtkSmartPointer<vtkRenderWindow>::New();
    _window->SetOffScreenRendering(1);
    _window->SetMultiSamples(0);
    _window->SetSize(scene.view.width, scene.view.height);
    _window->AddRenderer(_renderer);
    makeVolume(scene);
    _renderer->AddVolume(_volume);
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
