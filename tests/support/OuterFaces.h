#pragma once

#include <osgVolumizer/core/geometry/TetraGraph.h>

#include <array>
#include <vector>

namespace osgVolumizer {
namespace support {

/// Vertex indices of the triangles with a tetrahedron on one side only, counter-clockwise from
/// outside.
inline std::vector<std::array<core::TetraSet::Index, 3>> outerFaces(const core::TetraSet& set)
{
    const core::TetraGraph graph = core::makeTetraGraph(set);
    std::vector<std::array<core::TetraSet::Index, 3>> faces;
    for (std::size_t f = 0; f < graph.faceCount; ++f) {
        const std::size_t at = graph.facesBegin + core::TetraGraph::FACE_WORDS * f;
        faces.push_back({graph.words[at], graph.words[at + 1], graph.words[at + 2]});
    }
    return faces;
}

} // namespace support
} // namespace osgVolumizer
