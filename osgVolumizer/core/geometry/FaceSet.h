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

/// One face of a FaceSet, for as long as the set does not change: a range of vertex numbers.
struct FaceView
{
    const std::uint32_t* first = nullptr;
    const std::uint32_t* last = nullptr;

    const std::uint32_t* begin() const { return first; }
    const std::uint32_t* end() const { return last; }
    std::size_t size() const { return static_cast<std::size_t>(last - first); }
    std::uint32_t operator[](std::size_t corner) const { return first[corner]; }
};

/// Indexed convex polygons over shared vertex records (floats, ready for GL). Positions are in the
/// object frame of their owner, relative to an origin that the owner states.
///
/// `for (const FaceView face : set)` goes over the faces, `for (const std::uint32_t vertex : face)`
/// over the vertices of one.
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
    FaceView face(std::size_t f) const
    {
        return {indices.data() + faceOffsets[f], indices.data() + faceOffsets[f + 1]};
    }

    /// Adds a vertex, a record of `format`, and returns its number.
    std::uint32_t appendVertex(const float* record);
    /// Adds a face over vertices that there are. INDEX_OUT_OF_RANGE with the corner, VALUE_INVALID
    /// for fewer than three.
    Status appendFace(const std::uint32_t* corners, std::size_t count);
    /// Adds all vertices and faces of another set. VALUE_INVALID where the formats differ,
    /// TOO_LARGE beyond 2^32 vertices or corners.
    Status append(const FaceSet& other);
    /// Appends the triangles (three indices each) of faces [first, first + count), as fans: for
    /// GL_TRIANGLES.
    void triangulate(std::size_t first, std::size_t count,
                     std::vector<std::uint32_t>& triangles) const;

    class Iterator
    {
    public:
        Iterator(const FaceSet& set, std::size_t f) : _set(&set), _face(f) {}
        FaceView operator*() const { return _set->face(_face); }
        Iterator& operator++()
        {
            ++_face;
            return *this;
        }
        bool operator!=(const Iterator& o) const { return _face != o._face; }

    private:
        const FaceSet* _set;
        std::size_t _face;
    };
    Iterator begin() const { return {*this, 0}; }
    Iterator end() const { return {*this, faceCount()}; }
};

} // namespace core
} // namespace osgVolumizer
