#pragma once

#include <osg/Matrixd>

#include <glm/gtc/type_ptr.hpp>
#include <glm/mat4x4.hpp>

#include <algorithm>
#include <cmath>

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

/// Whether two views differ by more than rounding: manipulators compute the same one anew in every
/// frame.
inline bool differs(const osg::Matrixd& a, const osg::Matrixd& b)
{
    double largest = 0.0, difference = 0.0;
    for (int i = 0; i < 16; ++i) {
        largest = std::max(largest, std::abs(a.ptr()[i]));
        difference = std::max(difference, std::abs(a.ptr()[i] - b.ptr()[i]));
    }
    return !(difference <= 1e-12 * largest);
}

} // namespace render
} // namespace osgVolumizer
