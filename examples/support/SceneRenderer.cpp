#include "SceneRenderer.h"

#include <osg/DisplaySettings>
#include <osg/Math>

#include <algorithm>
#include <chrono>
#include <cmath>

namespace osgVolumizer {
namespace support {
namespace {

const std::string counterPrefix = "osgVolumizer ";

void appendCounters(osg::Stats* stats, unsigned frame, std::map<std::string, double>& counters)
{
    if (!stats) return;
    for (const auto& attribute : stats->getAttributeMap(frame))
        if (attribute.first.compare(0, counterPrefix.size(), counterPrefix) == 0)
            counters[attribute.first] = attribute.second;
}

} // namespace

double fieldOfViewOfViewers()
{
    const osg::DisplaySettings& screen = *osg::DisplaySettings::instance();
    return osg::RadiansToDegrees(
        2.0 * std::atan(0.5 * screen.getScreenHeight() / screen.getScreenDistance()));
}

RenderOptions& RenderOptions::size(int w, int h)
{
    width = w;
    height = h;
    return *this;
}

RenderOptions& RenderOptions::lookAt(const osg::Vec3d& eye, const osg::Vec3d& center,
                                     const osg::Vec3d& up)
{
    view.makeLookAt(eye, center, up);
    return *this;
}

RenderOptions& RenderOptions::perspective(double fovyDegrees)
{
    projection.makePerspective(fovyDegrees, double(width) / height, 1.0, 10000.0);
    return *this;
}

RenderOptions& RenderOptions::orthographic(double halfHeight)
{
    const double halfWidth = halfHeight * width / height;
    projection.makeOrtho(-halfWidth, halfWidth, -halfHeight, halfHeight, 1.0, 10000.0);
    return *this;
}

RenderOptions& RenderOptions::frameScene(const osg::BoundingSphere& bound)
{
    const double radius = bound.valid() && bound.radius() > 0.0f ? bound.radius() : 1.0;
    const osg::Vec3d center = bound.valid() ? osg::Vec3d(bound.center()) : osg::Vec3d();
    // Off the far plane by half a radius at least, also in orthographic views.
    double distance = 1.5 * radius;
    if (projection(3, 3) == 0.0) {
        const double tangent = std::min(1.0 / projection(0, 0), 1.0 / projection(1, 1));
        distance = std::max(distance, radius / std::sin(std::atan(tangent)));
    }
    return lookAt(center - osg::Vec3d(0.0, distance, 0.0), center, osg::Vec3d(0.0, 0.0, 1.0));
}

SceneRenderer::SceneRenderer(osg::Node* scene, const RenderOptions& options)
    : _options(options), _context(new SurfacelessGraphicsContext(options.width, options.height,
                                                                 options.profile, options.device)),
      _viewer(new osgViewer::Viewer)
{
    _status = _context->status();

    osg::Camera* camera = _viewer->getCamera();
    camera->setGraphicsContext(_context.get());
    camera->setProjectionResizePolicy(osg::Camera::FIXED);
    _target = new PictureTarget(*camera, *_context, options.width, options.height, options.format);
    camera->getStats()->collectStats("osgVolumizer", true);
    _viewer->getViewerStats()->collectStats("osgVolumizer", true);

    _viewer->setLightingMode(options.light ? osg::View::HEADLIGHT : osg::View::NO_LIGHT);
    _viewer->setThreadingModel(options.threading);
    _viewer->setKeyEventSetsDone(0);
    _viewer->setSceneData(scene);
    applyView();
    if (_options.prepare) _options.prepare(*_viewer);
    if (_status.ok()) _viewer->realize();
}

SceneRenderer::~SceneRenderer()
{
    _viewer->stopThreading();
}

void SceneRenderer::applyView()
{
    osg::Camera* camera = _viewer->getCamera();
    camera->setViewMatrix(_options.view);
    camera->setProjectionMatrix(_options.projection);
    camera->setClearColor(_options.background);
    camera->setComputeNearFarMode(_options.computeNearFar
                                      ? osg::CullSettings::COMPUTE_NEAR_FAR_USING_BOUNDING_VOLUMES
                                      : osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
}

FloatImage SceneRenderer::render()
{
    _milliseconds.clear();
    if (!_status.ok()) return FloatImage();
    applyView();
    const unsigned frames = std::max(1u, _options.frames);
    _target->request(frames, _options.depth);
    const bool overlapping = _options.threading != osgViewer::ViewerBase::SingleThreaded;
    for (unsigned i = 1; i <= frames; ++i) {
        const auto start = std::chrono::steady_clock::now();
        _viewer->frame(_options.time);
        if (!overlapping && !_target->waitForFrames(i)) break;
        const std::chrono::duration<double, std::milli> time =
            std::chrono::steady_clock::now() - start;
        _milliseconds.push_back(time.count());
    }
    FloatImage image = _target->wait();
    if (image.empty()) _status = Status(ErrorCode::NOT_SUPPORTED, "No frame was drawn.");
    return image;
}

std::map<std::string, double> SceneRenderer::counters() const
{
    std::map<std::string, double> result;
    const unsigned frame = _viewer->getFrameStamp()->getFrameNumber();
    appendCounters(_viewer->getViewerStats(), frame, result);
    appendCounters(_viewer->getCamera()->getStats(), frame, result);
    return result;
}

FloatImage renderCoverage(SceneRenderer& renderer)
{
    const osg::Vec4 asked = renderer.options().background;
    renderer.options().frames = 1;
    const auto over = [&renderer](const osg::Vec4& background) {
        renderer.options().background = background;
        return renderer.render();
    };
    const bool opaque = asked.a() >= 1.0f;
    FloatImage image = over(opaque ? asked : osg::Vec4(0, 0, 0, 1));
    const FloatImage white = opaque ? image : over(osg::Vec4(1, 1, 1, 1));
    renderer.options().background = asked;
    if (white.pixels.size() != image.pixels.size()) return FloatImage();
    const glm::vec4 behind(asked.r(), asked.g(), asked.b(), asked.a());
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        glm::vec4& p = image.pixels[i];
        const glm::vec4 through = white.pixels[i] - p;
        const float left =
            opaque ? 0.0f : std::clamp((through.r + through.g + through.b) / 3.0f, 0.0f, 1.0f);
        p.a = 1.0f - left;
        if (!opaque) p += left * behind;
    }
    return image;
}

FloatImage renderScene(osg::Node* scene, const RenderOptions& options)
{
    SceneRenderer renderer(scene, options);
    return renderer.render();
}

} // namespace support
} // namespace osgVolumizer
