#include "Scene.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

namespace osgVolumizer {
namespace oracle {

std::vector<core::Plane> boxRegion(const core::Box3d& box)
{
    std::vector<core::Plane> planes;
    for (int a = 0; a < 3; ++a) {
        glm::dvec3 n(0.0);
        n[a] = 1.0;
        planes.push_back({n, -box.min[a]});
        planes.push_back({-n, box.max[a]});
    }
    return planes;
}

std::vector<core::Plane> tetraRegion(const std::array<glm::dvec3, 4>& corners)
{
    std::vector<core::Plane> planes;
    for (int i = 0; i < 4; ++i) {
        const glm::dvec3 &a = corners[(i + 1) % 4], &b = corners[(i + 2) % 4],
                         &c = corners[(i + 3) % 4];
        glm::dvec3 n = glm::cross(b - a, c - a);
        const double volume = glm::dot(n, corners[i] - a);
        if (volume == 0.0) return {{glm::dvec3(0.0), -1.0}};
        if (volume < 0.0) n = -n;
        planes.push_back({n, -glm::dot(n, a)});
    }
    return planes;
}

glm::dmat4 tetraMap(const std::array<glm::dvec3, 4>& from, const std::array<glm::dvec3, 4>& to)
{
    const glm::dmat3 a(from[1] - from[0], from[2] - from[0], from[3] - from[0]);
    const glm::dmat3 b(to[1] - to[0], to[2] - to[0], to[3] - to[0]);
    const glm::dmat3 linear = b * glm::inverse(a);
    glm::dmat4 map(linear);
    map[3] = glm::dvec4(to[0] - linear * from[0], 1.0);
    return map;
}

Volume boxVolume(std::shared_ptr<const Field> field, const core::Box3d& box, const Table& table,
                 double unit)
{
    Volume v;
    v.region = boxRegion(box);
    v.field = std::move(field);
    v.table = table;
    v.unit = unit;
    return v;
}

Volume voxelVolume(std::shared_ptr<const Field> field, const glm::ivec3& size, const Table& table,
                   const glm::dvec3& spacing, const glm::dvec3& origin)
{
    core::Box3d box;
    box.expand(origin);
    box.expand(origin + spacing * glm::dvec3(size - 1));
    Volume v = boxVolume(std::move(field), box, table, (spacing.x + spacing.y + spacing.z) / 3.0);
    for (int a = 0; a < 3; ++a) {
        v.objectToField[a][a] = 1.0 / spacing[a];
        v.objectToField[3][a] = -origin[a] / spacing[a];
    }
    return v;
}

void classifySamples(Volume& volume, const Grid& samples, Grid::Interpolation how)
{
    for (int c = 0; c < 4; ++c) {
        std::vector<double> values;
        for (double v : samples.samples()) {
            const glm::dvec4 color = volume.table.color(v);
            const double extinction = Table::extinction(color.a);
            values.push_back(c == 3 ? extinction : extinction * color[c]);
        }
        volume.medium[std::size_t(c)] = std::make_shared<Grid>(samples.size(), values, how);
    }
}

void Scene::addMesh(const std::vector<glm::vec3>& points,
                    const std::vector<std::array<unsigned, 3>>& corners, const glm::dvec4& color,
                    bool opaque)
{
    const int surface = triangles.empty() ? 1 : triangles.back().surface + 1;
    for (const auto& numbers : corners) {
        Triangle t;
        for (std::size_t i = 0; i < 3; ++i)
            t.corner[i] = glm::dvec3(points[numbers[i]]);
        t.color = {color, color, color};
        t.opaque = opaque;
        t.surface = surface;
        triangles.push_back(t);
    }
}

void Scene::addQuad(const std::array<glm::dvec3, 4>& corners, const glm::dvec4& color, bool opaque)
{
    const int surface = triangles.empty() ? 1 : triangles.back().surface + 1;
    for (int i = 1; i < 3; ++i) {
        Triangle t;
        t.corner = {corners[0], corners[i], corners[i + 1]};
        t.color = {color, color, color};
        t.opaque = opaque;
        t.surface = surface;
        triangles.push_back(t);
    }
}

} // namespace oracle
} // namespace osgVolumizer
