#include "Solids.h"

#include <algorithm>
#include <string>

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

void addTetra(TetraSet& set, TetraSet::Index apex, TetraSet::Index a, TetraSet::Index b,
              TetraSet::Index c)
{
    // The face is seen counter-clockwise from outside, so the apex is on the inside: (a, c, b,
    // apex) is positive.
    set.indices.insert(set.indices.end(), {a, c, b, apex});
}

void addCell(TetraSet& set, const CellFaces& cell, const TetraSet::Index* v)
{
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
            addTetra(set, apex, corner[lowest], corner[(lowest + i) % n],
                     corner[(lowest + i + 1) % n]);
    }
}

} // namespace

int cellSize(CellKind kind)
{
    return CELLS[static_cast<int>(kind)].vertices;
}

Result<TetraSet> CellSet::tessellate() const
{
    if (kind < CellKind::TETRA || kind > CellKind::HEXA)
        return Status(ErrorCode::VALUE_INVALID,
                      "CellSet: kind " + std::to_string(static_cast<int>(kind)) + " is unknown.");
    const CellFaces& cell = CELLS[static_cast<int>(kind)];
    const auto size = static_cast<std::size_t>(cell.vertices);
    if (indices.size() % size != 0)
        return Status(ErrorCode::SIZE_MISMATCH, "CellSet: " + std::to_string(indices.size()) +
                                                    " indices are no multiple of " +
                                                    std::to_string(size) + ".");
    const std::size_t count = vertices.size();
    for (std::size_t i = 0; i < indices.size(); ++i)
        if (indices[i] >= count)
            return Status(ErrorCode::INDEX_OUT_OF_RANGE,
                          "CellSet: index " + std::to_string(i) + " is " +
                              std::to_string(indices[i]) + ", but there are " +
                              std::to_string(count) + " vertices.",
                          static_cast<std::int64_t>(i));
    TetraSet set;
    set.vertices = vertices;
    for (std::size_t i = 0; i < indices.size(); i += size)
        addCell(set, cell, indices.data() + i);
    if (Status s = set.validate(); !s) return s;
    return set;
}

Result<CellSet> makeStrip(StripKind kind, VertexArray vertices,
                          const std::vector<TetraSet::Index>& indices)
{
    // First vertices of a strip, vertices per further cell, and what a cell takes.
    struct Strip
    {
        CellKind cell;
        int first, step;
        int corner[8];
    };
    // Corners count from the first vertex of the cell's window, which moves by `step`; the apex of
    // pyramids stays behind as number -1.
    static constexpr Strip strips[7] = {{CellKind::TETRA, 4, 1, {0, 1, 2, 3}},
                                        {CellKind::TETRA, 4, 2, {0, 1, 2, 3}},
                                        {CellKind::HEXA, 8, 4, {0, 1, 2, 3, 4, 5, 6, 7}},
                                        {CellKind::PYRAMID, 4, 2, {0, 1, 3, 2, -1}},
                                        {CellKind::PRISM, 6, 2, {0, 2, 4, 1, 3, 5}},
                                        {CellKind::PRISM, 6, 3, {0, 1, 2, 3, 4, 5}},
                                        {CellKind::PRISM, 6, 4, {0, 2, 4, 1, 3, 5}}};
    if (kind < StripKind::TETRA_FACE || kind > StripKind::PRISM_EDGE)
        return Status(ErrorCode::VALUE_INVALID,
                      "Strip: kind " + std::to_string(static_cast<int>(kind)) + " is unknown.");
    const Strip& strip = strips[static_cast<int>(kind)];
    const std::size_t apex = kind == StripKind::PYRAMID ? 1 : 0;
    const auto first = static_cast<std::size_t>(strip.first) + apex;
    const auto step = static_cast<std::size_t>(strip.step);
    if (indices.size() < first || (indices.size() - first) % step != 0)
        return Status(ErrorCode::SIZE_MISMATCH, "Strip: " + std::to_string(indices.size()) +
                                                    " indices are not " + std::to_string(first) +
                                                    " and a multiple of " + std::to_string(step) +
                                                    " more.");
    CellSet set;
    set.kind = strip.cell;
    set.vertices = std::move(vertices);
    const int size = cellSize(set.kind);
    for (std::size_t at = apex; at + first - apex <= indices.size(); at += step)
        for (int i = 0; i < size; ++i)
            set.indices.push_back(strip.corner[i] < 0
                                      ? indices[0]
                                      : indices[at + static_cast<std::size_t>(strip.corner[i])]);
    return set;
}

} // namespace core
} // namespace osgVolumizer
