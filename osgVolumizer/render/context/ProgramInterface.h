#pragma once

namespace osgVolumizer {
namespace render {

/// Texture units of the samplers.
enum TextureUnit : unsigned
{
    UNIT_VOXELS,
    UNIT_TABLE,
    UNIT_OPAQUE_DEPTH,
    UNIT_LAYER_DEPTH,
    UNIT_SORTED_FAR, ///< the four farthest depths of a pixel's surfaces
    UNIT_SORTED_NEAR,
    UNIT_CELLS,
    UNIT_FIRST_LAYER,                    ///< and the following: captured depths
    UNIT_FIRST_PAINT = UNIT_FIRST_LAYER, ///< and the following, in other programs
    UNIT_COUNT = UNIT_FIRST_LAYER + 8
};
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
