#pragma once

#include "../VoxelSource.h"
#include "TiffTags.h"

#include <OpenImageIO/imageio.h>

#include <memory>
#include <optional>
#include <string>

namespace osgVolumizer {
namespace io {

/// The format that pixels are read in, and that of the voxels made from them.
struct PixelFormat
{
    OIIO::TypeDesc read = OIIO::TypeDesc::UINT8; ///< what OpenImageIO is asked for
    std::optional<int> channel;                  ///< that was asked for
    int first = 0;                               ///< of those that are read
    int channels = 1;                            ///< so many are read
    int shift = 0;         ///< bits that OpenImageIO has widened integers by: 1 bit to 8, 12 to 16
    bool inverted = false; ///< by OpenImageIO: bytes whose 0 is white
    double offset = 0.0;   ///< added to numbers as they are stored
    VoxelType type = VoxelType::UINT8;
    int components = 1;

    /// True where pixels are stored as they are read.
    bool direct() const
    {
        return channels == components && shift == 0 && !inverted && offset == 0.0 &&
               read != OIIO::TypeDesc::INT64 && read != OIIO::TypeDesc::UINT64;
    }
    bool operator==(const PixelFormat& o) const
    {
        return read == o.read && channels == o.channels && first == o.first;
    }
};

/// An image file that is open for reading. OpenImageIO's exceptions end here.
class ImageFile
{
public:
    /// FILE_UNREADABLE with OpenImageIO's reason.
    Status open(const std::string& path);
    /// False where there is no such subimage.
    bool seek(int subimage);

    const OIIO::ImageSpec& spec() const { return _input->spec(); }
    const std::string& path() const { return _path; }
    /// Size of the present subimage.
    glm::ivec3 size() const;
    /// "128,128,1 pixels of 1 x uint8", for messages.
    std::string text() const;
    /// The format of the present subimage, or of one channel of it; NOT_SUPPORTED for types that
    /// are no numbers, INDEX_OUT_OF_RANGE for a channel that is not there.
    Result<PixelFormat> pixelFormat(std::optional<int> channel = {}) const;
    /// Slices that can be read at a time: the depth of a tile.
    int sliceStep() const;
    /// Writes slices [z, z + sliceStep()) of the present subimage, as far as there are any.
    Status readSlices(const PixelFormat& format, int z, void* destination);
    /// Writes rows [begin, end) of the present subimage, which is 2D.
    Status readRows(const PixelFormat& format, int begin, int end, void* destination);
    /// Refuses voxels that the file cannot hold: before anything is allocated.
    Status checkBytes(std::int64_t voxelBytes) const;

private:
    struct Part // of a subimage: rows and slices
    {
        int y0, y1, z0, z1;
    };
    Status readPart(const PixelFormat& format, const Part& part, void* destination);
    bool readPixels(const PixelFormat& format, const Part& part, void* destination);
    std::string reason() const;

    std::string _path;
    std::unique_ptr<OIIO::ImageInput> _input;
    int _subimage = 0;
    TiffTags _tags;
};

} // namespace io
} // namespace osgVolumizer
