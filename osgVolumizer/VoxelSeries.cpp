#include "VoxelSeries.h"

#include "Error.h"
#include "Paging.h"
#include "core/Text.h"
#include "core/voxels/BrickTree.h"

#include <exception>
#include <list>
#include <map>
#include <mutex>

namespace osgVolumizer {

namespace {

// What is held in memory of a source as long as it is open.
std::int64_t heldBytes(const VoxelSource& source)
{
    const auto* memory = dynamic_cast<const MemoryVoxelSource*>(&source);
    return memory ? static_cast<std::int64_t>(memory->sizeInBytes()) : 0;
}

} // namespace

struct VoxelSeries::Steps
{
    using Source = osg::ref_ptr<VoxelSource>;
    struct Slot
    {
        std::mutex opening; // held while the step is opened, so that it is opened once
        Source source;
    };

    int count = 0;
    Opener opener;
    Description description;
    int levels = 1; // of each source
    int pageSize = 0;

    std::mutex mutex;                           // of what follows
    std::map<int, std::shared_ptr<Slot>> slots; // of steps that are open, or being opened
    std::list<int> order;                       // of those, last used first
    std::int64_t bytes = 0;                     // held of them

    Result<Source> open(int step) const;
    Status matches(const VoxelSource& source, int step) const;
    Result<Source> get(int step);
    Source opened(int step);
    void use(int step);
    void closeOthers();
};

// Whatever opens a step may throw; nothing may pass from here through a thread that reads.
Result<VoxelSeries::Steps::Source> VoxelSeries::Steps::open(int step) const
{
    try {
        Result<Source> source = opener(step);
        if (source.ok() && !source->valid())
            return Status(ErrorCode::FILE_UNREADABLE,
                          "there is no source for time step " + std::to_string(step), step);
        return source;
    } catch (const std::exception& e) {
        return Status(ErrorCode::FILE_UNREADABLE,
                      "time step " + std::to_string(step) + " cannot be opened: " + e.what(), step);
    }
}

Status VoxelSeries::Steps::matches(const VoxelSource& source, int step) const
{
    const Description d = source.describe();
    const std::string what = "time step " + std::to_string(step) + " has ";
    if (d.size != description.size)
        return {ErrorCode::SIZE_MISMATCH,
                what + core::formatTriple(d.size) + " voxels, the first " +
                    core::formatTriple(description.size),
                step};
    if (d.type != description.type || d.components != description.components)
        return {ErrorCode::SIZE_MISMATCH,
                what + std::to_string(d.components) + " components of type " +
                    voxelTypeName(d.type) + ", the first " +
                    std::to_string(description.components) + " of type " +
                    voxelTypeName(description.type),
                step};
    if (source.levelCount() != levels)
        return {ErrorCode::SIZE_MISMATCH,
                what + std::to_string(source.levelCount()) + " levels, the first " +
                    std::to_string(levels),
                step};
    return {};
}

// Expects the mutex.
void VoxelSeries::Steps::use(int step)
{
    order.remove(step);
    order.push_front(step);
}

// Expects the mutex.
void VoxelSeries::Steps::closeOthers()
{
    const std::int64_t room = getPagingBudget().memoryBytes / 4;
    while (order.size() > 2 && (bytes > room || order.size() > std::size_t(MOST_OPEN))) {
        const auto slot = slots.find(order.back());
        if (slot->second->source) bytes -= heldBytes(*slot->second->source);
        slots.erase(slot); // whoever reads from it holds the source
        order.pop_back();
    }
}

Result<VoxelSeries::Steps::Source> VoxelSeries::Steps::get(int step)
{
    std::shared_ptr<Slot> slot;
    {
        std::lock_guard<std::mutex> lock(mutex);
        std::shared_ptr<Slot>& found = slots[step];
        if (!found) found = std::make_shared<Slot>();
        slot = found;
        use(step);
        if (slot->source) return slot->source;
    }
    std::lock_guard<std::mutex> opening(slot->opening);
    {
        std::lock_guard<std::mutex> lock(mutex);
        if (slot->source) return slot->source;
    }
    Result<Source> source = open(step);
    if (source.ok())
        if (Status status = matches(**source, step); !status.ok()) source = status;
    if (!source.ok()) return source;
    std::lock_guard<std::mutex> lock(mutex);
    slot->source = *source;
    const auto found = slots.find(step);
    if (found == slots.end() || found->second != slot) return source; // closed meanwhile
    bytes += heldBytes(**source);
    closeOthers();
    return source;
}

// Null where it is not open.
VoxelSeries::Steps::Source VoxelSeries::Steps::opened(int step)
{
    std::lock_guard<std::mutex> lock(mutex);
    const auto found = slots.find(step);
    return found == slots.end() ? nullptr : found->second->source;
}

VoxelSeries::VoxelSeries(const VoxelSeries& o, const osg::CopyOp& op)
    : VoxelSource(o, op), _steps(o._steps)
{
}

ReportedStatus VoxelSeries::setSteps(int count, Opener opener)
{
    if (count < 1 || !opener)
        return reported({ErrorCode::VALUE_INVALID, std::to_string(count) + " time steps" +
                                                       (opener ? "" : " that nothing opens") +
                                                       ", expected 1 or more"});
    auto steps = std::make_shared<Steps>();
    steps->count = count;
    steps->opener = std::move(opener);
    const Result<osg::ref_ptr<VoxelSource>> first = steps->open(0);
    if (!first.ok()) return reported(first.status);
    steps->description = (*first)->describe();
    if (Status status = steps->description.validate(); !status.ok())
        return reported(std::move(status));
    steps->levels = (*first)->levelCount();
    steps->pageSize = steps->levels > 1 ? (*first)->pageSize() : VoxelSource::pageSize();
    auto slot = std::make_shared<Steps::Slot>();
    slot->source = *first;
    steps->slots[0] = slot;
    steps->order.push_front(0);
    steps->bytes = heldBytes(**first);
    _steps = std::move(steps);
    return {};
}

ReportedStatus VoxelSeries::setSteps(const std::vector<osg::ref_ptr<VoxelSource>>& sources)
{
    return setSteps(static_cast<int>(sources.size()), [sources](int step) {
        return Result<osg::ref_ptr<VoxelSource>>(sources[std::size_t(step)]);
    });
}

VoxelSource::Description VoxelSeries::describe() const
{
    return _steps ? _steps->description : Description();
}

Status VoxelSeries::read(const core::Box3i& region, void* destination) const
{
    return readStep(0, 0, region, destination);
}

std::optional<std::pair<double, double>> VoxelSeries::valueRange(const core::Box3i& region) const
{
    return stepRange(0, 0, region);
}

int VoxelSeries::levelCount() const
{
    if (!_steps) return 1;
    return _steps->levels > 1
               ? _steps->levels
               : core::BrickTree::levelsFor(_steps->description.size, _steps->pageSize);
}

Status VoxelSeries::readLevel(int level, const core::Box3i& region, void* destination) const
{
    return readStep(0, level, region, destination);
}

std::optional<std::pair<double, double>> VoxelSeries::levelRange(int level,
                                                                 const core::Box3i& region) const
{
    return stepRange(0, level, region);
}

int VoxelSeries::pageSize() const
{
    return _steps ? _steps->pageSize : VoxelSource::pageSize();
}

int VoxelSeries::stepCount() const
{
    return _steps ? _steps->count : 1;
}

Status VoxelSeries::readStep(int step, int level, const core::Box3i& region,
                             void* destination) const
{
    if (!_steps || step < 0 || step >= _steps->count)
        return VoxelSource::readStep(step < 1 ? 1 : step, level, region, destination);
    const Result<osg::ref_ptr<VoxelSource>> source = _steps->get(step);
    if (!source.ok()) return source.status;
    return _steps->levels > 1 ? (*source)->readLevel(level, region, destination)
                              : (*source)->readThinned(level, region, destination);
}

std::optional<std::pair<double, double>> VoxelSeries::stepRange(int step, int level,
                                                                const core::Box3i& region) const
{
    if (!_steps || step < 0 || step >= _steps->count) return std::nullopt;
    const osg::ref_ptr<VoxelSource> source = _steps->opened(step);
    if (!source) return std::nullopt;
    if (_steps->levels > 1) return source->levelRange(level, region);
    return level == 0 ? source->valueRange(region) : std::nullopt;
}

} // namespace osgVolumizer
