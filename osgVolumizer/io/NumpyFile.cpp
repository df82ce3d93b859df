#include "NumpyHeader.h"
#include "RawVoxelSource.h"
#include "VoxelFiles.h"

#include "../VoxelSeries.h"
#include "../core/RegularFile.h"

#include <filesystem>
#include <fstream>

namespace osgVolumizer {
namespace io {

namespace {

Result<NumpyHeader> headerOf(const std::string& path)
{
    std::string head(std::size_t(64) << 10, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(file.gcount()));
    Result<NumpyHeader> header = NumpyHeader::parse(head);
    if (!header.ok()) return Status(header.status.code, path + " " + header.status.text);
    return header;
}

} // namespace

Result<Source> readNumpy(const std::string& path, const Progress& progress)
{
    if (Status status = core::requireRegularFile(path); !status.ok()) return status;
    const Result<NumpyHeader> header = headerOf(path);
    if (!header.ok()) return header.status;
    const std::int64_t step = header->raw.fileBytes() - header->raw.headerBytes;
    std::error_code failed;
    const auto found = static_cast<std::int64_t>(std::filesystem::file_size(path, failed));
    if (failed || (found - header->raw.headerBytes) / header->steps < step)
        return Status(ErrorCode::FILE_UNREADABLE,
                      path + " has " + std::to_string(found) + " bytes, where its array needs " +
                          std::to_string(header->steps) + " times " + std::to_string(step));
    const auto open = [raw = header->raw, step, path](int i) -> Result<Source> {
        RawName at = raw;
        at.headerBytes += step * i;
        const osg::ref_ptr<RawVoxelSource> source = new RawVoxelSource;
        if (Status status = source->open(at, path); !status.ok()) return status;
        return Source(source);
    };
    if (progress) progress(1.0);
    if (header->steps == 1) return open(0);
    osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    const CallerReports quiet;
    Status status = series->setSteps(header->steps, open);
    if (!status.ok()) return Status(status.code, path + ": " + status.text);
    return Source(series);
}

} // namespace io
} // namespace osgVolumizer
