#include "FaceSet.h"

#include <string>

namespace osgVolumizer {
namespace core {

void FaceSet::clear()
{
    vertices.clear();
    indices.clear();
    faceOffsets.assign(1, 0);
}

std::uint32_t FaceSet::appendVertex(const float* values)
{
    const std::size_t n = vertexCount();
    vertices.insert(vertices.end(), values, values + format.stride());
    return static_cast<std::uint32_t>(n);
}

Status FaceSet::appendFace(const std::uint32_t* corners, std::size_t count)
{
    if (count < 3)
        return {ErrorCode::VALUE_INVALID,
                "FaceSet: a face of " + std::to_string(count) + " corners."};
    for (std::size_t i = 0; i < count; ++i)
        if (corners[i] >= vertexCount())
            return {ErrorCode::INDEX_OUT_OF_RANGE,
                    "FaceSet: corner " + std::to_string(i) + " is vertex " +
                        std::to_string(corners[i]) + ", but there are " +
                        std::to_string(vertexCount()) + ".",
                    static_cast<std::int64_t>(i)};
    if (faceOffsets.empty()) faceOffsets.push_back(0);
    indices.insert(indices.end(), corners, corners + count);
    faceOffsets.push_back(static_cast<std::uint32_t>(indices.size()));
    return {};
}

Status FaceSet::append(const FaceSet& other)
{
    if (!(format == other.format))
        return {ErrorCode::VALUE_INVALID,
                "FaceSet: records of " + std::to_string(other.format.stride()) +
                    " values do not fit to records of " + std::to_string(format.stride()) + "."};
    if (vertexCount() + other.vertexCount() > 0xffffffffu ||
        indices.size() + other.indices.size() > 0xffffffffu)
        return {ErrorCode::TOO_LARGE, "FaceSet: more than 2^32 vertices or corners."};
    const auto firstVertex = static_cast<std::uint32_t>(vertexCount());
    const auto firstIndex = static_cast<std::uint32_t>(indices.size());
    if (faceOffsets.empty()) faceOffsets.push_back(0);
    // By position, since a set may be appended to itself.
    const std::size_t values = other.vertices.size(), corners = other.indices.size(),
                      faces = other.faceCount();
    for (std::size_t i = 0; i < values; ++i)
        vertices.push_back(other.vertices[i]);
    for (std::size_t i = 0; i < corners; ++i)
        indices.push_back(firstVertex + other.indices[i]);
    for (std::size_t f = 0; f < faces; ++f)
        faceOffsets.push_back(firstIndex + other.faceOffsets[f + 1]);
    return {};
}

void FaceSet::triangulate(std::size_t first, std::size_t count,
                          std::vector<std::uint32_t>& triangles) const
{
    for (std::size_t f = first; f < first + count; ++f) {
        const FaceView face = this->face(f);
        for (std::size_t i = 1; i + 1 < face.size(); ++i)
            triangles.insert(triangles.end(), {face[0], face[i], face[i + 1]});
    }
}

} // namespace core
} // namespace osgVolumizer
