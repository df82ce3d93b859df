#pragma once

#include <glm/vec3.hpp>

#include <osg/Vec3d>

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

} // namespace picking
} // namespace osgVolumizer
