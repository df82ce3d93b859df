#pragma once

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <functional>
#include <vector>

namespace osgVolumizer {
namespace core {

/// The texels of a core::ExtinctionTable: `count` entries of one colour, extinction as a function
/// of the fraction, and then its integrals by the midpoint rule.
inline std::vector<glm::vec4> extinctionTexels(int count, const glm::vec3& color,
                                               const std::function<double(double)>& extinctionBits)
{
    std::vector<glm::vec4> texels;
    for (int i = 0; i < count; ++i)
        texels.emplace_back(color, float(extinctionBits(i / (count - 1.0))));
    glm::dvec4 sum(0.0);
    for (int i = 0; i <= count; ++i) {
        texels.emplace_back(sum);
        if (i == count) break;
        const glm::dvec4 t(texels[std::size_t(i)]);
        sum += glm::dvec4(glm::dvec3(t) * t.a, t.a);
    }
    return texels;
}

} // namespace core
} // namespace osgVolumizer
