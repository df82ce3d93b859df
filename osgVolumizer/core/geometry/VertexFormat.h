#pragma once

#include "../Export.h"

#include <cstddef>

namespace osgVolumizer {
namespace core {

/// Record layouts, named as in the OpenGL Volumizer guide: T voxel coordinates, C colour,
/// V position, in this order, then any user values (normals, a scalar...).
enum class VertexLayout : int
{
    V3F,
    T3F_V3F,
    C3F_V3F,
    C4F_V3F,
    T3F_C3F_V3F,
    T3F_C4F_V3F,
    USER ///< T3F_C4F_V3F fields as asked for, plus userValues
};

/// The places of the fields in a vertex record. Offsets and sizes count values (not bytes); an
/// absent field has size 0. Every field is interpolated linearly when a tetrahedron is sampled or
/// clipped.
struct VertexFormat
{
    VertexLayout layout = VertexLayout::V3F;
    int voxelCoordinateSize = 0; ///< 0 or 3
    int colorSize = 0;           ///< 0, 3 (RGB) or 4 (RGBA, straight alpha)
    int userSize = 0;            ///< any number >= 0, bounded by MAX_USER_VALUES

    static constexpr int MAX_USER_VALUES = 16;

    VertexFormat() = default;
    VertexFormat(VertexLayout l, int userValues = 0) : layout(l), userSize(userValues)
    {
        switch (l) {
        case VertexLayout::T3F_C3F_V3F:
        case VertexLayout::T3F_C4F_V3F:
        case VertexLayout::T3F_V3F:
            voxelCoordinateSize = 3;
            break;
        default:
            break;
        }
        switch (l) {
        case VertexLayout::C3F_V3F:
        case VertexLayout::T3F_C3F_V3F:
            colorSize = 3;
            break;
        case VertexLayout::C4F_V3F:
        case VertexLayout::T3F_C4F_V3F:
            colorSize = 4;
            break;
        default:
            break;
        }
        if (userValues > 0) layout = VertexLayout::USER;
    }
    /// The USER layout with the fields asked for.
    static VertexFormat user(int voxelCoordinateSize, int colorSize, int userSize)
    {
        VertexFormat f;
        f.layout = VertexLayout::USER;
        f.voxelCoordinateSize = voxelCoordinateSize;
        f.colorSize = colorSize;
        f.userSize = userSize;
        return f;
    }

    int voxelCoordinateOffset() const { return 0; }
    int colorOffset() const { return voxelCoordinateSize; }
    int positionOffset() const { return voxelCoordinateSize + colorSize; }
    int userOffset() const { return positionOffset() + 3; }
    int stride() const { return userOffset() + userSize; }
    bool operator==(const VertexFormat& o) const
    {
        return voxelCoordinateSize == o.voxelCoordinateSize && colorSize == o.colorSize &&
               userSize == o.userSize;
    }
};

} // namespace core
} // namespace osgVolumizer
