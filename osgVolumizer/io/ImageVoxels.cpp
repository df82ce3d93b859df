#include "ImageFile.h"
#include "ImageSource.h"
#include "PageLayout.h"
#include "PluginFile.h"
#include "TiffVolume.h"
#include "VoxelFiles.h"

#include "../Paging.h"
#include "../VoxelSeries.h"

#include "../core/Text.h"
#include "../core/voxels/VoxelData.h"

#include <osg/Notify>

namespace osgVolumizer {
namespace io {

namespace {

constexpr int MAXIMUM_SLICES = 1 << 20;

VoxelSource::Description describe(const ImageFile& file, const PixelFormat& format, int slices)
{
    VoxelSource::Description description;
    description.size = glm::ivec3(file.size().x, file.size().y, slices);
    description.type = format.type;
    description.components = format.components;
    return description;
}

Result<MemorySource> allocate(const std::string& path, const VoxelSource::Description& description)
{
    MemorySource source = new MemoryVoxelSource;
    if (Status status = source->allocate(description); !status.ok())
        return Status(status.code, path + ": " + status.text);
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
    Result<MemorySource> source = allocate(file.path(), describe(file, format, depth));
    if (!source.ok()) return source.status;
    for (int z = 0; z < depth; z += file.sliceStep()) {
        if (Status status = file.readSlices(format, z, sliceAt(*source, z)); !status.ok())
            return status;
        report(progress, std::min(z + file.sliceStep(), depth), depth);
    }
    return Source(*source);
}

// How many pages there are, all like the first.
Result<int> countPages(ImageFile& file, const PixelFormat& format)
{
    const glm::ivec3 size = file.size();
    const std::string first = file.text();
    int pages = 1;
    for (; file.seek(pages); ++pages) {
        const std::string which = file.path() + ", subimage " + std::to_string(pages);
        if (Status status = compare(file, which, size, format, first); !status.ok()) return status;
        if (pages == MAXIMUM_SLICES)
            return Status(ErrorCode::TOO_LARGE,
                          file.path() + " has more than " + std::to_string(pages) + " subimages");
    }
    file.seek(0);
    return pages;
}

/// What there is in a file, and how what is asked for is read.
struct Contents
{
    PixelFormat format;
    int pages = 1;
    PageLayout layout;
};

// Channels lie in pages, or side by side in pixels.
Result<Contents> contentsOf(ImageFile& file, std::optional<int> channel)
{
    Contents contents;
    Result<PixelFormat> format = file.pixelFormat();
    if (!format.ok()) return format.status;
    const Result<int> pages = file.size().z > 1 ? Result<int>(1) : countPages(file, *format);
    if (!pages.ok()) return pages.status;
    contents.pages = *pages;
    const OIIO::ImageSpec& spec = file.spec();
    PageLayout::File known;
    known.pages = *pages;
    known.samples = spec.nchannels;
    known.xResolution = spec.get_float_attribute("XResolution");
    known.yResolution = spec.get_float_attribute("YResolution");
    contents.layout =
        PageLayout::parse(spec.get_string_attribute("ImageDescription").c_str(), known);
    const int inPages = contents.layout.channels;
    if (inPages > 1 && channel.value_or(0) >= inPages)
        return Status(ErrorCode::INDEX_OUT_OF_RANGE, file.path() + " has no channel " +
                                                         std::to_string(*channel) + ", but " +
                                                         std::to_string(inPages) + ", from 0 on");
    if (inPages == 1 && channel) format = file.pixelFormat(channel);
    if (!format.ok()) return format.status;
    contents.format = *format;
    if (contents.layout.isSigned && format->type == VoxelType::UINT16) {
        contents.format.type = VoxelType::INT16;
        contents.format.offset = -32768.0;
    }
    return contents;
}

/// The slices of one channel at one time.
struct Pages
{
    std::string path;
    VoxelSource::Description description;
    PixelFormat format;
    std::vector<int> pages;
};

Result<Source> readPages(const Pages& p, const Progress& progress)
{
    if (p.description.sizeInBytes() > getPagingBudget().memoryBytes / 2) {
        osg::ref_ptr<ImageSource> source = new ImageSource;
        Status status = source->open(p.path, p.description, p.format, p.pages);
        if (!status.ok()) return status;
        return Source(source);
    }
    ImageFile file;
    if (Status status = file.open(p.path); !status.ok()) return status;
    Result<MemorySource> source = allocate(p.path, p.description);
    if (!source.ok()) return source.status;
    const int slices = static_cast<int>(p.pages.size());
    for (int z = 0; z < slices; ++z) {
        if (!file.seek(p.pages[std::size_t(z)]))
            return Status(ErrorCode::FILE_UNREADABLE,
                          p.path + ": slice " + std::to_string(z) + " cannot be found again");
        if (Status status = file.readSlices(p.format, 0, sliceAt(*source, z)); !status.ok())
            return status;
        report(progress, z + 1, slices);
    }
    return Source(*source);
}

Result<Source> readSteps(const Pages& first, const PageLayout& layout, int channel,
                         const Progress& progress)
{
    const auto open = [first, layout, channel, progress](int step) {
        Pages p = first;
        for (int z = 0; z < layout.slices; ++z)
            p.pages[std::size_t(z)] = layout.page(z, channel, step);
        return readPages(p, layout.steps == 1 ? progress : Progress());
    };
    if (layout.steps == 1) return open(0);
    osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    const CallerReports quiet;
    Status status = series->setSteps(layout.steps, open);
    if (!status.ok()) return status;
    return Source(series);
}

} // namespace

Result<Source> readImage(const std::string& path, std::optional<int> channel,
                         const Progress& progress)
{
    ImageFile file;
    Status status = file.open(path);
    if (status.code == ErrorCode::NOT_SUPPORTED) return readByLibtiff(path, channel);
    if (!status.ok()) return status;
    const Result<Contents> found = contentsOf(file, channel);
    if (!found.ok()) return found.status;
    const PageLayout& layout = found->layout;
    for (const std::string& notice : layout.notices)
        OSG_NOTICE << "osgVolumizer: " << path << ": " << notice << std::endl;
    if (layout.channels > 1 && !channel)
        OSG_NOTICE << "osgVolumizer: " << path << " has " << layout.channels
                   << " channels, of which the first is shown: channel=0 to " << layout.channels - 1
                   << " choose" << std::endl;
    const int samples = file.spec().nchannels;
    if (layout.channels == 1 && samples > 1 && !channel && found->format.channels == 1)
        OSG_NOTICE << "osgVolumizer: " << path << " has " << samples
                   << " channels, of which the first is shown: channel=0 to " << samples - 1
                   << " choose" << std::endl;
    if (file.size().z > 1) return readDeep(file, found->format, progress);
    const int inPages = layout.channels > 1 ? channel.value_or(0) : 0;
    if (layout.single) return readSinglePage(path, layout, inPages);
    status = file.checkBytes(bytesOf(file, found->format, found->pages));
    if (!status.ok()) return status;
    Pages first{path, describe(file, found->format, layout.slices), found->format, {}};
    first.description.spacing = layout.spacing;
    first.description.origin = layout.origin;
    first.description.axes = layout.axes;
    first.pages.resize(std::size_t(layout.slices));
    return readSteps(first, layout, inPages, progress);
}

Result<VolumeEntry> listImage(const std::string& path, std::optional<int> channel)
{
    ImageFile file;
    Status status = file.open(path);
    if (status.code == ErrorCode::NOT_SUPPORTED) {
        const Result<Source> source = readByLibtiff(path, channel);
        return source.ok() ? Result<VolumeEntry>(entryOf(**source, "")) : source.status;
    }
    if (!status.ok()) return status;
    const Result<Contents> found = contentsOf(file, channel);
    if (!found.ok()) return found.status;
    const PageLayout& layout = found->layout;
    VolumeEntry entry;
    entry.size = {file.size().x, file.size().y, std::max(file.size().z, layout.slices)};
    entry.type = found->format.type;
    entry.channels = layout.channels > 1 ? layout.channels : file.spec().nchannels;
    entry.steps = layout.steps;
    if (!layout.unit.empty()) entry.text = "lengths in " + layout.unit;
    return entry;
}

Result<Source> readStack(const std::vector<std::string>& paths, std::optional<int> channel,
                         const Progress& progress)
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
            const Result<PixelFormat> own = file.pixelFormat(channel);
            if (!own.ok()) return own.status;
            format = *own;
            size = file.size();
            first = file.text();
            if (size.z != 1)
                return Status(ErrorCode::SIZE_MISMATCH,
                              file.path() + " has " + first + ", which is no single slice");
            source = allocate(file.path(), describe(file, format, slices));
            if (!source.ok()) return source.status;
        }
        Status status = compare(file, file.path(), size, format, first);
        if (status.ok() && file.seek(1)) {
            status = {ErrorCode::SIZE_MISMATCH,
                      file.path() + " has several pages, and is no single slice"};
            if (z == 0) status.text += ": with series=on files are time steps";
        }
        if (status.ok()) file.seek(0);
        if (status.ok()) status = file.checkBytes(bytesOf(file, format, 1));
        if (status.ok()) status = file.readSlices(format, 0, sliceAt(*source, z));
        if (!status.ok()) return status;
        report(progress, z + 1, slices);
    }
    return Source(*source);
}

} // namespace io
} // namespace osgVolumizer
