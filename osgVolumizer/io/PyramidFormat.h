#pragma once

#include "../VoxelSource.h"
#include "../core/voxels/BrickTree.h"
#include "../core/voxels/Downsample.h"

#include <string>

namespace osgVolumizer {
namespace io {

/// A pyramid: a TIFF with all levels of a volume (see core/voxels/BrickTree.h), in bricks of 60^3
/// voxels each.
///
/// Its pages come in pairs: for each level from 0 on, and each layer of its bricks along z from 0
/// on, a page of samples, and one of their ranges.
/// - Samples: tiles of 512 x 512 pixels, of the volume's type, one for each brick of the layer, x
///   along the page and y down it. Brick (i,j,k) has samples 60 i - 2 to 60 i + 61 of its level on
///   the x axis, and so on, the first or last one repeated where there are none: 64 slices of
///   64 x 64, side by side in a mosaic of 8 x 8, left to right and then down.
/// - Ranges: a pixel for each brick, of two floats: the lowest and the highest finite value (of
///   alpha, for RGBA) of all samples of level 0 that the brick has; where there are none, the first
///   is above the second.
/// The image description of the first page is the header's text(); that of every page begins with
/// "osgVolumizer pyramid".
struct PyramidFormat
{
    static constexpr int STEP = 60, BORDER = 2, TILE = STEP + 2 * BORDER, MOSAIC = 8,
                         TILE_PIXELS = TILE * MOSAIC;

    VoxelSource::Description description;
    core::LevelRule rule = core::LevelRule::MEAN;
    std::string origin; ///< see PyramidOptions

    /// Of all levels: what can be held of their ranges. Some 3 * 10^12 voxels.
    static constexpr std::int64_t MAXIMUM_BRICKS = std::int64_t(1) << 24;

    /// The bricks of all levels, up to one for all; refused as by BrickTree, and where they are
    /// more than MAXIMUM_BRICKS (TOO_LARGE).
    Result<core::BrickTree> tree() const;
    /// Several lines.
    std::string text() const;
    /// FILE_UNREADABLE for anything that text() does not make.
    static Result<PyramidFormat> parse(const std::string& text);
    static bool isPyramid(const std::string& description);

    /// Pages of samples, and as many of ranges.
    static int layerCount(const core::BrickTree& tree);
    /// The pair of pages of a layer.
    static int pairOf(const core::BrickTree& tree, int level, int layer);
};

} // namespace io
} // namespace osgVolumizer
