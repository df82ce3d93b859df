#pragma once

#include "TetraMesh.h"

namespace osgVolumizer {
namespace oracle {

/// A part of a ray inside one cell; along it the cell's scalar, or colour, is linear.
struct MeshSegment
{
    std::uint32_t cell = 0;
    double enter = 0.0; ///< ray parameters
    double leave = 0.0;
    std::array<double, 4> enterWeights{}; ///< barycentric coordinates, sum 1, none negative
    std::array<double, 4> leaveWeights{};
};

/// The whole of the line origin + t direction (object frame, not null) that lies in a cell; false
/// where that has no length, or the cell no volume. Of two cells that share a face, one is left at
/// the very t where the other is entered.
bool crossCell(const TetraMesh& mesh, std::uint32_t cell, const glm::dvec3& origin,
               const glm::dvec3& direction, MeshSegment& segment);
/// The part [enter, leave] of a segment; expects it within.
MeshSegment partOf(const MeshSegment& segment, double enter, double leave);

} // namespace oracle
} // namespace osgVolumizer
