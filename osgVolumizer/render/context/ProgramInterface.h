#pragma once

namespace osgVolumizer {
namespace render {

/// Texture units of the samplers.
enum TextureUnit : unsigned
{
    UNIT_VOXELS,
    UNIT_TABLE,
    UNIT_OPAQUE_DEPTH,
    UNIT_SPLIT_DEPTH,
    UNIT_SORTED_FAR,  ///< ranked: the four farthest depths; captured: all sorted depths
    UNIT_SORTED_NEAR, ///< ranked: the four nearest depths; captured: colours
    UNIT_CELLS,
    UNIT_NEXT_VOXELS,                       ///< of the second of two time steps
    UNIT_FIRST_CAPTURED,                    ///< and the following: captured depths
    UNIT_FIRST_PAINT = UNIT_FIRST_CAPTURED, ///< and the following, in other programs
    /// With four paints, the grid of a cut, and what tetrahedra have: see tetraUnitOf().
    UNIT_COUNT = UNIT_FIRST_CAPTURED + 8 + 1 + 7
};
/// Image unit of compute shaders: the last one that every context has, since scenes begin with the
/// first.
constexpr unsigned UNIT_TARGET = 7;
/// Vertex attributes.
enum Attribute : unsigned
{
    ATTRIBUTE_POSITION,
    ATTRIBUTE_SLAB,             ///< slabs: nearest and farthest depth
    ATTRIBUTE_VOXEL_COORDINATE, ///< slices
    ATTRIBUTE_COLOR,
    ATTRIBUTE_SPACING, ///< slices: thickness of the layer
    ATTRIBUTE_COUNT
};

} // namespace render
} // namespace osgVolumizer
