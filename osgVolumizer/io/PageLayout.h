#pragma once

#include "../VoxelSource.h"

#include <string>
#include <string_view>
#include <vector>

namespace osgVolumizer {
namespace io {

/// What the pages (subimages) of an image file are: slices, channels and time steps, as far as its
/// description says; and how far apart the voxels are.
struct PageLayout
{
    /// What else than its description is known of a file.
    struct File
    {
        int pages = 1;            ///< there are
        int samples = 1;          ///< numbers per pixel
        double xResolution = 0.0; ///< pixels per unit; 0: not said
        double yResolution = 0.0;
    };

    int slices = 1, channels = 1, steps = 1;
    glm::dvec3 spacing{1.0}, origin{0.0};
    glm::dmat3 axes{1.0};
    std::string unit;      ///< of lengths: "micrometres", or as the file has it
    bool isSigned = false; ///< 16 bits are numbers from -32768 on, as ImageJ stores them
    bool single = false;   ///< all pages lie behind the first one's pixels, without directories
    std::vector<std::string> notices; ///< what a user may not expect, sentences without the file

    /// Which page it is.
    int page(int slice, int channel, int step) const;

    /// From the image description of a TIFF: of ImageJ, whose pages go by channels, slices, frames;
    /// of OME (XML), in any order; or of this library's writer. Lengths in micrometres, where their
    /// unit is known. Pages that there are not enough of, and all else, are slices.
    static OSGVOLUMIZER_EXPORT PageLayout parse(std::string_view description, const File& file);
    /// What parse() finds spacing, origin and axes of `d` in, to the bit, and ImageJ its slices.
    static std::string text(const VoxelSource::Description& d);

private:
    std::vector<int> _pages; // by slice, channel, step; empty: in this order
};

} // namespace io
} // namespace osgVolumizer
