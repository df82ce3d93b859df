#include "TestMeshes.h"

#include <algorithm>
#include <random>

namespace osgVolumizer {
namespace oracle {
namespace {

using CellsOfPoints = std::vector<std::vector<std::uint32_t>>;

CellsOfPoints cellsOfPoints(const TetraMesh& mesh)
{
    CellsOfPoints cells(mesh.points.size());
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
        for (std::uint32_t point : mesh.cells[c])
            cells[point].push_back(std::uint32_t(c));
    return cells;
}

// Moves a point if no cell at it then has less than that fraction of its volume.
bool tryMove(TetraMesh& mesh, const std::vector<std::uint32_t>& cells, std::uint32_t point,
             const glm::dvec3& place, double fraction)
{
    std::vector<double> volumes;
    for (std::uint32_t c : cells)
        volumes.push_back(mesh.signedVolume(mesh.cells[c]));
    const glm::dvec3 before = mesh.points[point];
    mesh.points[point] = place;
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (mesh.signedVolume(mesh.cells[cells[i]]) < fraction * volumes[i]) {
            mesh.points[point] = before;
            return false;
        }
    return true;
}

// Of one cell: the corner that can be moved to flatten it.
bool flattenCell(TetraMesh& mesh, const TetraMesh::Cell& cell, const CellsOfPoints& cells,
                 const std::vector<bool>& fixed, double flatness)
{
    const glm::dvec3 sum =
        mesh.corner(cell, 0) + mesh.corner(cell, 1) + mesh.corner(cell, 2) + mesh.corner(cell, 3);
    for (std::uint32_t point : cell) {
        if (fixed[point]) continue;
        const glm::dvec3 opposite = (sum - mesh.points[point]) / 3.0;
        const glm::dvec3 place = opposite + flatness * (mesh.points[point] - opposite);
        if (tryMove(mesh, cells[point], point, place, 0.99 * flatness)) return true;
    }
    return false;
}

} // namespace

std::vector<bool> boundaryPoints(const TetraMesh& mesh)
{
    std::vector<std::array<std::uint32_t, 3>> faces;
    for (const TetraMesh::Cell& cell : mesh.cells)
        for (std::size_t i = 0; i < 4; ++i) {
            std::array<std::uint32_t, 3> face{cell[(i + 1) % 4], cell[(i + 2) % 4],
                                              cell[(i + 3) % 4]};
            std::sort(face.begin(), face.end());
            faces.push_back(face);
        }
    std::sort(faces.begin(), faces.end());
    std::vector<bool> boundary(mesh.points.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
        const bool shared = (i > 0 && faces[i - 1] == faces[i]) ||
                            (i + 1 < faces.size() && faces[i + 1] == faces[i]);
        if (shared) continue;
        for (std::uint32_t point : faces[i])
            boundary[point] = true;
    }
    return boundary;
}

void jitter(TetraMesh& mesh, double amount, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> offset(-amount, amount);
    const std::vector<bool> fixed = boundaryPoints(mesh);
    const CellsOfPoints cells = cellsOfPoints(mesh);
    for (std::uint32_t point = 0; point < mesh.points.size(); ++point) {
        const double x = offset(random), y = offset(random), z = offset(random);
        const glm::dvec3 place = mesh.points[point];
        glm::dvec3 move(x, y, z);
        for (int attempt = 0; attempt < 8 && !fixed[point]; ++attempt, move *= 0.5)
            if (tryMove(mesh, cells[point], point, place + move, 0.1)) break;
    }
}

std::size_t flatten(TetraMesh& mesh, double fraction, double flatness, unsigned seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> chance(0.0, 1.0);
    std::vector<bool> fixed = boundaryPoints(mesh);
    const CellsOfPoints cells = cellsOfPoints(mesh);
    std::size_t made = 0;
    for (const TetraMesh::Cell& cell : mesh.cells) {
        if (chance(random) >= fraction || !flattenCell(mesh, cell, cells, fixed, flatness))
            continue;
        ++made;
        for (std::uint32_t point : cell) // keeps the sliver as it is
            fixed[point] = true;
    }
    return made;
}

} // namespace oracle
} // namespace osgVolumizer
