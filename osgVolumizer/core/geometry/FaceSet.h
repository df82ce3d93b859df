#pragma once

#include "../Export.h"
#include "../Status.h"
#include "Box.h"
#include "VertexFormat.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Indexed convex polygons over shared vertex records (floats, ready for GL). Positions are in the
/// object frame of their owner, relative to an origin that the owner states.
struct OSGVOLUMIZER_CORE_EXPORT FaceSet
{
    VertexFormat format;
    std::vector<float> vertices;        ///< records of `format`
    std::vector<std::uint32_t> indices; ///< polygons, one after another
    std::vector<std::uint32_t>
        faceOffsets; ///< face f is indices [faceOffsets[f], faceOffsets[f+1])

    std::size_t faceCount() const { return faceOffsets.empty() ? 0 : faceOffsets.size() - 1; }
    std::size_t vertexCount() const
    {
        return vertices.size() / static_cast<std::size_t>(format.stride());
    }
    bool empty() const { return faceCount() == 0; }
    /// Empties it; keeps the memory and the format.
    void clear();

    const float* record(std::uint32_t vertex) const
    {
        return vertices.data() + std::size_t(vertex) * static_cast<std::size_t>(format.stride());
    }
    glm::dvec3 position(std::uint32_t vertex) const
    {
        const float* p = record(vertex) + format.positionOffset();
        return {p[0], p[1], p[2]};
    }
};

} // namespace core
} // namespace osgVolumizer
