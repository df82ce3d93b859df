#include "ScreenTriangles.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace oracle {

namespace {

constexpr double MARGIN = 1.0; // pixels, for rounding and for rays a little outside of the window

// Window box of a triangle; false where a corner is not in front of the eye.
bool windowBox(const Triangle& triangle, const Camera& camera, glm::dvec2& low, glm::dvec2& high)
{
    const glm::dmat4 toClip = camera.projection * camera.view;
    low = glm::dvec2(INFINITY);
    high = -low;
    for (const glm::dvec3& corner : triangle.corner) {
        const glm::dvec4 clip = toClip * glm::dvec4(corner, 1.0);
        if (!(clip.w > 1e-9 * (std::abs(clip.x) + std::abs(clip.y)))) return false;
        const glm::dvec2 window =
            (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(camera.width, camera.height);
        low = glm::min(low, window - MARGIN);
        high = glm::max(high, window + MARGIN);
    }
    return true;
}

int tileOf(double pixel, int tileSize, int count)
{
    return static_cast<int>(std::clamp(std::floor(pixel / tileSize), 0.0, count - 1.0));
}

} // namespace

ScreenTriangles::ScreenTriangles(const Scene& scene, const Camera& camera)
    : _width(camera.width), _height(camera.height), _columns((camera.width + TILE - 1) / TILE),
      _rows((camera.height + TILE - 1) / TILE), _tiles(std::size_t(_columns) * _rows)
{
    const glm::dvec2 window(camera.width, camera.height);
    for (const Triangle& triangle : scene.triangles) {
        _all.push_back(&triangle);
        glm::dvec2 low, high;
        if (!windowBox(triangle, camera, low, high)) {
            low = glm::dvec2(0.0);
            high = window;
        }
        if (high.x < 0.0 || high.y < 0.0 || low.x > window.x || low.y > window.y) continue;
        for (int y = tileOf(low.y, TILE, _rows); y <= tileOf(high.y, TILE, _rows); ++y)
            for (int x = tileOf(low.x, TILE, _columns); x <= tileOf(high.x, TILE, _columns); ++x)
                _tiles[std::size_t(y) * _columns + x].push_back(&triangle);
    }
}

const ScreenTriangles::List& ScreenTriangles::at(double x, double y) const
{
    const bool near = x > -MARGIN && y > -MARGIN && x < _width + MARGIN && y < _height + MARGIN;
    if (!near) return _all;
    return _tiles[std::size_t(tileOf(y, TILE, _rows)) * _columns + tileOf(x, TILE, _columns)];
}

} // namespace oracle
} // namespace osgVolumizer
