#include "TiffVolume.h"

#ifdef OSGVOLUMIZER_HAVE_TIFF

#include "../VoxelSeries.h"
#include "../core/voxels/VoxelData.h"
#include "OiioTypes.h"
#include "RawVoxelSource.h"

#include <tiffio.h>

#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <filesystem>

namespace osgVolumizer {
namespace io {

namespace {

/// An open TIFF, and what libtiff says of it.
class TiffFile
{
public:
    explicit TiffFile(const std::string& path) : _path(path)
    {
#if TIFFLIB_VERSION >= 20221213
        TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
        TIFFOpenOptionsSetErrorHandlerExtR(options, keep, &_error);
        TIFFOpenOptionsSetWarningHandlerExtR(options, ignore, nullptr);
        _tiff = TIFFOpenExt(path.c_str(), "rm", options);
        TIFFOpenOptionsFree(options);
#else
        _tiff = TIFFOpen(path.c_str(), "rm");
#endif
    }
    TiffFile(const TiffFile&) = delete;
    TiffFile& operator=(const TiffFile&) = delete;
    ~TiffFile()
    {
        if (_tiff) TIFFClose(_tiff);
    }
    TIFF* get() const
    {
        return _tiff;
    }
    std::uint32_t number(std::uint32_t tag, std::uint32_t otherwise) const
    {
        std::uint32_t value = otherwise;
        return TIFFGetField(_tiff, tag, &value) ? value : otherwise;
    }
    std::uint16_t shortNumber(std::uint32_t tag) const
    {
        std::uint16_t value = 1;
        return TIFFGetFieldDefaulted(_tiff, tag, &value) ? value : std::uint16_t(1);
    }
    Status refuse(const std::string& text) const
    {
        return {ErrorCode::FILE_UNREADABLE, _path + " cannot be read: " + text};
    }
    /// With libtiff's last words.
    Status refuse() const
    {
        return refuse(_error.empty() ? "libtiff refuses it" : oneLine(_error));
    }

private:
    static int keep(TIFF*, void* to, const char*, const char* format, va_list values)
    {
        char text[512];
        std::vsnprintf(text, sizeof(text), format, values);
        *static_cast<std::string*>(to) = text;
        return 1;
    }
    static int ignore(TIFF*, void*, const char*, const char*, va_list)
    {
        return 1;
    }

