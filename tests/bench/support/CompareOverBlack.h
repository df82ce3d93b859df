#pragma once

#include <support/Compare.h>

#include <cmath>

namespace osgVolumizer {
namespace bench {

/// The difference of two pictures as a screen shows them, red, green and blue: alpha is left out,
/// since some of the peers write none that means anything.
inline support::Difference compareOverBlack(support::FloatImage a, support::FloatImage b,
                                            const support::Mask& mask)
{
    for (glm::vec4& p : a.pixels)
        p.a = 0.0f;
    for (glm::vec4& p : b.pixels)
        p.a = 0.0f;
    support::Difference d = support::compare(a, b, mask);
    d.rmse *= std::sqrt(4.0 / 3.0); // over three channels
    d.bias *= 4.0 / 3.0;
    return d;
}

} // namespace bench
} // namespace osgVolumizer
