#pragma once

#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/core/transfer/TransferFunction.h>
#include <osgVolumizer/render/context/ContextResources.h>
#include <osgVolumizer/render/context/Precision.h>

#include <support/SurfacelessGraphicsContext.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace osgVolumizer {
namespace support {

/// How exactly contexts filter and blend here, as one of them measured it: in emulation, what is
/// emulated.
inline const render::Precision& precision()
{
    static const render::Precision measured = [] {
        const osg::ref_ptr<SurfacelessGraphicsContext> context =
            new SurfacelessGraphicsContext(8, 8);
        if (!context->valid() || !context->realize() || !context->makeCurrent())
            return render::Precision();
        const render::Precision result =
            render::contextResources(*context->getState())->limits.precision;
        context->releaseContext();
        context->close();
        return result;
    }();
    return measured;
}

/// Whether weights are as good as float arithmetic: then no test may be off by more than it says.
inline bool isExact(const render::Precision& precision)
{
    return precision.filterWeight < 1e-6;
}
inline bool filtersExactly()
{
    return isExact(precision());
}

/// For tests of something else than filtering, such as orders of convergence: where that of the
/// card is not exact, that of the shader.
inline void filterExactly(VolumeAppearance& volume)
{
    volume.setExactFiltering(!filtersExactly());
}

/// What filtering may add to the error of a value between samples that differ by no more than
/// `difference` from one to the next: see render::filteringError(). Zero where it is exact.
inline double filteringBound(double difference, const render::Precision& of = precision())
{
    return isExact(of) ? 0.0 : render::filteringError(of, difference);
}

/// Steepest slopes of a table over the fraction of the range. Expects one without jumps, and
/// opacities below 1.
struct TableSlopes
{
    double color = 0.0;      ///< of a component
    double extinction = 0.0; ///< per opacity unit
};

inline TableSlopes slopesOf(const std::vector<core::TransferFunction::Point>& points)
{
    TableSlopes slopes;
    for (std::size_t i = 1; i < points.size(); ++i) {
        const auto &a = points[i - 1], &b = points[i];
        const double width = b.value - a.value;
        for (int c = 0; c < 3; ++c)
            slopes.color = std::max(slopes.color, std::abs(b.color[c] - a.color[c]) / width);
        // The slope of -log(1 - opacity) is that of opacity over 1 - opacity.
        const double left = 1.0 - std::max(a.color.a, b.color.a);
        slopes.extinction =
            std::max(slopes.extinction, std::abs(b.color.a - a.color.a) / width / left);
    }
    return slopes;
}

/// What filtering may add to the error of a component of a pixel whose ray runs through a volume
/// over a length (opacity units): the light is the integral of colour c times extinction t times
/// transmittance T. A change of c changes it by no more than the largest change of c, since t T
/// integrates to no more than 1; a change of t changes it by T times c less what comes from behind,
/// so by no more than its integral.
inline double filteringBound(const std::vector<core::TransferFunction::Point>& points,
                             double difference, double length,
                             const render::Precision& of = precision())
{
    const TableSlopes slopes = slopesOf(points);
    return filteringBound(difference, of) * (slopes.color + slopes.extinction * length);
}

} // namespace support
} // namespace osgVolumizer
