#include "CellSplitting.h"

#include <algorithm>

namespace osgVolumizer {
namespace core {

namespace {

/// Faces of a cell, seen counter-clockwise from outside where the cell is oriented as its kind says
/// (det(1 - 0, 2 - 0, next ring - 0) > 0); -1 ends a triangle.
struct CellFaces
{
    int vertices, faces;
    int corner[6][4];
};

constexpr CellFaces CELLS[4] = {
    {4, 4, {{0, 2, 1, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {2, 0, 3, -1}, {}, {}}},
    {5, 5, {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}, {}}},
    {6, 5, {{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}, {}}},
    {8, 6, {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}}};

} // namespace

int cellSize(CellKind kind)
{
    return CELLS[static_cast<int>(kind)].vertices;
}

void splitCell(CellKind kind, const TetraSet::Index* v, std::vector<TetraSet::Index>& indices)
{
    const CellFaces& cell = CELLS[static_cast<int>(kind)];
    const TetraSet::Index apex = *std::min_element(v, v + cell.vertices);
    for (int f = 0; f < cell.faces; ++f) {
        const int n = cell.corner[f][3] < 0 ? 3 : 4;
        TetraSet::Index corner[4] = {};
        int lowest = 0;
        for (int i = 0; i < n; ++i) {
            corner[i] = v[cell.corner[f][i]];
            if (corner[i] < corner[lowest]) lowest = i;
        }
        if (corner[lowest] == apex) continue; // the apex lies in it
        for (int i = 1; i + 1 < n; ++i)
            // The face is seen counter-clockwise from outside, and the apex is on the inside.
            indices.insert(indices.end(), {corner[lowest], corner[(lowest + i + 1) % n],
                                           corner[(lowest + i) % n], apex});
    }
}

} // namespace core
} // namespace osgVolumizer
