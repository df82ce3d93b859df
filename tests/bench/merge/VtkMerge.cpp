// A volume with translucent spheres in it, by this library and by VTK's GPU ray caster with dual
// depth peeling: time of a frame against the error to the oracle, for several steps. Needs an X
// server:
//
//   LIBGL_ALWAYS_SOFTWARE=1 xvfb-run -a -s "-screen 0 1280x1024x24" build/bin/mergevtk [frames]
//
// Frames of both are interleaved; times are medians of wall-clock and of the process's CPU time.

#include "../Median.h"
#include "MixedScene.h"

#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkColorTransferFunction.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkImageData.h>
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
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 128;       // voxels per axis
constexpr int TIMED_SIZE = 512; // pixels of the timed picture, and of that compared with the oracle
constexpr int JUDGED_SIZE = 128;
constexpr glm::dvec4 GREEN(0.2, 0.9, 0.3, 0.4);
const Points TABLE = {{0.0, {0.1, 0.2, 0.9, 0.002}}, {1.0, {1.0, 0.5, 0.1, 0.03}}};

std::vector<Mesh> spheres()
{
    return {sphereMesh({44, 50, 60}, 24, 100, 50), sphereMesh({80, 70, 64}, 28, 100, 50),
            sphereMesh({64, 64, 90}, 20, 100, 50)};
}

RenderOptions viewOf(const MixedScene& scene, int size)
{
    RenderOptions options;
    options.size(size, size).perspective(30.0).frameScene(scene.root()->getBound());
    return options;
}

vtkSmartPointer<vtkPolyData> polyData(const Mesh& mesh)
{
    vtkNew<vtkPoints> points;
    for (const glm::vec3& p : mesh.points)
        points->InsertNextPoint(p.x, p.y, p.z);
    vtkNew<vtkCellArray> cells;
    for (const auto& t : mesh.triangles) {
        const vtkIdType corners[3] = {vtkIdType(t[0]), vtkIdType(t[1]), vtkIdType(t[2])};
        cells->InsertNextCell(3, corners);
    }
    auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->SetPolys(cells);
    return data;
}

/// The scene in VTK, drawn to a float target.
class VtkScene
{
public:
    VtkScene(const Voxels& voxels, const RenderOptions& options)
        : _width(options.width), _height(options.height)
    {
        addVolume(voxels);
        for (const Mesh& mesh : spheres())
            addMesh(mesh);
        setCamera(options);
        _renderer->SetUseDepthPeeling(1);
        _renderer->SetUseDepthPeelingForVolumes(1);
        _renderer->SetMaximumNumberOfPeels(20);
        _renderer->SetOcclusionRatio(0.0);
        _renderer->SetBackground(0.0, 0.0, 0.0);
        _renderer->SetBackgroundAlpha(0.0);
        _window = vtkSmartPointer<vtkRenderWindow>::New();
        _window->SetOffScreenRendering(1);
        _window->SetMultiSamples(0);
        _window->SetAlphaBitPlanes(1);
        _window->SetSize(_width, _height);
        _window->AddRenderer(_renderer);
        makeFloatTarget();
        release();
    }
    ~VtkScene()
    {
        _window->MakeCurrent();
        _window->Finalize();
        release();
    }
    void setStep(double voxels) { _mapper->SetSampleDistance(float(voxels)); }
    void frame()
    {
        _window->Render();
        glFinish();
        release();
    }
    FloatImage picture()
    {
        FloatImage image(_width, _height);
        _window->MakeCurrent();
        glBindTexture(GL_TEXTURE_2D, _texture->GetHandle());
        glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, image.pixels.data());
        glBindTexture(GL_TEXTURE_2D, 0);
        release();
        return image;
    }

