#include "ForEachPixel.h"
#include "Quadrature.h"
#include "Ray.h"
#include "ScreenTriangles.h"

#include <algorithm>
#include <set>

namespace osgVolumizer {
namespace oracle {
namespace {

/// Everything that a ray meets, front to back.
struct Path
{
    std::vector<Crossing> crossings;
    std::vector<Hit> hits;
};

Path meet(const Scene& scene, const ScreenTriangles& triangles, const Camera& camera, double x,
          double y)
{
    Path path;
    const Ray ray = rayThrough(camera, x, y);
    for (const Triangle* triangle : triangles.at(x, y)) {
        Hit h;
        if (hit(ray, camera, *triangle, h)) path.hits.push_back(h);
    }
    std::stable_sort(path.hits.begin(), path.hits.end(),
                     [](const Hit& a, const Hit& b) { return a.depth < b.depth; });
    Camera bounded = camera;
    const auto end = std::find_if(path.hits.begin(), path.hits.end(),
                                  [](const Hit& h) { return h.triangle->opaque; });
    if (end != path.hits.end()) {
        bounded.farDepth = end->depth;
        path.hits.erase(end + 1, path.hits.end());
    }
    for (const Volume& volume : scene.volumes) {
        Crossing c;
        if (cross(ray, bounded, volume, c)) path.crossings.push_back(c);
    }
    return path;
}

// Depths between which the medium is smooth and no triangle is hit.
std::vector<double> cuts(const Path& path)
{
    std::vector<double> depths;
    for (const Hit& h : path.hits)
        depths.push_back(h.depth);
    for (const Crossing& c : path.crossings) {
        depths.push_back(c.enter);
        depths.push_back(c.leave);
        c.volume->field->appendBreaks(c.fieldOrigin, c.fieldDirection, c.enter, c.leave,
                                      c.volume->table.knots(), depths);
    }
    std::sort(depths.begin(), depths.end());
    depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
    return depths;
}

Medium mediumOf(const Crossing& c, double depth)
{
    const glm::dvec3 place = c.fieldOrigin + depth * c.fieldDirection;
    if (c.volume->medium[3]) {
        const double scale = c.objectLength / c.volume->unit;
        Medium m;
        // Interpolants may overshoot; below nothing there is nothing.
        m.extinction = std::max(0.0, c.volume->medium[3]->value(place)) * scale;
        for (int i = 0; i < 3 && m.extinction > 0.0; ++i)
            m.emission[i] = std::max(0.0, c.volume->medium[std::size_t(i)]->value(place)) * scale;
        return m;
    }
    const double value = c.volume->field->value(place);
    const glm::dvec4 color = c.volume->table.color(value);
    Medium m;
    m.extinction = Table::extinction(color.a) * c.objectLength / c.volume->unit;
    glm::dvec3 rgb(color);
    if (c.volume->shade) rgb = c.volume->shade(rgb, place, c.eyeOrigin + depth * c.eyeDirection);
    m.emission = m.extinction * rgb;
    return m;
}

glm::dvec3 paintOf(const Crossing& c, double depth)
{
    const double value = c.volume->field->value(c.fieldOrigin + depth * c.fieldDirection);
    const glm::dvec4 color = c.volume->table.color(value);
    return 1.0 - color.a + color.a * glm::dvec3(color);
}

void integratePiece(const std::vector<const Crossing*>& active, double t0, double t1,
                    double tolerance, Light& light)
{
    if (active.empty()) return;
    if (active.size() == 1) {
        if (active[0]->volume->paint) return;
        integrate([c = active[0]](double t) { return mediumOf(*c, t); }, t0, t1, tolerance, light);
        return;
    }
    const auto sum = [&active](double t) {
        Medium total;
        glm::dvec3 paint(1.0);
        for (const Crossing* c : active) {
            if (c->volume->paint) {
                paint *= paintOf(*c, t);
                continue;
            }
            const Medium m = mediumOf(*c, t);
            total.extinction += m.extinction;
            total.emission += m.emission;
        }
        total.emission *= paint;
        return total;
    };
    integrate(sum, t0, t1, tolerance, light);
}

void blend(const Hit& h, Light& light)
{
    const double alpha = h.triangle->opaque ? 1.0 : h.color.a;
    light.color += light.transmittance * alpha * glm::dvec3(h.color);
    light.transmittance *= 1.0 - alpha;
}

// The volumes and the numbers of the surfaces that are met: neighbouring rays that meet the same
// cross no silhouette.
std::set<std::pair<const Volume*, int>> silhouetteKey(const Path& path)
{
    std::set<std::pair<const Volume*, int>> key;
    for (const Crossing& c : path.crossings)
        key.emplace(c.volume, 0);
    for (const Hit& h : path.hits)
        key.emplace(nullptr, h.triangle->surface);
    return key;
}

// Light along what a ray meets, over the background.
glm::dvec4 lightOf(const Path& path, const Scene& scene)
{
    const std::vector<double> depths = cuts(path);
    Light light;
    auto nextHit = path.hits.begin();
    std::vector<const Crossing*> active;
    for (std::size_t i = 0; i < depths.size(); ++i) {
        for (; nextHit != path.hits.end() && nextHit->depth <= depths[i]; ++nextHit)
            blend(*nextHit, light);
        if (i + 1 == depths.size()) break;
        const double middle = 0.5 * (depths[i] + depths[i + 1]);
        active.clear();
        for (const Crossing& c : path.crossings)
            if (c.enter < middle && middle < c.leave) active.push_back(&c);
        integratePiece(active, depths[i], depths[i + 1], scene.tolerance, light);
    }
    return glm::dvec4(light.color, 1.0 - light.transmittance) +
           light.transmittance * scene.background;
}

} // namespace

glm::dvec4 trace(const Scene& scene, const Camera& camera, double x, double y)
{
    return lightOf(meet(scene, ScreenTriangles(scene, camera), camera, x, y), scene);
}

support::FloatImage render(const Scene& scene, const Camera& camera)
{
    const ScreenTriangles triangles(scene, camera);
    return forEachPixel(camera.width, camera.height, [&](int x, int y) {
        return lightOf(meet(scene, triangles, camera, x + 0.5, y + 0.5), scene);
    });
}

support::FloatImage awayFromSilhouettes(const Scene& scene, const Camera& camera, double margin)
{
    const ScreenTriangles triangles(scene, camera);
    const auto keyAt = [&](double x, double y) {
        return silhouetteKey(meet(scene, triangles, camera, x, y));
    };
    return forEachPixel(camera.width, camera.height, [&](int column, int row) {
        const double x = column + 0.5, y = row + 0.5;
        const auto key = keyAt(x, y);
        for (int corner = 0; corner < 4; ++corner) {
            const double u = x + (corner & 1 ? margin : -margin);
            const double v = y + (corner & 2 ? margin : -margin);
            if (keyAt(u, v) != key) return glm::dvec4(0.0);
        }
        return glm::dvec4(0.0, 0.0, 0.0, 1.0);
    });
}

} // namespace oracle
} // namespace osgVolumizer
