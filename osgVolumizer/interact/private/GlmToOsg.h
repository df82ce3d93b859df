#pragma once

#include <glm/vec3.hpp>

#include <osg/Matrixd>
#include <osg/Vec3d>

#include <cmath>

namespace osgVolumizer {
namespace picking {

inline glm::dvec3 toGlm(const osg::Vec3d& v)
{
    return {v.x(), v.y(), v.z()};
}
inline osg::Vec3d toOsg(const glm::dvec3& v)
{
    return {v.x, v.y, v.z};
}

/// False where the matrix has no inverse that is made of numbers.
inline bool invert(const osg::Matrixd& matrix, osg::Matrixd& inverse)
{
    bool finite = inverse.invert(matrix);
    for (int i = 0; i < 16; ++i)
        finite = finite && std::isfinite(inverse.ptr()[i]);
    return finite;
}

} // namespace picking
} // namespace osgVolumizer
