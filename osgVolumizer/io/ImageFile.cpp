#include "ImageFile.h"

#include "Brightness.h"

#include "../core/RegularFile.h"
#include "../core/Text.h"
#include "../core/voxels/VoxelData.h"
#include "../core/voxels/VoxelDispatch.h"
#include "OiioTypes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <vector>

namespace osgVolumizer {
namespace io {

namespace {

/// No compression that images use packs more densely than this; what claims to is broken.
constexpr std::int64_t HIGHEST_COMPRESSION = 1 << 20;

std::int64_t fileBytes(const std::string& path)
{
    std::error_code failed;
    const std::uintmax_t bytes = std::filesystem::file_size(path, failed);
    return failed ? 0 : static_cast<std::int64_t>(bytes);
}

bool isRgba(const OIIO::ImageSpec& spec)
{
    return spec.nchannels >= 4 && spec.alpha_channel == 3;
}

bool isRgb(const OIIO::ImageSpec& spec)
{
    return spec.nchannels >= 3 && spec.channel_name(0) == "R" && spec.channel_name(1) == "G" &&
           spec.channel_name(2) == "B";
}

bool voxelTypeOf(const OIIO::TypeDesc& type, VoxelType& voxel)
{
    switch (type.basetype) {
    case OIIO::TypeDesc::UINT8:
        voxel = VoxelType::UINT8;
        return true;
    case OIIO::TypeDesc::INT8:
        voxel = VoxelType::INT8;
        return true;
    case OIIO::TypeDesc::UINT16:
        voxel = VoxelType::UINT16;
        return true;
    case OIIO::TypeDesc::INT16:
        voxel = VoxelType::INT16;
        return true;
    case OIIO::TypeDesc::UINT32:
        voxel = VoxelType::UINT32;
        return true;
    case OIIO::TypeDesc::INT32:
        voxel = VoxelType::INT32;
        return true;
    case OIIO::TypeDesc::HALF:
        voxel = VoxelType::HALF;
        return true;
    case OIIO::TypeDesc::FLOAT:
        voxel = VoxelType::FLOAT32;
        return true;
    // No voxel type is wide enough: the nearest numbers.
    case OIIO::TypeDesc::UINT64:
    case OIIO::TypeDesc::INT64:
    case OIIO::TypeDesc::DOUBLE:
        voxel = VoxelType::FLOAT64;
        return true;
    default:
        return false;
    }
}

/// By how many bits OpenImageIO has widened the integers of a TIFF, by repeating them.
int widenedBits(const OIIO::ImageSpec& spec, const TiffTags& tags)
{
    const int bits = static_cast<int>(std::min<std::uint64_t>(tags.bitsPerSample, 64)),
              wide = static_cast<int>(spec.format.size()) * 8;
    const bool integers =
        spec.format == OIIO::TypeDesc::UINT8 || spec.format == OIIO::TypeDesc::UINT16;
    const bool palette = spec.get_string_attribute("tiff:ColorSpace") == "palette";
    return integers && !palette && bits > 0 && bits < wide ? wide - bits : 0;
}

template <class T>
void toVoxels(const void* pixels, const PixelFormat& format, std::size_t count, void* destination)
{
    const T* from = static_cast<const T*>(pixels);
    std::vector<double> row(std::min<std::size_t>(count, 4096));
    const std::size_t voxel = voxelTypeSize(format.type);
    const std::size_t step = static_cast<std::size_t>(
        format.components == 4 ? 1 : format.channels); // RGBA: every channel for itself
    const int channels = format.components == 4 ? 1 : format.channels;
    const double scale = std::ldexp(1.0, -format.shift),
                 highest = std::ldexp(1.0, 8 - format.shift) - 1.0;
    for (std::size_t done = 0; done < count; done += row.size()) {
        row.resize(std::min(row.size(), count - done));
        for (std::size_t i = 0; i < row.size(); ++i)
            row[i] = brightness(from + (done + i) * step, channels) * scale + format.offset;
        if (format.shift || format.inverted)
            std::for_each(row.begin(), row.end(), [&](double& v) {
                v = format.inverted ? highest - std::floor(v) : std::floor(v);
            });
        core::convertVoxels(row.data(), VoxelType::FLOAT64,
                            static_cast<unsigned char*>(destination) + done * voxel, format.type,
                            row.size());
    }
}

} // namespace

Status ImageFile::open(const std::string& path)
{
    _path = path;
    if (Status status = core::requireRegularFile(path); !status.ok()) return status;
    try {
        OIIO::ImageSpec config;
        config.attribute("oiio:UnassociatedAlpha", 1); // voxels are as they are stored
        OIIO::geterror();
        _input = OIIO::ImageInput::open(path, &config);
    } catch (const std::exception& e) {
        return {ErrorCode::FILE_UNREADABLE, path + " cannot be opened: " + oneLine(e.what())};
    }
    if (!_input)
        return {ErrorCode::FILE_UNREADABLE,
                path + ", of " + std::to_string(fileBytes(path)) +
                    " bytes, cannot be opened as an image: " + oneLine(OIIO::geterror())};
    if (std::string(_input->format_name()) == "tiff") {
        std::ifstream file(path, std::ios::binary);
        _tags = TiffTags::read(file);
        if (_tags.lostPage)
            return {ErrorCode::FILE_UNREADABLE, path + ", of " + std::to_string(fileBytes(path)) +
                                                    " bytes, is cut short: page " +
                                                    std::to_string(*_tags.lostPage) +
                                                    " lies beyond its end"};
        // Where the standard says one bit for want of a number, it says eight.
        if (_tags.bitsPerSample == 1 && spec().get_int_attribute("oiio:BitsPerSample") != 1)
            return {ErrorCode::NOT_SUPPORTED,
                    path +
                        " has pixels of one bit, and does not say so; one that does can be read"};
        if (_tags.imageDepth != static_cast<std::uint64_t>(std::max(size().z, 1)))
            return {ErrorCode::NOT_SUPPORTED,
                    path + " has ImageDepth " + std::to_string(_tags.imageDepth) +
                        "; a 3D TIFF with a page for each slice can be read"};
    }
    const glm::ivec3 s = size();
    if (s.x < 1 || s.y < 1 || s.z < 1 || spec().nchannels < 1)
        return {ErrorCode::FILE_UNREADABLE, path + " has " + text()};
    return {};
}

bool ImageFile::seek(int subimage)
{
    try {
        const bool found = _input->seek_subimage(subimage, 0);
        if (found) _subimage = subimage;
        _input->geterror(); // the end is no error
        return found;
    } catch (const std::exception&) {
        return false;
    }
}

glm::ivec3 ImageFile::size() const
{
    return {spec().width, spec().height, spec().depth};
}

std::string ImageFile::text() const
{
    return core::formatTriple(size()) + " pixels of " + std::to_string(spec().nchannels) + " x " +
           spec().format.c_str();
}

Result<PixelFormat> ImageFile::pixelFormat(std::optional<int> channel) const
{
    PixelFormat format;
    // Channels of different types come as the widest of them.
    format.read = spec().format;
    if (!voxelTypeOf(format.read, format.type))
        return Status(ErrorCode::NOT_SUPPORTED, _path + " has pixels of type " +
                                                    spec().format.c_str() +
                                                    ", which is no voxel type");
    format.channel = channel;
    if (std::string(_input->format_name()) == "tiff") format.shift = widenedBits(spec(), _tags);
    format.inverted = spec().format == OIIO::TypeDesc::UINT8 && _tags.minIsWhite;
    if (channel && *channel >= spec().nchannels)
        return Status(ErrorCode::INDEX_OUT_OF_RANGE,
                      _path + " has no channel " + std::to_string(*channel) + ", but " +
                          std::to_string(spec().nchannels) + ", from 0 on");
    format.first = channel.value_or(0);
    if (channel) return format;
    format.components = isRgba(spec()) ? 4 : 1;
    format.channels = isRgba(spec()) ? 4 : isRgb(spec()) ? 3 : 1;
    return format;
}

int ImageFile::sliceStep() const
{
    return spec().tile_width > 0 ? std::max(spec().tile_depth, 1) : 1;
}

bool ImageFile::readPixels(const PixelFormat& format, const Part& p, void* destination)
{
    const OIIO::ImageSpec& s = spec();
    const int first = format.first, last = first + format.channels;
    const bool tiled = s.tile_width > 0;
    const bool read =
        tiled ? _input->read_tiles(_subimage, 0, s.x, s.x + s.width, s.y + p.y0, s.y + p.y1,
                                   s.z + p.z0, s.z + p.z1, first, last, format.read, destination)
              : _input->read_scanlines(_subimage, 0, s.y + p.y0, s.y + p.y1, s.z + p.z0, first,
                                       last, format.read, destination);
    // A TIFF strip that is cut short is filled with zeros and only noted.
    return read && !_input->has_error();
}

Status ImageFile::readSlices(const PixelFormat& format, int z, void* destination)
{
    return readPart(format, {0, spec().height, z, std::min(z + sliceStep(), spec().depth)},
                    destination);
}

Status ImageFile::readRows(const PixelFormat& format, int begin, int end, void* destination)
{
    const int tile = spec().tile_width > 0 ? std::max(spec().tile_height, 1) : 1;
    const int from = begin / tile * tile;
    const int to = std::min((end + tile - 1) / tile * tile, spec().height);
    if (from == begin && to == end) return readPart(format, {begin, end, 0, 1}, destination);
    const auto row = static_cast<std::size_t>(
        core::voxelBytes({spec().width, 1, 1}, format.type, format.components));
    std::vector<unsigned char> tiles(row * std::size_t(to - from));
    Status status = readPart(format, {from, to, 0, 1}, tiles.data());
    if (status.ok())
        std::memcpy(destination, tiles.data() + row * std::size_t(begin - from),
                    row * std::size_t(end - begin));
    return status;
}

Status ImageFile::readPart(const PixelFormat& format, const Part& part, void* destination)
{
    const Status failed(ErrorCode::FILE_UNREADABLE,
                        _path + ", of " + std::to_string(fileBytes(_path)) + " bytes: slice " +
                            std::to_string(_subimage + part.z0) + " cannot be read: ");
    try {
        if (format.direct()) {
            if (readPixels(format, part, destination)) return {};
            return {failed.code, failed.text + reason()};
        }
        const std::size_t pixels = static_cast<std::size_t>(
            core::sampleCount({spec().width, part.y1 - part.y0, part.z1 - part.z0}));
        std::vector<unsigned char> buffer(pixels * static_cast<std::size_t>(format.channels) *
                                          format.read.size());
        if (!readPixels(format, part, buffer.data())) return {failed.code, failed.text + reason()};
        const std::size_t values = pixels * static_cast<std::size_t>(format.components);
        if (format.read == OIIO::TypeDesc::UINT64)
            toVoxels<std::uint64_t>(buffer.data(), format, values, destination);
        else if (format.read == OIIO::TypeDesc::INT64)
            toVoxels<std::int64_t>(buffer.data(), format, values, destination);
        else
            core::visitVoxelType(format.type, [&](auto tag) {
                toVoxels<decltype(tag)>(buffer.data(), format, values, destination);
            });
    } catch (const std::exception& e) {
        return {failed.code, failed.text + oneLine(e.what())};
    }
    return {};
}

Status ImageFile::checkBytes(std::int64_t voxelBytes) const
{
    const std::int64_t found = fileBytes(_path);
    const bool plain = spec().get_string_attribute("compression") == "none";
    if (_tags.bitsPerSample < 8)
        voxelBytes = voxelBytes * static_cast<std::int64_t>(_tags.bitsPerSample) / 8;
    if (voxelBytes / (plain ? 1 : HIGHEST_COMPRESSION) <= found) return {};
    return {ErrorCode::FILE_UNREADABLE,
            _path + " has " + std::to_string(found) + " bytes, where its voxels need " +
                (plain ? "" : "even compressed ") +
                std::to_string(voxelBytes / (plain ? 1 : HIGHEST_COMPRESSION))};
}

std::string ImageFile::reason() const
{
    return oneLine(_input->geterror());
}

} // namespace io
} // namespace osgVolumizer
