#pragma once

#include <cstdint>

namespace osgVolumizer {
namespace vtk {

/// Passes over the faces of one polyhedron, as VTK writes them: the number of faces, and for each
/// the number of its points and these. False where they do not end before the numbers do.
/// \tparam Next bool(std::int64_t&): the next number; false where there is none
template <class Next>
bool skipFaces(Next&& next)
{
    std::int64_t faces = 0, points = 0, point = 0;
    if (!next(faces) || faces < 0) return false;
    for (std::int64_t f = 0; f < faces; ++f) {
        if (!next(points) || points < 0) return false;
        for (std::int64_t i = 0; i < points; ++i)
            if (!next(point)) return false;
    }
    return true;
}

} // namespace vtk
} // namespace osgVolumizer
