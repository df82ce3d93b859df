#include "GdalSource.h"

#include "Interpolate.h"
#include "Session.h"

#include <osgVolumizer/Paging.h>
#include <osgVolumizer/core/voxels/BrickTree.h>
#include <osgVolumizer/core/voxels/VoxelData.h>
#include <osgVolumizer/io/NarrowestType.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

namespace osgVolumizer {
namespace gdal {

namespace {

constexpr std::size_t BATCH_BYTES = std::size_t(1) << 25; // of numbers that become values

bool areLongs(const GDALMDArray& array)
{
    return typeOf(array) == VoxelType::FLOAT64 &&
           array.GetDataType().GetNumericDataType() != GDT_Float64;
}

} // namespace

GdalSource::GdalSource(const GdalSource& o, const osg::CopyOp& op)
    : VoxelSource(o, op), _path(o._path), _layout(o._layout), _levelCount(o._levelCount),
      _file(o._file), _variable(o._variable)
{
}

Status GdalSource::open(const std::string& path, const std::string& dataset,
                        const std::string& dimensions)
{
    const Session session;
    const Result<std::shared_ptr<const File>> file = File::open(path);
    if (!file.ok()) return file.status;
    const Result<std::size_t> chosen = (*file)->choose(dataset);
    if (!chosen.ok()) return chosen.status;
    if (Status status = open(path, *file, *chosen, dimensions); !status.ok()) return status;
    if (dataset.empty() && _file->variables().size() > 1)
        _layout.notices.insert(_layout.notices.begin(), _file->variables()[_variable].path +
                                                            " is read, of " + _file->names());
    for (const std::string& notice : _layout.notices)
        OSG_NOTICE << "osgVolumizer: " << path << ": " << notice << std::endl;
    return {};
}

Status GdalSource::open(const std::string& path, const std::shared_ptr<const File>& file,
                        std::size_t variable, const std::string& dimensions)
{
    const Session session;
    const Result<Layout> layout = layoutOf(file->variables()[variable], dimensions, file->driver());
    if (!layout.ok())
        return {layout.status.code, path + ": " + layout.status.text, layout.status.index};
    _path = path;
    _layout = *layout;
    _file = file;
    _variable = variable;
    const std::int64_t most = getPagingBudget().memoryBytes / 2;
    settleType(most);
    if (_layout.steps > 1 || _layout.description.sizeInBytes() > most)
        _levelCount = core::BrickTree::levelsFor(_layout.description.size, pageSize());
    return {};
}

void GdalSource::settleType(std::int64_t mostBytes)
{
    const std::optional<double> filling = _layout.calibration.filling;
    const bool longs = areLongs(*_file->variables()[_variable].array) &&
                       _layout.description.type == VoxelType::FLOAT64 &&
                       _layout.calibration.isPlain();
    if ((!longs && !filling) ||
        double(_layout.description.sizeInBytes()) * _layout.steps > double(mostBytes))
        return;
    for (const Axis& axis : _layout.axes)
        if (!axis.places.empty()) return;
    double low = std::numeric_limits<double>::infinity(), high = -low;
    bool filled = false;
    const bool all = readSlices([&](const std::vector<double>& slice) {
        const auto [least, most] = std::minmax_element(slice.begin(), slice.end());
        low = std::min(low, *least);
        high = std::max(high, *most);
        filled = filling && std::find(slice.begin(), slice.end(), *filling) != slice.end();
        return !filled;
    });
    if (longs && all) {
        const VoxelType least = io::narrowestInteger({low, high}, VoxelType::FLOAT64);
        // GDAL has no numbers of 8 bits with a sign.
        _layout.numbers = least == VoxelType::INT8 ? VoxelType::INT16 : least;
        _layout.description.type = _layout.numbers;
    }
    if (!filled) return;
    _layout.calibration.missing = {*filling};
    _layout.description.type = valueType(_layout.numbers, _layout.calibration, false);
}

// Of the file, as numbers. What cannot be read is found out by others.
bool GdalSource::readSlices(const std::function<bool(const std::vector<double>&)>& visit) const
{
    const glm::ivec3 size = _layout.description.size;
    std::vector<double> slice(std::size_t(size.x) * size.y);
    Fetch fetch[3];
    for (int axis = 0; axis < 2; ++axis)
        fetch[axis] = fetchOf(_layout.axes[axis], 0, size[axis], 0);
    for (int step = 0; step < _layout.steps; ++step)
        for (int z = 0; z < size.z; ++z) {
            fetch[2] = fetchOf(_layout.axes[2], z, z + 1, 0);
            if (!readNumbers(step, fetch, VoxelType::FLOAT64, slice.data()).ok() || !visit(slice))
                return false;
        }
    return true;
}

Status GdalSource::readStep(int step, int level, const core::Box3i& region, void* destination) const
{
    if (!_file) return {ErrorCode::VALUE_INVALID, "the voxel source has no file"};
    if (region.empty()) return {};
    if (step < 0 || step >= _layout.steps)
        return VoxelSource::readStep(step < 1 ? 1 : step, level, region, destination);
    if (level < 0 || level >= _levelCount)
        return VoxelSource::readLevel(level < 1 ? 1 : level, region, destination);
    const glm::ivec3 size = core::BrickTree::levelSize(_layout.description.size, level);
    if (Status status = checkRegion(region, size); !status.ok()) return status;
    try {
        return readFrom(step, level, region, destination);
    } catch (const std::exception& e) {
        return {ErrorCode::FILE_UNREADABLE, _path + " cannot be read: " + e.what()};
    }
}

Status GdalSource::readFrom(int step, int level, const core::Box3i& region, void* destination) const
{
    Fetch fetch[3];
    bool even = true;
    for (int axis = 0; axis < 3; ++axis) {
        fetch[axis] = fetchOf(_layout.axes[axis], region.min[axis], region.max[axis], level);
        even = even && fetch[axis].places.empty();
    }
    const VoxelType type = _layout.description.type;
    if (even && _layout.calibration.isPlain()) return readNumbers(step, fetch, type, destination);
    // Slices together, as many as numbers of the file may take.
    const glm::ivec3 size = region.size();
    const std::size_t slice = std::size_t(fetch[0].count) * fetch[1].count * sizeof(double);
    const int batch = int(std::clamp<std::size_t>(BATCH_BYTES / slice, 1, std::size_t(size.z)));
    auto* to = static_cast<unsigned char*>(destination);
    std::vector<double> samples, values;
    for (int z = region.min.z; z < region.max.z; z += batch) {
        const int end = std::min(z + batch, region.max.z);
        fetch[2] = fetchOf(_layout.axes[2], z, end, level);
        samples.resize(std::size_t(fetch[0].count) * fetch[1].count * fetch[2].count);
        if (Status status = readNumbers(step, fetch, VoxelType::FLOAT64, samples.data());
            !status.ok())
            return status;
        _layout.calibration.apply(samples.data(), samples.size());
        const std::size_t count = std::size_t(size.x) * size.y * (end - z);
        if (!even) {
            values.resize(count);
            interpolate(samples.data(), fetch, values.data());
        }
        core::convertVoxels(even ? samples.data() : values.data(), VoxelType::FLOAT64, to, type,
                            count);
        to += count * voxelTypeSize(type);
    }
    return {};
}

Status GdalSource::readNumbers(int step, const Fetch (&fetch)[3], VoxelType type,
                               void* destination) const
{
    const Session session;
    const GDALMDArray& array = *_file->variables()[_variable].array;
    const std::size_t rank = array.GetDimensionCount();
    std::vector<GUInt64> start(rank, 0);
    std::vector<size_t> count(rank, 1);
    std::vector<GInt64> stride(rank, 1);
    std::vector<GPtrDiff_t> distance(rank, 1);
    if (_layout.time >= 0) start[std::size_t(_layout.time)] = GUInt64(step);
    const std::size_t apart[] = {1, std::size_t(fetch[0].count),
                                 std::size_t(fetch[0].count) * fetch[1].count};
    const auto take = [&](int axis, const Run& run) { // how far in what is read its first one is
        if (const int dimension = _layout.axes[axis].dimension; dimension >= 0) {
            const auto d = std::size_t(dimension);
            start[d] = GUInt64(run.start);
            count[d] = size_t(run.count);
            stride[d] = run.stride;
            distance[d] = GPtrDiff_t(apart[axis]);
        }
        return std::size_t(run.to) * apart[axis];
    };
    const auto as = GDALExtendedDataType::Create(gdalType(type));
    for (const Run& z : fetch[2].runs)
        for (const Run& y : fetch[1].runs)
            for (const Run& x : fetch[0].runs) {
                const std::size_t first = take(2, z) + take(1, y) + take(0, x);
                if (!array.Read(start.data(), count.data(), stride.data(), distance.data(), as,
                                static_cast<unsigned char*>(destination) +
                                    first * voxelTypeSize(type)))
                    return {ErrorCode::FILE_UNREADABLE,
                            _path + ": " + oneLine(_file->variables()[_variable].path) +
                                " cannot be read" + session.reason()};
            }
    return {};
}

} // namespace gdal
} // namespace osgVolumizer
