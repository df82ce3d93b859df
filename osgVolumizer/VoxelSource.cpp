#include "VoxelSource.h"

#include "Error.h"
#include "core/NumberRule.h"
#include "core/Text.h"
#include "core/voxels/BrickTree.h"
#include "core/voxels/VoxelData.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace osgVolumizer {

namespace {

Status checkAxis(const VoxelSource::Description& d, int axis)
{
    if (d.size[axis] < 1)
        return {ErrorCode::VALUE_INVALID,
                "volume size " + core::formatTriple(d.size) + " is below 1 on an axis", axis};
    const auto refusal = [axis](const char* what, double value, const core::NumberRule& rule) {
        return Status(ErrorCode::VALUE_INVALID,
                      what + core::formatNumber(value) + ", expected " + rule.expected, axis);
    };
    if (!core::LENGTH.holds(d.spacing[axis]))
        return refusal("voxel spacing is ", d.spacing[axis], core::LENGTH);
    if (!core::POSITION.holds(d.origin[axis]))
        return refusal("volume origin is ", d.origin[axis], core::POSITION);
    return {};
}

} // namespace

std::int64_t VoxelSource::Description::sizeInBytes() const
{
    return core::voxelBytes(size, type, components);
}

Status VoxelSource::Description::validate() const
{
    for (int axis = 0; axis < 3; ++axis)
        if (Status status = checkAxis(*this, axis); !status.ok()) return status;
    const int number = static_cast<int>(type);
    if (number < 0 || number > static_cast<int>(VoxelType::FLOAT64))
        return {ErrorCode::VALUE_INVALID, "voxel type " + std::to_string(number) + " is unknown"};
    if (components != 1 && components != 4)
        return {ErrorCode::VALUE_INVALID,
                "voxels of " + std::to_string(components) + " components, neither 1 nor 4"};
    return {};
}

Status VoxelSource::readLevel(int level, const core::Box3i& region, void* destination) const
{
    if (level == 0) return read(region, destination);
    return {ErrorCode::INDEX_OUT_OF_RANGE,
            "the voxel source has no level " + std::to_string(level)};
}

std::optional<std::pair<double, double>> VoxelSource::levelRange(int level,
                                                                 const core::Box3i& region) const
{
    return level == 0 ? valueRange(region) : std::nullopt;
}

Status VoxelSource::readStep(int step, int level, const core::Box3i& region,
                             void* destination) const
{
    if (step == 0) return readLevel(level, region, destination);
    return {ErrorCode::INDEX_OUT_OF_RANGE,
            "the voxel source has no time step " + std::to_string(step)};
}

std::optional<std::pair<double, double>> VoxelSource::stepRange(int step, int level,
                                                                const core::Box3i& region) const
{
    return step == 0 ? levelRange(level, region) : std::nullopt;
}

Status VoxelSource::readThinned(int level, const core::Box3i& region, void* destination) const
{
    if (level == 0) return read(region, destination);
    if (region.empty()) return {};
    const Description d = describe();
    if (Status status = checkRegion(region, core::BrickTree::levelSize(d.size, level));
        !status.ok())
        return status;
    const std::size_t voxel = voxelTypeSize(d.type) * static_cast<std::size_t>(d.components);
    const auto at = [&](int i, int axis) {
        const std::int64_t place = (std::int64_t(i) << level) + (std::int64_t(1) << (level - 1));
        return static_cast<int>(std::min<std::int64_t>(place, d.size[axis] - 1));
    };
    const int first = at(region.min.x, 0), last = at(region.max.x - 1, 0);
    std::vector<unsigned char> row(std::size_t(last - first + 1) * voxel);
    auto* to = static_cast<unsigned char*>(destination);
    for (int z = region.min.z; z < region.max.z; ++z)
        for (int y = region.min.y; y < region.max.y; ++y) {
            const glm::ivec3 begin(first, at(y, 1), at(z, 2));
            Status status = read({begin, {last + 1, begin.y + 1, begin.z + 1}}, row.data());
            if (!status.ok()) return status;
            for (int x = region.min.x; x < region.max.x; ++x, to += voxel)
                std::memcpy(to, row.data() + std::size_t(at(x, 0) - first) * voxel, voxel);
        }
    return {};
}

