#include "VtkWindow.h"

#include <vtkCamera.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkOpenGLState.h>

#include <vtkAutoInit.h>
VTK_MODULE_INIT(vtkRenderingOpenGL2)
VTK_MODULE_INIT(vtkRenderingVolumeOpenGL2)

#include <GL/gl.h>
#include <GL/glx.h>
#undef Status // of X11

#include <cmath>
#include <cstdlib>

namespace osgVolumizer {
namespace bench {

VtkWindow::~VtkWindow()
{
    if (!_window) return;
    _window->MakeCurrent();
    _window->Finalize();
}

Status VtkWindow::open(int width, int height)
{
    if (!std::getenv("DISPLAY")) return Status(ErrorCode::NOT_SUPPORTED, "needs an X server");
    _width = width;
    _height = height;
    _window = vtkSmartPointer<vtkRenderWindow>::New();
    _renderer = vtkSmartPointer<vtkRenderer>::New();
    _window->SetOffScreenRendering(1);
    _window->SetMultiSamples(0);
    _window->SetSize(width, height);
    _window->AddRenderer(_renderer);
    _window->SetAlphaBitPlanes(1); // for peeling
    _renderer->SetBackground(0.0, 0.0, 0.0);
    _renderer->SetBackgroundAlpha(0.0);
    return {};
}

void VtkWindow::setView(const support::RenderOptions& view)
{
    osg::Vec3d eye, center, up;
    view.view.getLookAt(eye, center, up);
    vtkCamera* camera = _renderer->GetActiveCamera();
    camera->SetPosition(eye.x(), eye.y(), eye.z());
    camera->SetFocalPoint(center.x(), center.y(), center.z());
    camera->SetViewUp(up.x(), up.y(), up.z());
    const osg::Matrixd& p = view.projection;
    if (p(3, 3) != 0.0) {
        camera->ParallelProjectionOn();
        camera->SetParallelScale(1.0 / p(1, 1)); // half the height
    } else {
        camera->SetViewAngle(2.0 * std::atan(1.0 / p(1, 1)) * 180.0 / M_PI);
    }
    _renderer->ResetCameraClippingRange();
    if (!_texture) makeFloatTarget();
    release();
}

// The window draws to a framebuffer of 8 bits, and copies that to the screen: here its colours
// get 32.
void VtkWindow::makeFloatTarget()
{
    _window->Render(); // makes the framebuffer
    auto* window = static_cast<vtkOpenGLRenderWindow*>(_window.Get());
    _texture = vtkSmartPointer<vtkTextureObject>::New();
    _texture->SetContext(window);
    _texture->Create2D(unsigned(_width), unsigned(_height), 4, VTK_FLOAT, false);
    window->GetState()->PushFramebufferBindings();
    window->GetRenderFramebuffer()->Bind();
    window->GetRenderFramebuffer()->AddColorAttachment(0, _texture);
    window->GetState()->PopFramebufferBindings();
}

void VtkWindow::frame()
{
    _window->Render();
    glFinish();
    release();
}

support::FloatImage VtkWindow::picture()
{
    support::FloatImage image(_width, _height);
    _window->MakeCurrent();
    glBindTexture(GL_TEXTURE_2D, _texture->GetHandle());
    glGetTexImage(GL_TEXTURE_2D, 0, GL_RGBA, GL_FLOAT, image.pixels.data());
    glBindTexture(GL_TEXTURE_2D, 0);
    release();
    return image;
}

void VtkWindow::release()
{
    if (Display* display = glXGetCurrentDisplay()) glXMakeCurrent(display, None, nullptr);
}

} // namespace bench
} // namespace osgVolumizer
