#pragma once

#include <array>
#include <cstdint>

namespace osgVolumizer {
namespace core {

/// The cross section of a tetrahedron, by which of its vertices are on the near side of the surface
/// (Doi and Koide, "An efficient method of triangulating equi-valued surfaces by using tetrahedral
/// cells", IEICE Trans. E74, 1991). Corners are edges, listed counter-clockwise about the direction
/// from far to near, for a tetrahedron with det(b - a, c - a, d - a) > 0.
struct TetraCase
{
    int count = 0;                            ///< corners: 0, 3 or 4
    std::array<std::uint8_t, 4> farVertex{};  ///< per corner, the end of its edge that is far
    std::array<std::uint8_t, 4> nearVertex{}; ///< per corner, the end that is near
    std::array<std::uint8_t, 4> edge{};       ///< per corner, the number of its edge
};

/// Number of the edge between two vertices: 01 02 03 12 13 23.
constexpr std::uint8_t tetraEdge(int a, int b)
{
    constexpr std::uint8_t numbers[4][4] = {{9, 0, 1, 2}, {0, 9, 3, 4}, {1, 3, 9, 5}, {2, 4, 5, 9}};
    return numbers[a][b];
}

namespace detail {

constexpr void setCorner(TetraCase& c, int corner, int farVertex, int nearVertex)
{
    c.farVertex[static_cast<std::size_t>(corner)] = static_cast<std::uint8_t>(farVertex);
    c.nearVertex[static_cast<std::size_t>(corner)] = static_cast<std::uint8_t>(nearVertex);
    c.edge[static_cast<std::size_t>(corner)] = tetraEdge(farVertex, nearVertex);
}

constexpr std::array<TetraCase, 16> makeTetraCases()
{
    // The face opposite vertex i, seen counter-clockwise from i.
    constexpr int opposite[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
    // Even permutations (a, b, c, d): near {c, d}, far {a, b}.
    constexpr int pairs[6][4] = {{0, 1, 2, 3}, {2, 3, 0, 1}, {0, 2, 3, 1},
                                 {3, 1, 0, 2}, {0, 3, 1, 2}, {1, 2, 0, 3}};
    std::array<TetraCase, 16> table{};
    for (int i = 0; i < 4; ++i) {
        TetraCase& near = table[std::size_t(1) << i];
        TetraCase& far = table[15u & ~(1u << i)];
        near.count = far.count = 3;
        for (int k = 0; k < 3; ++k) {
            setCorner(near, k, opposite[i][k], i);
            setCorner(far, 2 - k, i, opposite[i][k]);
        }
        // The third corner once more, so that four can be computed without a branch.
        setCorner(near, 3, opposite[i][2], i);
        setCorner(far, 3, i, opposite[i][0]);
    }
    for (const auto& p : pairs) {
        TetraCase& c = table[(1u << p[2]) | (1u << p[3])];
        c.count = 4;
        setCorner(c, 0, p[0], p[2]);
        setCorner(c, 1, p[0], p[3]);
        setCorner(c, 2, p[1], p[3]);
        setCorner(c, 3, p[1], p[2]);
    }
    return table;
}

} // namespace detail

/// By mask: bit i is set where vertex i is on the near side.
inline constexpr std::array<TetraCase, 16> TETRA_CASES = detail::makeTetraCases();

} // namespace core
} // namespace osgVolumizer