Status VoxelSource::checkRegion(const core::Box3i& region, const glm::ivec3& size)
{
    for (int axis = 0; axis < 3; ++axis)
        if (region.min[axis] < 0 || region.max[axis] > size[axis])
            return {ErrorCode::INDEX_OUT_OF_RANGE,
                    "samples " + core::formatTriple(region.min) + " to " +
                        core::formatTriple(region.max) + " are outside the volume of " +
                        core::formatTriple(size),
                    axis};
    return {};
}

MemoryVoxelSource::MemoryVoxelSource(const MemoryVoxelSource& o, const osg::CopyOp& op)
    : VoxelSource(o, op), _description(o._description), _data(o._data)
{
    if (!_data || !(op.getCopyFlags() & osg::CopyOp::DEEP_COPY_OBJECTS)) return;
    _data.reset();
    const Status status = allocate(o._description, o._description.sizeInBytes());
    if (status.ok()) std::memcpy(_data.get(), o._data.get(), o.sizeInBytes());
}

ReportedStatus MemoryVoxelSource::allocate(const Description& description,
                                           std::int64_t maximumBytes)
{
    if (Status status = description.validate(); !status.ok()) return reported(std::move(status));
    const std::int64_t bytes = description.sizeInBytes();
    const std::string what = "a volume of " + core::formatTriple(description.size) +
                             " voxels needs " + std::to_string(bytes) + " bytes, more than ";
    if (bytes > maximumBytes)
        return reported(
            {ErrorCode::TOO_LARGE, what + "the bound of " + std::to_string(maximumBytes)});
    // calloc leaves zeroed pages to the system until they are touched.
    std::shared_ptr<void> data(std::calloc(static_cast<std::size_t>(bytes), 1), std::free);
    if (!data) return reported({ErrorCode::TOO_LARGE, what + "there is memory"});
    _data = std::move(data);
    _description = description;
    return {};
}

ReportedStatus MemoryVoxelSource::setExternal(const Description& description, void* data,
                                              std::function<void()> release)
{
    if (Status status = description.validate(); !status.ok()) return reported(std::move(status));
    if (!data)
        return reported({ErrorCode::VALUE_INVALID, "the pointer to external voxels is null"});
    _data = std::shared_ptr<void>(data, [release = std::move(release)](void*) {
        if (release) release();
    });
    _description = description;
    return {};
}

std::size_t MemoryVoxelSource::sizeInBytes() const
{
    return _data ? static_cast<std::size_t>(_description.sizeInBytes()) : 0;
}

Status MemoryVoxelSource::checkOwnRegion(const core::Box3i& region) const
{
    if (!_data) return {ErrorCode::VALUE_INVALID, "the voxel source has no voxels"};
    return checkRegion(region, _description.size);
}

Status MemoryVoxelSource::read(const core::Box3i& region, void* destination) const
{
    if (Status status = checkOwnRegion(region); !status.ok()) return status;
    core::copyRegion({_data.get(), _description.type, _description.components, _description.size},
                     region, destination);
    return {};
}

VoxelBlock MemoryVoxelSource::share(const core::Box3i& region) const
{
    if (region.empty() || !checkOwnRegion(region).ok()) return {};
    // In one piece: a run of slices, of rows of one slice, or of samples of one row.
    const glm::ivec3 size = region.size();
    const glm::ivec3& all = _description.size;
    const bool wholeRows = size.x == all.x, wholeSlices = wholeRows && size.y == all.y;
    if (!(wholeSlices || (wholeRows && size.z == 1) || (size.y == 1 && size.z == 1))) return {};
    const std::int64_t first =
        region.min.x +
        std::int64_t(all.x) * (region.min.y + std::int64_t(all.y) * std::int64_t(region.min.z));
    const std::int64_t voxel =
        static_cast<std::int64_t>(voxelTypeSize(_description.type)) * _description.components;
    VoxelBlock block;
    block.owner = _data;
    block.data = static_cast<const unsigned char*>(_data.get()) + first * voxel;
    block.bytes = static_cast<std::size_t>(
        core::voxelBytes(size, _description.type, _description.components));
    return block;
}

} // namespace osgVolumizer