private:
    void addVolume(const Voxels& voxels)
    {
        vtkNew<vtkImageData> image;
        image->SetDimensions(SIZE, SIZE, SIZE);
        image->AllocateScalars(VTK_FLOAT, 1);
        const auto* source = dynamic_cast<MemoryVoxelSource*>(voxels.getSource());
        const float* values = static_cast<const float*>(source->data());
        std::copy(values, values + SIZE * SIZE * SIZE,
                  static_cast<float*>(image->GetScalarPointer()));
        vtkNew<vtkColorTransferFunction> colors;
        vtkNew<vtkPiecewiseFunction> opacity;
        for (const auto& p : TABLE) {
            colors->AddRGBPoint(p.value, p.color.r, p.color.g, p.color.b);
            opacity->AddPoint(p.value, p.color.a);
        }
        vtkVolumeProperty* property = _volume->GetProperty();
        property->SetColor(colors);
        property->SetScalarOpacity(opacity);
        property->SetScalarOpacityUnitDistance(1.0);
        property->SetInterpolationTypeToLinear();
        property->SetShade(0);
        _mapper->SetInputData(image);
        _mapper->SetAutoAdjustSampleDistances(0);
        _mapper->SetUseJittering(0);
        _mapper->SetLockSampleDistanceToInputSpacing(0);
        _volume->SetMapper(_mapper);
        _renderer->AddVolume(_volume);
    }
    void addMesh(const Mesh& mesh)
    {
        vtkNew<vtkPolyDataMapper> mapper;
        mapper->SetInputData(polyData(mesh));
        vtkNew<vtkActor> actor;
        actor->SetMapper(mapper);
        actor->GetProperty()->SetLighting(false);
        actor->GetProperty()->SetColor(GREEN.r, GREEN.g, GREEN.b);
        actor->GetProperty()->SetOpacity(GREEN.a);
        _renderer->AddActor(actor);
    }
    void setCamera(const RenderOptions& options)
    {
        osg::Vec3d eye, center, up;
        options.view.getLookAt(eye, center, up, 330.0);
        vtkCamera* camera = _renderer->GetActiveCamera();
        camera->SetPosition(eye.x(), eye.y(), eye.z());
        camera->SetFocalPoint(center.x(), center.y(), center.z());
        camera->SetViewUp(up.x(), up.y(), up.z());
        camera->SetViewAngle(2.0 * std::atan(1.0 / options.projection(1, 1)) * 180.0 / M_PI);
        _renderer->ResetCameraClippingRange();
    }
    // The window draws to a framebuffer of 8 bits: here its colours get 32.
    void makeFloatTarget()
    {
        _window->Render(); // makes the framebuffer
        auto* window = static_cast<vtkOpenGLRenderWindow*>(_window.Get());
        _texture->SetContext(window);
        _texture->Create2D(unsigned(_width), unsigned(_height), 4, VTK_FLOAT, false);
        window->GetState()->PushFramebufferBindings();
        window->GetRenderFramebuffer()->Bind();
        window->GetRenderFramebuffer()->AddColorAttachment(0, _texture);
        window->GetState()->PopFramebufferBindings();
    }
    // We make contexts of EGL current in this thread.
    static void release()
    {
        if (Display* display = glXGetCurrentDisplay()) glXMakeCurrent(display, None, nullptr);
    }

    int _width, _height;
    vtkNew<vtkRenderer> _renderer;
    vtkNew<vtkVolume> _volume;
    vtkNew<vtkGPUVolumeRayCastMapper> _mapper;
    vtkNew<vtkTextureObject> _texture;
    vtkSmartPointer<vtkRenderWindow> _window;
};

struct Times
{
    std::vector<double> wall, cpu;

    template <class Draw>
    void add(Draw draw)
    {
        const auto start = std::chrono::steady_clock::now();
        const std::clock_t cpuStart = std::clock();
        draw();
        cpu.push_back(1e3 * double(std::clock() - cpuStart) / CLOCKS_PER_SEC);
        wall.push_back(
            std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
                .count());
    }
};

void print(const char* name, double step, double rmse, const Times& times)
{
    std::printf("%-14s step %5.3f voxels  rmse %.2e  wall %7.1f ms  CPU %7.1f ms\n", name, step,
                rmse, bench::median(times.wall), bench::median(times.cpu));
    std::fflush(stdout);
}

} // namespace

int main(int argc, char** argv)
{
    const int frames = argc > 1 ? std::max(1, std::atoi(argv[1])) : 7;
    if (!std::getenv("DISPLAY")) {
        std::fprintf(stderr, "VTK needs an X server: run under xvfb-run.\n");
        return 1;
    }
    const osg::ref_ptr<Voxels> voxels =
        makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3& p) { return bumps(0.4 * p); });
    MixedScene scene;
    scene.addVolume(voxels, TABLE);
    for (const Mesh& mesh : spheres())
        scene.addMesh(mesh, GREEN);
    const RenderOptions judged = viewOf(scene, JUDGED_SIZE), timed = viewOf(scene, TIMED_SIZE);
    const FloatImage truth = oracle::render(scene.truth(), cameraOf(judged));
    const support::Mask away =
        support::coveredPixels(oracle::awayFromSilhouettes(scene.truth(), cameraOf(judged)));
    support::savePicture(truth, "vtk_merge_oracle");

    support::SceneRenderer ours(scene.root(), timed), oursJudged(scene.root(), judged);
    VtkScene vtk(*voxels, timed), vtkJudged(*voxels, judged);
    for (const double step : {4.0, 2.0, 1.0, 0.5, 0.25}) {
        scene.setPeriod(step);
        vtk.setStep(step);
        vtkJudged.setStep(step);
        Times ourTimes, vtkTimes;
        for (int i = -1; i < frames; ++i) { // the first of each compiles
            Times warming;
            (i < 0 ? warming : ourTimes).add([&] { ours.render(); });
            (i < 0 ? warming : vtkTimes).add([&] { vtk.frame(); });
        }
        const FloatImage ourPicture = oursJudged.render();
        vtkJudged.frame();
        const FloatImage vtkPicture = vtkJudged.picture();
        print("osgVolumizer", step, support::compare(ourPicture, truth, away).rmse, ourTimes);
        print("VTK", step, support::compare(vtkPicture, truth, away).rmse, vtkTimes);
        support::savePicture(vtkPicture, "vtk_merge_vtk");
        support::savePicture(ourPicture, "vtk_merge_ours");
    }
}
