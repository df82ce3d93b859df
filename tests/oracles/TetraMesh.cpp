#include "TetraMesh.h"

#include <glm/geometric.hpp>

namespace osgVolumizer {
namespace oracle {

double TetraMesh::signedVolume(const Cell& cell) const
{
    const glm::dvec3 origin = corner(cell, 0);
    const glm::dvec3 normal = glm::cross(corner(cell, 1) - origin, corner(cell, 2) - origin);
    return glm::dot(normal, corner(cell, 3) - origin) / 6.0;
}

} // namespace oracle
} // namespace osgVolumizer
