#pragma once

#include <osgVolumizer/io/VolumeRequest.h>
#include <osgVolumizer/io/VoxelFiles.h>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <memory>
#include <string>

namespace osgVolumizer {
namespace medical {

/// How a number is stored.
enum class Number
{
    INT8,
    UINT8,
    INT16,
    UINT16,
    INT32,
    UINT32,
    INT64,
    UINT64,
    FLOAT32,
    FLOAT64
};
std::size_t numberSize(Number number);

/// The numbers of a file in memory, in native byte order, and what they mean.
struct Samples
{
    Number number = Number::UINT8;
    glm::ivec3 size{1};
    int steps = 1;                       ///< of time
    int channels = 1;                    ///< numbers per sample
    bool planar = false;                 ///< each channel for itself: the slowest; else the fastest
    bool colour = false;                 ///< 3 channels are RGB, 4 are RGBA
    double slope = 1.0, intercept = 0.0; ///< value = slope * number + intercept
    glm::dmat3 axes{1.0};                ///< LPS, mm: the step of each voxel axis
    glm::dvec3 position{0.0};            ///< LPS, mm: of sample 0
    std::string note;                    ///< something that the reader should be told; or empty
    std::shared_ptr<char> data;

    /// Of all numbers; saturates.
    std::int64_t bytes() const;
    /// TOO_LARGE where that is more than there may be, or than there is memory; text without path.
    Status allocate();
};

/// The voxels of samples: one channel (the one that is asked for, or the first, which is told),
/// luminance of RGB, RGBA. In the type of the file; 64-bit integers in the narrowest type that
/// holds them, and so scaled integers where slope and intercept are whole; else float32. Without a
/// copy where that can be. The text of a failure begins with the path.
Result<io::Source> sourceOf(const Samples& samples, const io::VolumeRequest& request);

} // namespace medical
} // namespace osgVolumizer
