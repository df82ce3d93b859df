#include "ImageFile.h"
#include "VoxelFiles.h"

#include "../core/Text.h"
#include "../core/voxels/VoxelData.h"

namespace osgVolumizer {
namespace io {

namespace {

constexpr int MAXIMUM_SLICES = 1 << 20;

/// Voxels for slices like those that `file` is at, `slices` of them.
Result<MemorySource> allocate(const ImageFile& file, const PixelFormat& format, int slices)
{
    VoxelSource::Description description;
    description.size = glm::ivec3(file.size().x, file.size().y, slices);
    description.type = format.type;
    description.components = format.components;
    MemorySource source = new MemoryVoxelSource;
    if (Status status = source->allocate(description); !status.ok())
        return Status(status.code, file.path() + ": " + status.text);
    return source;
}

unsigned char* sliceAt(const MemorySource& source, int z)
{
    const VoxelSource::Description d = source->describe();
    return static_cast<unsigned char*>(source->data()) +
           core::voxelBytes({d.size.x, d.size.y, 1}, d.type, d.components) * z;
}

std::int64_t bytesOf(const ImageFile& file, const PixelFormat& format, int slices)
{
    return core::voxelBytes({file.size().x, file.size().y, slices}, format.type, format.components);
}

/// A slice has to be like the first.
Status compare(const ImageFile& file, const std::string& which, const glm::ivec3& size,
               const PixelFormat& format, const std::string& first)
{
    const Result<PixelFormat> own = file.pixelFormat(format.channel);
    if (!own.ok()) return own.status;
    if (file.size() == size && *own == format) return {};
    return {ErrorCode::SIZE_MISMATCH,
            which + " has " + file.text() + ", but the first slice has " + first};
}

void report(const Progress& progress, int done, int all)
{
    if (progress) progress(static_cast<double>(done) / all);
}

Result<Source> readDeep(ImageFile& file, const PixelFormat& format, const Progress& progress)
{
    const int depth = file.size().z;
    if (Status status = file.checkBytes(bytesOf(file, format, depth)); !status.ok()) return status;
    Result<MemorySource> source = allocate(file, format, depth);
    if (!source.ok()) return source.status;
    for (int z = 0; z < depth; z += file.sliceStep()) {
        if (Status status = file.readSlices(format, z, sliceAt(*source, z)); !status.ok())
            return status;
        report(progress, std::min(z + file.sliceStep(), depth), depth);
    }
    return Source(*source);
}

} // namespace

Result<Source> readImage(const std::string& path, std::optional<int> channel,
                         const Progress& progress)
{
    ImageFile file;
    if (Status status = file.open(path); !status.ok()) return status;
    const Result<PixelFormat> format = file.pixelFormat(channel);
    if (!format.ok()) return format.status;
    if (file.size().z > 1) return readDeep(file, *format, progress);

    const glm::ivec3 size = file.size();
    const std::string first = file.text();
    int slices = 1;
    for (; file.seek(slices); ++slices) {
        const std::string which = path + ", subimage " + std::to_string(slices);
        if (Status status = compare(file, which, size, *format, first); !status.ok()) return status;
        if (slices == MAXIMUM_SLICES)
            return Status(ErrorCode::TOO_LARGE,
                          path + " has more than " + std::to_string(slices) + " subimages");
    }
    file.seek(0);
    if (Status status = file.checkBytes(bytesOf(file, *format, slices)); !status.ok())
        return status;
    Result<MemorySource> source = allocate(file, *format, slices);
    if (!source.ok()) return source.status;
    for (int z = 0; z < slices; ++z) {
        if (!file.seek(z))
            return Status(ErrorCode::FILE_UNREADABLE,
                          path + ": slice " + std::to_string(z) + " cannot be found again");
        if (Status status = file.readSlices(*format, 0, sliceAt(*source, z)); !status.ok())
            return status;
        report(progress, z + 1, slices);
    }
    return Source(*source);
}

Result<Source> readStack(const std::vector<std::string>& paths, const Progress& progress)
{
    Result<MemorySource> source(MemorySource{});
    PixelFormat format;
    glm::ivec3 size(0);
    std::string first;
    const int slices = static_cast<int>(paths.size());
    for (int z = 0; z < slices; ++z) {
        ImageFile file;
        if (Status status = file.open(paths[static_cast<std::size_t>(z)]); !status.ok())
            return status;
        if (z == 0) {
            const Result<PixelFormat> own = file.pixelFormat();
            if (!own.ok()) return own.status;
            format = *own;
            size = file.size();
            first = file.text();
            if (size.z != 1)
                return Status(ErrorCode::SIZE_MISMATCH,
                              file.path() + " has " + first + ", which is no single slice");
            source = allocate(file, format, slices);
            if (!source.ok()) return source.status;
        }
        Status status = compare(file, file.path(), size, format, first);
        if (status.ok()) status = file.checkBytes(bytesOf(file, format, 1));
        if (status.ok()) status = file.readSlices(format, 0, sliceAt(*source, z));
        if (!status.ok()) return status;
        report(progress, z + 1, slices);
    }
    return Source(*source);
}

} // namespace io
} // namespace osgVolumizer
