#pragma once

#include "../Export.h"
#include "Box.h"
#include "FaceSet.h"
#include "TetraSet.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Drawing aids: line segments over shared points, in the frame of what they outline.
struct LineSet
{
    std::vector<glm::dvec3> points;
    std::vector<std::uint32_t> indices; ///< two per segment
};

/// Every edge of the tetrahedra once, appended. Expects a valid set.
OSGVOLUMIZER_CORE_EXPORT void outlineTetrahedra(const TetraSet& set, LineSet& lines);

/// Every edge of faces [first, first + count) once, appended.
OSGVOLUMIZER_CORE_EXPORT void outlineFaces(const FaceSet& faces, std::size_t first,
                                           std::size_t count, LineSet& lines);

/// The twelve edges of each box, such as the clip boxes of bricks, appended.
OSGVOLUMIZER_CORE_EXPORT void outlineBoxes(const std::vector<Box3d>& boxes, LineSet& lines);

} // namespace core
} // namespace osgVolumizer
