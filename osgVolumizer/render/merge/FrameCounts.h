#pragma once

namespace osgVolumizer {
namespace render {

/// What a frame did, for the statistics.
struct FrameCounts
{
    double faces = 0.0, polygons = 0.0, polygonizations = 0.0, bricksDrawn = 0.0;
    double volumeLeaves = 0.0, surfacePieces = 0.0, intervals = 0.0;
};

} // namespace render
} // namespace osgVolumizer
