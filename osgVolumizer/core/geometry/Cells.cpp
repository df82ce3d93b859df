#include "CellSplitting.h"
#include "Solids.h"

#include <string>

namespace osgVolumizer {
namespace core {

Result<TetraSet> CellSet::tessellate() const
{
    if (kind < CellKind::TETRA || kind > CellKind::HEXA)
        return Status(ErrorCode::VALUE_INVALID,
                      "CellSet: kind " + std::to_string(static_cast<int>(kind)) + " is unknown.");
    const auto size = static_cast<std::size_t>(cellSize(kind));
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
        splitCell(kind, indices.data() + i, set.indices);
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
