#include "TestMeshes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <utility>

namespace osgVolumizer {
namespace oracle {
namespace {

// Corner c of a hexahedron: bit 0 of c is x, bit 1 is y, bit 2 is z.
constexpr std::uint32_t FIVE_CELLS[5][4] = {
    {0, 1, 2, 4}, {3, 1, 2, 7}, {5, 1, 4, 7}, {6, 2, 4, 7}, {1, 2, 4, 7}};
constexpr std::uint32_t SIX_CELLS[6][4] = {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7},
                                           {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}};

void appendCell(TetraMesh& mesh, TetraMesh::Cell cell)
{
    if (mesh.signedVolume(cell) < 0.0) std::swap(cell[2], cell[3]);
    mesh.cells.push_back(cell);
}

void appendHexahedron(TetraMesh& mesh, const std::array<std::uint32_t, 8>& corners,
                      HexahedronSplit split, bool mirrored)
{
    const std::size_t count = split == HexahedronSplit::FIVE ? 5 : 6;
    for (std::size_t c = 0; c < count; ++c) {
        TetraMesh::Cell cell;
        for (std::size_t i = 0; i < 4; ++i)
            cell[i] = split == HexahedronSplit::SIX
                          ? corners[SIX_CELLS[c][i]]
                          : corners[FIVE_CELLS[c][i] ^ (mirrored ? 1u : 0u)];
        appendCell(mesh, cell);
    }
}

void removeUnusedPoints(TetraMesh& mesh)
{
    std::vector<bool> used(mesh.points.size());
    for (const TetraMesh::Cell& cell : mesh.cells)
        for (std::uint32_t point : cell)
            used[point] = true;
    std::vector<std::uint32_t> number(mesh.points.size());
    std::vector<glm::dvec3> points;
    for (std::size_t i = 0; i < used.size(); ++i) {
        number[i] = std::uint32_t(points.size());
        if (used[i]) points.push_back(mesh.points[i]);
    }
    for (TetraMesh::Cell& cell : mesh.cells)
        for (std::uint32_t& point : cell)
            point = number[point];
    mesh.points = std::move(points);
}

} // namespace

TetraMesh latticeMesh(const glm::ivec3& hexahedra, HexahedronSplit split,
                      const KeepHexahedron& keep)
{
    TetraMesh mesh;
    const glm::ivec3 n = hexahedra + 1;
    for (int z = 0; z < n.z; ++z)
        for (int y = 0; y < n.y; ++y)
            for (int x = 0; x < n.x; ++x)
                mesh.points.push_back(glm::dvec3(x, y, z) / glm::dvec3(hexahedra));
    for (int z = 0; z < hexahedra.z; ++z)
        for (int y = 0; y < hexahedra.y; ++y)
            for (int x = 0; x < hexahedra.x; ++x) {
                if (keep && !keep({x, y, z})) continue;
                std::array<std::uint32_t, 8> corners;
                for (int c = 0; c < 8; ++c)
                    corners[std::size_t(c)] = std::uint32_t(
                        (x + (c & 1)) + n.x * ((y + (c >> 1 & 1)) + n.y * (z + (c >> 2))));
                appendHexahedron(mesh, corners, split, ((x + y + z) & 1) != 0);
            }
    if (keep) removeUnusedPoints(mesh);
    return mesh;
}

TetraMesh cornerMesh(int n, HexahedronSplit split)
{
    return latticeMesh(glm::ivec3(n), split,
                       [n](const glm::ivec3& h) { return 2 * h.x < n || 2 * h.y < n; });
}

TetraMesh holeMesh(int n, HexahedronSplit split)
{
    const auto isMiddle = [n](int i) { return 3 * i >= n && 3 * i < 2 * n; };
    return latticeMesh(glm::ivec3(n), split, [isMiddle](const glm::ivec3& h) {
        return !(isMiddle(h.x) && isMiddle(h.y));
    });
}

TetraMesh twoPieceMesh(int n, HexahedronSplit split)
{
    return latticeMesh(glm::ivec3(n), split,
                       [n](const glm::ivec3& h) { return 3 * h.x < n || 3 * h.x >= 2 * n; });
}

TetraMesh cyclicBars(int n)
{
    // Each is centred on an edge of a triangle, longer than it, and rises along it.
    const glm::dmat4 centered = glm::translate(glm::dmat4(1.0), glm::dvec3(-0.5));
    const glm::dmat4 sized = glm::scale(glm::dmat4(1.0), glm::dvec3(1.8, 0.25, 0.15)) * centered;
    const glm::dmat4 rising =
        glm::rotate(glm::dmat4(1.0), -0.35, glm::dvec3(0.0, 1.0, 0.0)) * sized;
    TetraMesh mesh;
    for (int i = 0; i < 3; ++i) {
        TetraMesh bar = latticeMesh(glm::ivec3(n, 1, 1));
        const glm::dmat4 moved =
            glm::translate(glm::dmat4(1.0), glm::dvec3(0.0, -0.4, 0.0)) * rising;
        transform(bar,
                  glm::rotate(glm::dmat4(1.0), i * glm::radians(120.0), glm::dvec3(0.0, 0.0, 1.0)) *
                      moved);
        append(mesh, bar);
    }
    return mesh;
}

void transform(TetraMesh& mesh, const glm::dmat4& map)
{
    for (glm::dvec3& p : mesh.points)
        p = glm::dvec3(map * glm::dvec4(p, 1.0));
}

void append(TetraMesh& mesh, const TetraMesh& other)
{
    const std::uint32_t first = std::uint32_t(mesh.points.size());
    mesh.points.insert(mesh.points.end(), other.points.begin(), other.points.end());
    for (TetraMesh::Cell cell : other.cells) {
        for (std::uint32_t& point : cell)
            point += first;
        mesh.cells.push_back(cell);
    }
}

void sampleField(TetraMesh& mesh, const Field& field, bool perCell)
{
    mesh.scalars.clear();
    mesh.scalarsPerCell = perCell;
    const auto add = [&](const glm::dvec3& p) { mesh.scalars.push_back(float(field.value(p))); };
    if (!perCell) {
        for (const glm::dvec3& p : mesh.points)
            add(p);
        return;
    }
    for (const TetraMesh::Cell& cell : mesh.cells)
        add(0.25 * (mesh.corner(cell, 0) + mesh.corner(cell, 1) + mesh.corner(cell, 2) +
                    mesh.corner(cell, 3)));
}

core::TetraSet tetraSet(const TetraMesh& mesh)
{
    core::TetraSet set;
    set.vertices.resize(mesh.points.size());
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        set.vertices.setPosition(i, mesh.points[i]);
    for (const TetraMesh::Cell& cell : mesh.cells)
        set.indices.insert(set.indices.end(), cell.begin(), cell.end());
    return set;
}

} // namespace oracle
} // namespace osgVolumizer
