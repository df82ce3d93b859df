#pragma once

#include "osgVolumizer/core/geometry/TetraSet.h"
#include "osgVolumizer/core/sampling/Polygonize.h"
#include "osgVolumizer/core/sampling/Sample.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>

namespace osgVolumizer {
namespace testing {

/// Adds the cell with the given corners (numbered as Box3d::corner) in five tetrahedra. Cells of
/// alternating parity share the diagonals of their faces.
inline void addCell(core::TetraSet& set, const core::TetraSet::Index (&c)[8], bool odd)
{
    static constexpr int five[20] = {0, 5, 3, 6, 1, 3, 0, 5, 2, 0, 3, 6, 4, 5, 0, 6, 7, 3, 5, 6};
    // The mirror image in x; the last two change places to keep the orientation.
    for (int i = 0; i < 20; ++i) {
        const int k = odd ? (i % 4 == 2 ? i + 1 : i % 4 == 3 ? i - 1 : i) : i;
        set.indices.push_back(c[odd ? five[k] ^ 1 : five[k]]);
    }
}

/// n^3 cells of five tetrahedra, filling [0, size]^3.
inline core::TetraSet makeGrid(int n, double size,
                               const core::VertexFormat& format = core::VertexFormat())
{
    core::TetraSet set;
    set.vertices = core::VertexArray(format);
    const int m = n + 1;
    set.vertices.resize(std::size_t(m) * m * m);
    for (int z = 0; z < m; ++z)
        for (int y = 0; y < m; ++y)
            for (int x = 0; x < m; ++x) {
                const std::size_t i = (std::size_t(z) * m + y) * m + x;
                set.vertices.setPosition(i, glm::dvec3(x, y, z) * (size / n));
            }
    for (int z = 0; z < n; ++z)
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                core::TetraSet::Index c[8];
                for (int i = 0; i < 8; ++i)
                    c[i] = static_cast<core::TetraSet::Index>(
                        ((z + (i >> 2 & 1)) * m + y + (i >> 1 & 1)) * m + x + (i & 1));
                addCell(set, c, (x + y + z) % 2 != 0);
            }
    return set;
}

/// A box in five tetrahedra, all of positive orientation.
inline core::TetraSet makeBox(const glm::dvec3& min, const glm::dvec3& max)
{
    core::TetraSet set;
    set.vertices.resize(8);
    const core::Box3d box{min, max};
    for (int i = 0; i < 8; ++i)
        set.vertices.setPosition(std::size_t(i), box.corner(i));
    addCell(set, {0, 1, 2, 3, 4, 5, 6, 7}, false);
    return set;
}

/// Looks at the origin from 300 units away, along the direction.
inline core::View viewAlong(const glm::dvec3& direction)
{
    core::View view;
    const glm::dvec3 d = glm::normalize(direction);
    const glm::dvec3 up = std::abs(d.z) > 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    view.toEye = glm::lookAt(d * -300.0, glm::dvec3(0.0), up);
    view.projection = glm::perspective(1.0, 1.0, 1.0, 1000.0);
    return view;
}

/// Sum of the areas of the faces in a range; adds their vector areas to `sum`.
inline double area(const core::FaceSet& faces, const core::FaceRange& range,
                   glm::dvec3* sum = nullptr)
{
    double r = 0.0;
    for (std::uint32_t f = range.firstFace; f < range.firstFace + range.faceCount; ++f) {
        glm::dvec3 n(0.0);
        const std::uint32_t first = faces.faceOffsets[f];
        const glm::dvec3 a = faces.position(faces.indices[first]);
        for (std::uint32_t i = first + 1; i + 1 < faces.faceOffsets[f + 1]; ++i)
            n += 0.5 * glm::cross(faces.position(faces.indices[i]) - a,
                                  faces.position(faces.indices[i + 1]) - a);
        if (sum) *sum += n;
        r += glm::length(n);
    }
    return r;
}

inline double area(const core::PolygonSet& polygons)
{
    double r = 0.0;
    for (std::size_t f = 0; f < polygons.faceCount(); ++f)
        r += 0.5 * glm::length(polygons.normal(f));
    return r;
}

} // namespace testing
} // namespace osgVolumizer