    std::string _path, _error;
    TIFF* _tiff = nullptr;
};

Result<VoxelType> typeOf(const TiffFile& file, const std::string& path)
{
    const int bits = file.shortNumber(TIFFTAG_BITSPERSAMPLE),
              format = file.shortNumber(TIFFTAG_SAMPLEFORMAT);
    static const struct
    {
        int bits, format;
        VoxelType type;
    } types[] = {
        {8, SAMPLEFORMAT_UINT, VoxelType::UINT8},     {8, SAMPLEFORMAT_INT, VoxelType::INT8},
        {16, SAMPLEFORMAT_UINT, VoxelType::UINT16},   {16, SAMPLEFORMAT_INT, VoxelType::INT16},
        {16, SAMPLEFORMAT_IEEEFP, VoxelType::HALF},   {32, SAMPLEFORMAT_UINT, VoxelType::UINT32},
        {32, SAMPLEFORMAT_INT, VoxelType::INT32},     {32, SAMPLEFORMAT_IEEEFP, VoxelType::FLOAT32},
        {64, SAMPLEFORMAT_IEEEFP, VoxelType::FLOAT64}};
    for (const auto& t : types)
        if (t.bits == bits && t.format == format) return t.type;
    return Status(ErrorCode::NOT_SUPPORTED, path + " has pixels of " + std::to_string(bits) +
                                                " bits, which are of no voxel type");
}

// Copies the samples of one channel from a box to where they belong.
void copyBox(const unsigned char* box, const glm::ivec3& boxSize, const glm::ivec3& begin,
             int samples, int channel, MemoryVoxelSource& source)
{
    const VoxelSource::Description d = source.describe();
    const std::size_t voxel = voxelTypeSize(d.type);
    const glm::ivec3 end = glm::min(begin + boxSize, d.size);
    for (int z = begin.z; z < end.z; ++z)
        for (int y = begin.y; y < end.y; ++y) {
            const unsigned char* from =
                box +
                (std::size_t(z - begin.z) * std::size_t(boxSize.y) + std::size_t(y - begin.y)) *
                    std::size_t(boxSize.x) * voxel * std::size_t(samples) +
                voxel * std::size_t(channel);
            auto* to =
                static_cast<unsigned char*>(source.data()) +
                ((std::int64_t(z) * d.size.y + y) * d.size.x + begin.x) * std::int64_t(voxel);
            for (int x = begin.x; x < end.x; ++x, from += voxel * std::size_t(samples), to += voxel)
                std::memcpy(to, from, voxel);
        }
}

// libtiff takes a tile for its first slice, but decodes as much as it is asked for.
Status readTiles(const TiffFile& file, const glm::ivec3& box, int samples, int channel,
                 MemoryVoxelSource& source)
{
    const glm::ivec3 size = source.describe().size;
    const auto bytes =
        static_cast<tmsize_t>(core::voxelBytes(box, source.describe().type, samples));
    std::vector<unsigned char> buffer(static_cast<std::size_t>(bytes)), packed;
    std::uint32_t index = 0;
    for (int z = 0; z < size.z; z += box.z)
        for (int y = 0; y < size.y; y += box.y)
            for (int x = 0; x < size.x; x += box.x, ++index) {
                const std::uint64_t stored = TIFFGetStrileByteCount(file.get(), index);
                if (stored < 1 || stored > std::uint64_t(bytes) * 2 + 4096)
                    return file.refuse("a tile has " + std::to_string(stored) + " bytes");
                packed.resize(std::size_t(stored));
                const auto count = static_cast<tmsize_t>(stored);
                if (TIFFReadRawTile(file.get(), index, packed.data(), count) != count ||
                    !TIFFReadFromUserBuffer(file.get(), index, packed.data(), count, buffer.data(),
                                            bytes))
                    return file.refuse();
                copyBox(buffer.data(), box, {x, y, z}, samples, channel, source);
            }
    return {};
}

// Within what a file of so many bytes can hold, however compressed.
bool fits(const glm::ivec3& size, VoxelType type, int samples, const std::string& path)
{
    constexpr std::int64_t HIGHEST_COMPRESSION = 1 << 20;
    std::error_code failed;
    const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(path, failed));
    return !failed && size.x > 0 && size.y > 0 && size.z > 0 &&
           core::voxelBytes(size, type, samples) / HIGHEST_COMPRESSION <= bytes;
}

// The page that `file` is at, a byte for each bit.
Status readBits(const TiffFile& file, const glm::ivec3& size, unsigned char* to)
{
    const tmsize_t row = TIFFScanlineSize(file.get());
    const int strip = static_cast<int>(std::min<std::uint32_t>(
        file.number(TIFFTAG_ROWSPERSTRIP, ~0u), static_cast<std::uint32_t>(size.y)));
    const bool fits = int(file.number(TIFFTAG_IMAGEWIDTH, 0)) == size.x &&
                      int(file.number(TIFFTAG_IMAGELENGTH, 0)) == size.y;
    if (!fits || TIFFIsTiled(file.get()) || row != (size.x + 7) / 8 || strip < 1)
        return file.refuse("its pages of one bit are of several sizes or channels, or in tiles");
    std::vector<unsigned char> bits(std::size_t(row) * std::size_t(strip));
    std::uint32_t index = 0;
    for (int y = 0; y < size.y; y += strip, ++index) {
        const int rows = std::min(strip, size.y - y);
        if (TIFFReadEncodedStrip(file.get(), index, bits.data(), row * rows) != row * rows)
            return file.refuse();
        for (int r = 0; r < rows; ++r)
            for (int x = 0; x < size.x; ++x)
                *to++ =
                    bits[std::size_t(row) * std::size_t(r) + std::size_t(x / 8)] >> (7 - x % 8) & 1;
    }
    return {};
}

Result<Source> readBilevel(const TiffFile& file, const std::string& path)
{
    VoxelSource::Description d;
    d.size = {int(file.number(TIFFTAG_IMAGEWIDTH, 0)), int(file.number(TIFFTAG_IMAGELENGTH, 0)),
              int(TIFFNumberOfDirectories(file.get()))};
    if (!fits(d.size, d.type, 1, path)) return file.refuse("its sizes are wrong");
    MemorySource source = new MemoryVoxelSource;
    if (Status status = source->allocate(d); !status.ok())
        return Status(status.code, path + ": " + status.text);
    auto* to = static_cast<unsigned char*>(source->data());
    for (int z = 0; z < d.size.z; ++z, to += std::int64_t(d.size.x) * d.size.y) {
        if (!TIFFSetDirectory(file.get(), static_cast<std::uint16_t>(z))) return file.refuse();
        if (Status status = readBits(file, d.size, to); !status.ok()) return status;
    }
    return Source(source);
}

} // namespace

Result<Source> readByLibtiff(const std::string& path, std::optional<int> channel)
{
    const TiffFile file(path);
    if (!file.get()) return file.refuse();
    if (file.shortNumber(TIFFTAG_BITSPERSAMPLE) == 1) return readBilevel(file, path);
    const auto number = [&file](std::uint32_t tag, std::uint32_t otherwise) {
        return static_cast<int>(std::min(file.number(tag, otherwise), 0x7fffffffu));
    };
    VoxelSource::Description d;
    d.size = {number(TIFFTAG_IMAGEWIDTH, 0), number(TIFFTAG_IMAGELENGTH, 0),
              number(TIFFTAG_IMAGEDEPTH, 1)};
    if (!TIFFIsTiled(file.get()))
        return Status(ErrorCode::NOT_SUPPORTED,
                      path + " has ImageDepth " + std::to_string(d.size.z) +
                          " in strips; one in tiles, or of a page for each slice, can be read");
    const Result<VoxelType> type = typeOf(file, path);
    if (!type.ok()) return type.status;
    d.type = *type;
    const int samples = file.shortNumber(TIFFTAG_SAMPLESPERPIXEL);
    if (samples > 1 && file.shortNumber(TIFFTAG_PLANARCONFIG) != PLANARCONFIG_CONTIG)
        return Status(ErrorCode::NOT_SUPPORTED, path + " has its channels one after the other");
    if (channel.value_or(0) >= samples)
        return Status(ErrorCode::INDEX_OUT_OF_RANGE, path + " has no channel " +
                                                         std::to_string(*channel) + ", but " +
                                                         std::to_string(samples) + ", from 0 on");
    const glm::ivec3 tile(number(TIFFTAG_TILEWIDTH, 0), number(TIFFTAG_TILELENGTH, 0),
                          number(TIFFTAG_TILEDEPTH, 1));
    const bool larger = glm::any(glm::greaterThan(tile, d.size + 1024));
    if (larger || !fits(tile, d.type, samples, path) || !fits(d.size, d.type, samples, path))
        return file.refuse("its sizes are wrong");
    MemorySource source = new MemoryVoxelSource;
    if (Status status = source->allocate(d); !status.ok())
        return Status(status.code, path + ": " + status.text);
    Status status = readTiles(file, tile, samples, channel.value_or(0), *source);
    if (!status.ok()) return status;
    return Source(source);
}

Result<Source> readSinglePage(const std::string& path, const PageLayout& layout, int channel)
{
    RawName raw;
    {
        const TiffFile file(path);
        if (!file.get()) return file.refuse();
        const Result<VoxelType> type = typeOf(file, path);
        if (!type.ok()) return type.status;
        if (file.shortNumber(TIFFTAG_COMPRESSION) != COMPRESSION_NONE || TIFFIsTiled(file.get()) ||
            file.shortNumber(TIFFTAG_SAMPLESPERPIXEL) != 1)
            return Status(ErrorCode::NOT_SUPPORTED, path + " has one directory for " +
                                                        std::to_string(layout.slices) +
                                                        " slices that are no plain numbers");
        raw.type = *type;
        raw.size = {int(file.number(TIFFTAG_IMAGEWIDTH, 0)),
                    int(file.number(TIFFTAG_IMAGELENGTH, 0)), layout.slices};
        raw.headerBytes = static_cast<std::int64_t>(TIFFGetStrileOffset(file.get(), 0));
        raw.bigEndian = TIFFIsBigEndian(file.get()) != 0;
    }
    const std::int64_t page = core::voxelBytes({raw.size.x, raw.size.y, 1}, raw.type, 1);
    raw.sliceStep = layout.slices > 1 ? layout.page(1, channel, 0) - layout.page(0, channel, 0) : 1;
    const auto open = [=](int step) -> Result<Source> {
        RawName at = raw;
        at.headerBytes += page * layout.page(0, channel, step);
        osg::ref_ptr<RawVoxelSource> source = new RawVoxelSource;
        if (Status status = source->open(at, path); !status.ok()) return status;
        source->setPlace(layout.spacing, layout.origin, layout.axes);
        return Source(source);
    };
    const std::int64_t needed =
        raw.headerBytes + page * layout.slices * layout.channels * layout.steps;
    std::error_code failed;
    const auto found = static_cast<std::int64_t>(std::filesystem::file_size(path, failed));
    if (failed || found < needed)
        return Status(ErrorCode::FILE_UNREADABLE, path + " has " + std::to_string(found) +
                                                      " bytes, where its slices need " +
                                                      std::to_string(needed));
    if (layout.steps == 1) return open(0);
    osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    const CallerReports quiet;
    if (Status status = series->setSteps(layout.steps, open); !status.ok()) return status;
    return Source(series);
}

} // namespace io
} // namespace osgVolumizer

#else

namespace osgVolumizer {
namespace io {

Result<Source> readByLibtiff(const std::string& path, std::optional<int>)
{
    return Status(
        ErrorCode::NOT_SUPPORTED,
        path +
            " is a TIFF with ImageDepth, or of one bit, which this build cannot read: build with "
            "libtiff (Debian: libtiff-dev)");
}

Result<Source> readSinglePage(const std::string& path, const PageLayout&, int)
{
    return Status(ErrorCode::NOT_SUPPORTED,
                  path + " is a TIFF of ImageJ with one directory for all slices, which this build "
                         "cannot read: build with libtiff (Debian: libtiff-dev)");
}

} // namespace io
} // namespace osgVolumizer

#endif
