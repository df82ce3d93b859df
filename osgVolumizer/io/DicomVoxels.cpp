#include "DicomHeader.h"
#include "VoxelFiles.h"

#include "../core/RegularFile.h"
#include "../core/Text.h"
#include "../core/voxels/VoxelData.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace osgVolumizer {
namespace io {

namespace {

struct DicomFile
{
    std::string path;
    DicomHeader header;
};

/// Range of the data values that a file can hold.
core::ValueRange possibleRange(const DicomHeader& h)
{
    const double count = std::ldexp(1.0, h.bitsStored);
    const double low = h.isSigned ? -0.5 * count : 0.0, high = low + count - 1.0;
    const double a = h.slope * low + h.intercept, b = h.slope * high + h.intercept;
    return {std::min(a, b), std::max(a, b)};
}

/// The narrowest type that holds the data values of all files exactly; float32 where they are no
/// integers.
VoxelType commonType(const std::vector<DicomFile>& files)
{
    core::ValueRange range;
    for (const DicomFile& f : files) {
        if (f.header.slope != std::floor(f.header.slope) ||
            f.header.intercept != std::floor(f.header.intercept))
            return VoxelType::FLOAT32;
        range.expand(possibleRange(f.header));
    }
    for (const VoxelType type : {VoxelType::UINT8, VoxelType::INT8, VoxelType::UINT16,
                                 VoxelType::INT16, VoxelType::UINT32, VoxelType::INT32}) {
        double low = 0.0, high = 0.0;
        voxelTypeRange(type, low, high);
        if (range.low >= low && range.high <= high) return type;
    }
    return VoxelType::FLOAT32;
}

/// Along the patient where the files say so, else by instance number, else as they came.
void sortSlices(std::vector<DicomFile>& files)
{
    const auto all = [&](auto known) { return std::all_of(files.begin(), files.end(), known); };
    if (all([](const DicomFile& f) { return f.header.position.has_value(); }))
        std::stable_sort(files.begin(), files.end(), [](const DicomFile& a, const DicomFile& b) {
            return *a.header.position < *b.header.position;
        });
    else if (all([](const DicomFile& f) { return f.header.instance.has_value(); }))
        std::stable_sort(files.begin(), files.end(), [](const DicomFile& a, const DicomFile& b) {
            return *a.header.instance < *b.header.instance;
        });
}

VoxelSource::Description describe(const std::vector<DicomFile>& files)
{
    const DicomHeader& first = files.front().header;
    VoxelSource::Description d;
    d.size = first.size;
    if (files.size() > 1) d.size.z = static_cast<int>(files.size());
    d.type = commonType(files);
    d.axes = first.axes;
    if (!(first.pixelSpacing.x > 0.0)) return d;
    double between = first.sliceSpacing;
    if (files.size() > 1 && first.position && files.back().header.position)
        between = (*files.back().header.position - *first.position) /
                  static_cast<double>(files.size() - 1);
    if (!(between > 0.0)) between = first.pixelSpacing.x;
    d.spacing = glm::dvec3(first.pixelSpacing.x, first.pixelSpacing.y, between);
    return d;
}

/// Data values of pixels as they are stored, little endian.
void toValues(const DicomHeader& h, const unsigned char* pixels, std::vector<double>& values)
{
    const int bytes = h.bitsAllocated / 8, shift = h.highBit + 1 - h.bitsStored;
    const std::int64_t count = std::int64_t(1) << h.bitsStored;
    for (std::size_t i = 0; i < values.size(); ++i, pixels += bytes) {
        std::uint32_t word = 0;
        for (int b = 0; b < bytes; ++b)
            word |= static_cast<std::uint32_t>(pixels[b]) << (8 * b);
        std::int64_t stored = static_cast<std::int64_t>(word >> shift) & (count - 1);
        if (h.isSigned && stored >= count / 2) stored -= count;
        values[i] = h.slope * static_cast<double>(stored) + h.intercept;
    }
}

/// Reads the pixels of a file to `destination`, a row at a time.
Status readPixels(const DicomFile& f, VoxelType type, unsigned char* destination)
{
    const DicomHeader& h = f.header;
    std::ifstream file(f.path, std::ios::binary);
    file.seekg(h.pixelOffset);
    std::vector<double> values(static_cast<std::size_t>(h.size.x));
    std::vector<unsigned char> row(values.size() * static_cast<std::size_t>(h.bitsAllocated / 8));
    for (std::int64_t r = 0; r < std::int64_t(h.size.y) * h.size.z; ++r) {
        if (!file.read(reinterpret_cast<char*>(row.data()),
                       static_cast<std::streamsize>(row.size())))
            return {ErrorCode::FILE_UNREADABLE,
                    f.path + " cannot be read: row " + std::to_string(r) + " of its pixels"};
        toValues(h, row.data(), values);
        core::convertVoxels(values.data(), VoxelType::FLOAT64, destination, type, values.size());
        destination += values.size() * voxelTypeSize(type);
    }
    return {};
}

Result<std::vector<DicomFile>> readHeaders(const std::vector<std::string>& paths)
{
    std::vector<DicomFile> files;
    for (const std::string& path : paths) {
        if (Status status = core::requireRegularFile(path); !status.ok()) return status;
        std::ifstream stream(path, std::ios::binary);
        const Result<DicomHeader> header = readDicomHeader(stream, path);
        if (!header.ok()) return header.status;
        files.push_back({path, *header});
        const glm::ivec3 size = header->size, first = files.front().header.size;
        if (size != first || (paths.size() > 1 && size.z != 1))
            return Status(ErrorCode::SIZE_MISMATCH,
                          path + " has " + core::formatTriple(size) + " pixels, the first slice " +
                              core::formatTriple(first) +
                              (size == first ? ", which is no single slice" : ""));
    }
    return files;
}

} // namespace

bool isDicomFile(const std::string& path)
{
    if (!core::requireRegularFile(path).ok()) return false;
    std::ifstream stream(path, std::ios::binary);
    return stream && isDicom(stream);
}

bool isSliceOfSeries(const std::string& path)
{
    namespace fs = std::filesystem;
    const auto headerOf = [](const std::string& file) -> Result<DicomHeader> {
        if (!isDicomFile(file)) return Status(ErrorCode::NOT_SUPPORTED, file + " is no DICOM file");
        std::ifstream stream(file, std::ios::binary);
        return readDicomHeader(stream, file);
    };
    const Result<DicomHeader> own = headerOf(path);
    if (!own.ok() || own->size.z != 1) return false;
    const fs::path whole = fs::absolute(path);
    std::error_code failed;
    for (fs::directory_iterator i(whole.parent_path(), failed), end; !failed && i != end;
         i.increment(failed)) {
        if (i->path().filename() == whole.filename()) continue;
        const Result<DicomHeader> other = headerOf(i->path().string());
        if (other.ok() && other->series == own->series && other->size == own->size) return true;
    }
    return false;
}

Result<Source> readDicom(const std::vector<std::string>& paths, const Progress& progress)
{
    Result<std::vector<DicomFile>> files = readHeaders(paths);
    if (!files.ok()) return files.status;
    sortSlices(*files);
    const VoxelSource::Description description = describe(*files);
    MemorySource source = new MemoryVoxelSource;
    if (Status status = source->allocate(description); !status.ok())
        return Status(status.code, paths.front() + ": " + status.text);
    const std::int64_t step =
        source->describe().sizeInBytes() / static_cast<std::int64_t>(files->size());
    for (std::size_t i = 0; i < files->size(); ++i) {
        auto* to =
            static_cast<unsigned char*>(source->data()) + step * static_cast<std::int64_t>(i);
        if (Status status = readPixels((*files)[i], description.type, to); !status.ok())
            return status;
        if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(files->size()));
    }
    return Source(source);
}

} // namespace io
} // namespace osgVolumizer
