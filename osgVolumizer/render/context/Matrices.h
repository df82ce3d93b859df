#pragma once

#include <osg/Matrixd>

#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>

namespace osgVolumizer {
namespace render {

/// OSG multiplies rows from the left, GLM columns from the right: the sixteen numbers are the same.
inline glm::dmat4 toGlm(const osg::Matrixd& m)
{
    return glm::make_mat4(m.ptr());
}
inline osg::Matrixd toOsg(const glm::dmat4& m)
{
    return osg::Matrixd(glm::value_ptr(m));
}

} // namespace render
} // namespace osgVolumizer
