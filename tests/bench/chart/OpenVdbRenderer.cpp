#include "Renderer.h"

#include <support/OracleView.h>

#include <openvdb/openvdb.h>
#include <openvdb/tools/RayIntersector.h>
#include <openvdb/tools/RayTracer.h>

#include <glm/matrix.hpp>

#include <algorithm>
#include <optional>

namespace osgVolumizer {
namespace bench {

namespace {

// Samples thinner than this are skipped, and rays end where less than 6e-5 would be seen of what
// lies behind.
constexpr double CUT_OFF = 1e-8;

openvdb::Vec3d toVdb(const glm::dvec3& v)
{
    return {v.x, v.y, v.z};
}

/// VolumeRender asks at every sample what a ray to the light meets, and has no way to be told that
/// there is no shadow. Here the light is behind the eye, and rays to it meet nothing.
class WithoutShadow : public openvdb::tools::VolumeRayIntersector<openvdb::FloatGrid>
{
public:
    using Base = openvdb::tools::VolumeRayIntersector<openvdb::FloatGrid>;

    WithoutShadow(const openvdb::FloatGrid& grid, const openvdb::CoordBBox& box,
                  const openvdb::Vec3d& toLight)
        : Base(grid, box), _toLight(toLight)
    {
    }

    bool setWorldRay(const RayType& ray)
    {
        _isToLight = ray.dir().dot(_toLight) > 0.0;
        return _isToLight || Base::setWorldRay(ray);
    }
    template <class Spans>
    void hits(Spans& spans)
    {
        if (_isToLight)
            spans.clear();
        else
            Base::hits(spans);
    }

private:
    openvdb::Vec3d _toLight;
    bool _isToLight = false;
};

using Tracer = openvdb::tools::VolumeRender<WithoutShadow>;

std::optional<glm::dvec3> onlyColor(const ChartVolume& volume)
{
    const glm::dvec3 color(volume.table.front().color);
    for (const auto& point : volume.table)
        if (glm::dvec3(point.color) != color) return {};
    return color;
}

/// OpenVDB's VolumeRender: rays through a medium that scatters the light of one lamp, and knows no
/// table. Where all scatters and nothing else absorbs, and no light is lost on its way from the
/// lamp, that is emission and absorption of one colour. The grid is of extinctions, so that what is
/// interpolated is the table's result; in a table whose extinction is proportional to the value
/// that is the same. All threads draw.
///
/// Its error: samples lie at multiples of the step from the eye, and each counts for a whole step,
/// also where a ray enters and leaves the box.
class OpenVdbRenderer : public Renderer
{
public:
    std::string name() const override { return "OpenVDB VolumeRender"; }
    Status open(const ChartScene& scene) override;
    Status setStep(double stepVoxel) override
    {
        _tracer->setPrimaryStep(stepVoxel);
        return {};
    }
    void frame() override { _tracer->render(); }
    support::FloatImage picture() override;

private:
    void makeGrid(const ChartVolume& volume, const core::TransferFunction& function);
    void makeCamera(const support::RenderOptions& view);
    void makeTracer(const ChartVolume& volume, const support::RenderOptions& view,
                    const glm::dvec3& color);

    openvdb::FloatGrid::Ptr _extinctions;
    std::unique_ptr<openvdb::tools::Film> _film;
    std::unique_ptr<openvdb::tools::BaseCamera> _camera;
    std::unique_ptr<WithoutShadow> _rays; ///< which the tracer has copies of that share its tree
    std::unique_ptr<Tracer> _tracer;
};

void OpenVdbRenderer::makeGrid(const ChartVolume& volume, const core::TransferFunction& function)
{
    _extinctions = openvdb::FloatGrid::create();
    _extinctions->setTransform(openvdb::math::Transform::createLinearTransform());
    _extinctions->transform().postTranslate(toVdb(volume.origin));
    auto accessor = _extinctions->getAccessor();
    const std::vector<double> values = volume.values();
    const double* value = values.data();
    for (int z = 0; z < volume.size.z; ++z)
        for (int y = 0; y < volume.size.y; ++y)
            for (int x = 0; x < volume.size.x; ++x) {
                const double fraction =
                    (*value++ - volume.range.x) / (volume.range.y - volume.range.x);
                const double opacity = function.evaluate(fraction).a;
                accessor.setValue({x, y, z}, float(core::extinctionFromOpacity(opacity)));
            }
}

// Without an offset of the picture's centre.
void OpenVdbRenderer::makeCamera(const support::RenderOptions& view)
{
    _film = std::make_unique<openvdb::tools::Film>(view.width, view.height);
    const glm::dmat4 toWorld = glm::inverse(support::toGlm(view.view));
    const openvdb::Vec3d eye = toVdb(toWorld[3]), noRotation(0.0);
    const double width = 2.0 / view.projection(0, 0);
    if (view.projection(3, 3) == 0.0)
        _camera = std::make_unique<openvdb::tools::PerspectiveCamera>(*_film, noRotation, eye, 1.0,
                                                                      width);
    else
        _camera =
            std::make_unique<openvdb::tools::OrthographicCamera>(*_film, noRotation, eye, width);
    _camera->lookAt(eye - toVdb(toWorld[2]), toVdb(toWorld[1]));
}

void OpenVdbRenderer::makeTracer(const ChartVolume& volume, const support::RenderOptions& view,
                                 const glm::dvec3& color)
{
    const openvdb::Vec3d toLight = toVdb(glm::inverse(support::toGlm(view.view))[2]);
    const openvdb::Coord last(volume.size.x - 1, volume.size.y - 1, volume.size.z - 1);
    const openvdb::CoordBBox box(openvdb::Coord(0), last);
    _rays = std::make_unique<WithoutShadow>(*_extinctions, box, toLight);
    _tracer = std::make_unique<Tracer>(*_rays, *_camera);
    _tracer->setLightDir(toLight.x(), toLight.y(), toLight.z());
    _tracer->setLightColor(color.r, color.g, color.b);
    _tracer->setScattering(1.0, 1.0, 1.0);
    _tracer->setAbsorption(0.0, 0.0, 0.0);
    _tracer->setCutOff(CUT_OFF);
}

Status OpenVdbRenderer::open(const ChartScene& scene)
{
    if (scene.shaded) return Status(ErrorCode::NOT_SUPPORTED, "has no shading");
    if (!scene.isOneVolume()) return Status(ErrorCode::NOT_SUPPORTED, "draws one volume");
    const ChartVolume& volume = scene.volumes.front();
    const auto color = onlyColor(volume);
    if (!color) return Status(ErrorCode::NOT_SUPPORTED, "knows no table, but one colour");
    const auto function = core::TransferFunction::create(volume.table);
    if (!function.ok()) return function.status;
    openvdb::initialize();
    makeGrid(volume, *function);
    makeCamera(scene.view);
    makeTracer(volume, scene.view, *color);
    return {};
}

// The film's first row is the top one.
support::FloatImage OpenVdbRenderer::picture()
{
    const int width = int(_film->width()), height = int(_film->height());
    support::FloatImage image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto& p = _film->pixel(std::size_t(x), std::size_t(height - 1 - y));
            image.pixels[std::size_t(y) * std::size_t(width) + std::size_t(x)] = {p.r, p.g, p.b,
                                                                                  p.a};
        }
    return image;
}

} // namespace

RendererPtr makeOpenVdbRenderer()
{
    return std::make_unique<OpenVdbRenderer>();
}

} // namespace bench
} // namespace osgVolumizer
