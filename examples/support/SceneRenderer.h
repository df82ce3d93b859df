#pragma once

#include "FloatImage.h"
#include "PictureTarget.h"
#include "SurfacelessGraphicsContext.h"

#include <osgViewer/Viewer>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace support {

/// Vertical field of view that OSG's viewers begin with, in degrees.
double fieldOfViewOfViewers();

/// How a scene is looked at, and what is rendered to.
struct RenderOptions
{
    int width = 256;
    int height = 256;
    osg::Matrixd view;       ///< world to eye, looking down -z
    osg::Matrixd projection; ///< near and far are moved to the scene while computeNearFar
    osg::Vec4 background{0.0f, 0.0f, 0.0f, 0.0f};
    unsigned frames = 1; ///< the picture is the last one's
    double time = 0.0;   ///< simulation time of all frames, seconds
    osgViewer::ViewerBase::ThreadingModel threading = osgViewer::ViewerBase::SingleThreaded;
    PictureTarget::Format format = PictureTarget::FLOAT32;
    OffscreenContext::Profile profile = OffscreenContext::COMPATIBILITY;
    std::optional<int> device; ///< EGL's of this number, in place of OffscreenDisplay's default
    bool depth = false;        ///< also read the depth buffer
    bool light = false;        ///< OSG's head light
    bool computeNearFar = true;
    /// Called once, before the first frame: for what is to be attached to camera or context.
    std::function<void(osgViewer::Viewer&)> prepare;

    RenderOptions() { perspective(30.0); }
    RenderOptions& size(int w, int h);
    RenderOptions& lookAt(const osg::Vec3d& eye, const osg::Vec3d& center, const osg::Vec3d& up);
    /// Vertical field of view in degrees, at the present size's aspect ratio.
    RenderOptions& perspective(double fovyDegrees);
    /// Half the height of the view, in world units, at the present size's aspect ratio.
    RenderOptions& orthographic(double halfHeight);
    /// Looks along +y, z up, from where the bounding sphere fits the view.
    RenderOptions& frameScene(const osg::BoundingSphere& bound);
};

/// Renders a scene frame by frame in one context of its own, which lives as long as the renderer:
/// the second frame finds what the first one cached. Cameras of the scene find a window.
class SceneRenderer
{
public:
    SceneRenderer(osg::Node* scene, const RenderOptions& options);
    ~SceneRenderer();

    /// Not ok where there is no GL, or a frame did not finish.
    const Status& status() const { return _status; }
    /// Renders options().frames frames; the last one's picture, empty on failure.
    FloatImage render();
    /// May be changed between calls of render(); size, format, profile, device and threading stay
    /// as they were.
    RenderOptions& options() { return _options; }
    osgViewer::Viewer& viewer() { return *_viewer; }

    /// Milliseconds of each frame of the last render(), from the update traversal to the end of
    /// glFinish. Frames of the multi-threaded models overlap, and their times mean nothing.
    const std::vector<double>& milliseconds() const { return _milliseconds; }
    /// Attributes of the last frame in the statistics of camera and viewer whose names start with
    /// "osgVolumizer ". Collection is always on.
    std::map<std::string, double> counters() const;
    /// Which device draws; of no name where there is no GL.
    const DrawingDevice& device() const { return _context->device(); }
    /// The first GL error met at the end of a frame, or 0.
    unsigned glError() const { return _target->glError(); }

private:
    void applyView();

    RenderOptions _options;
    Status _status;
    osg::ref_ptr<SurfacelessGraphicsContext> _context;
    osg::ref_ptr<osgViewer::Viewer> _viewer;
    osg::ref_ptr<PictureTarget> _target;
    std::vector<double> _milliseconds;
};

/// A frame over options().background, with alpha for how much of what is behind is covered,
/// whatever blend functions the scene has: they also blend alpha, and most do so such that it means
/// nothing. Drawn over black and over white, if the background is not opaque: what of white comes
/// through is not covered. Exact where blending is linear in what is behind.
FloatImage renderCoverage(SceneRenderer& renderer);

/// One picture of a scene; empty where there is no GL.
FloatImage renderScene(osg::Node* scene, const RenderOptions& options);

} // namespace support
} // namespace osgVolumizer
