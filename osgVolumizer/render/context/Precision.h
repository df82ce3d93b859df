#pragma once

namespace osgVolumizer {
namespace render {

/// How exactly a context filters and blends: the largest errors there are. Of one that nothing is
/// known of what texture units commonly do: weights and results of 8 bits, blending of 11.
struct Precision
{
    /// Of the weights by which neighbouring texels of a float texture are mixed, along one axis.
    double filterWeight = 1.0 / 512.0;
    /// Of filtered 8-bit texels besides, as a share of their type's range.
    double byteTexel = 0.5 / 255.0;
    /// Of one blend of premultiplied colours in a 32-bit target.
    double blend = 1.0 / 2048.0;
    bool measured = false;
};

/// Largest error of a value that is interpolated linearly along three axes, whose samples differ by
/// no more than `difference` from one to the next: a value changes by the difference times what its
/// weight is off by, along each axis.
inline double filteringError(const Precision& precision, double difference)
{
    return 3.0 * precision.filterWeight * difference;
}

} // namespace render
} // namespace osgVolumizer
