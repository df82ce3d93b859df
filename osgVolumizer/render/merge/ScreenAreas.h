#pragma once

#include "ForeignLeaf.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <vector>

namespace osgVolumizer {
namespace render {

/// A window rectangle (x, y, width, height) around some members, given by number.
struct ScreenArea
{
    glm::ivec4 rectangle{0};
    std::vector<std::size_t> members;
};

/// The pixels of a rectangle of device coordinates and `margin` around it, inside the viewport;
/// empty (width or height 0) where it lies outside.
glm::ivec4 pixelRectangle(const ScreenRectangle& rectangle, const glm::ivec4& viewport, int margin);

/// Joins areas that overlap, until none do and there are no more than `maximum`; empty ones go.
std::vector<ScreenArea> joinOverlapping(std::vector<ScreenArea> areas, std::size_t maximum);

/// What is left of disjoint rectangles without one more: disjoint rectangles.
std::vector<glm::ivec4> subtract(const std::vector<glm::ivec4>& rectangles, const glm::ivec4& hole);

} // namespace render
} // namespace osgVolumizer
