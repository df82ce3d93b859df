#pragma once

#include <osgVolumizer/core/Status.h>

#include <support/SceneRenderer.h>

#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkTextureObject.h>

namespace osgVolumizer {
namespace bench {

/// A hidden window of VTK that draws to a float target of ours. It needs an X server (Xvfb will
/// do). Its context is current only within calls: other renderers make contexts of EGL current in
/// the same thread.
class VtkWindow
{
public:
    VtkWindow() = default;
    ~VtkWindow();
    VtkWindow(const VtkWindow&) = delete;
    VtkWindow& operator=(const VtkWindow&) = delete;

    /// NOT_SUPPORTED where there is no display.
    Status open(int width, int height);
    /// Where volumes and actors go. Expects open().
    vtkRenderer& renderer() { return *_renderer; }
    /// Over transparent black. The first call draws a frame, and makes the target after it: expects
    /// what is to be drawn in place.
    void setView(const support::RenderOptions& view);
    /// Draws, to the end of glFinish.
    void frame();
    /// What the last frame drew: premultiplied, bottom row first.
    support::FloatImage picture();

private:
    void makeFloatTarget();
    static void release();

    int _width = 0;
    int _height = 0;
    vtkSmartPointer<vtkRenderWindow> _window;
    vtkSmartPointer<vtkRenderer> _renderer;
    vtkSmartPointer<vtkTextureObject> _texture;
};

} // namespace bench
} // namespace osgVolumizer
