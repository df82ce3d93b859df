#include "EditableVoxelSource.h"

#include "Voxels.h"
#include "core/voxels/BrickTree.h"
#include "core/voxels/ChangeLog.h"

#include <glm/common.hpp>

#include <cstring>
#include <exception>
#include <mutex>
#include <new>
#include <string>

namespace osgVolumizer {

struct EditableVoxelSource::Block
{
    std::vector<unsigned char> samples;
    core::ValueRange range;
    bool written = false; // else the same as the base's
};

namespace {

std::int64_t blockCount(const core::Box3i& blocks)
{
    return core::sampleCount(blocks.size());
}

// The blocks that have samples of a region.
core::Box3i blocksOf(const core::Box3i& region)
{
    constexpr int BLOCK = EditableVoxelSource::BLOCK;
    if (region.empty()) return {};
    return {region.min / BLOCK, (region.max - 1) / BLOCK + 1};
}

// What of the next level stands for samples.
core::Box3i coarser(const core::Box3i& region)
{
    return {region.min / 2, (region.max + 1) / 2};
}

// Copies samples of `part` from one box of tightly packed samples to another.
void copyPart(const unsigned char* from, const core::Box3i& fromBox, unsigned char* to,
              const core::Box3i& toBox, const core::Box3i& part, std::size_t voxel)
{
    const auto offset = [voxel](const core::Box3i& box, const glm::ivec3& p) {
        const glm::ivec3 at = p - box.min, size = box.size();
        return voxel * (std::size_t(at.x) +
                        std::size_t(size.x) *
                            (std::size_t(at.y) + std::size_t(size.y) * std::size_t(at.z)));
    };
    const std::size_t row = voxel * std::size_t(part.size().x);
    for (int z = part.min.z; z < part.max.z; ++z)
        for (int y = part.min.y; y < part.max.y; ++y)
            std::memcpy(to + offset(toBox, {part.min.x, y, z}),
                        from + offset(fromBox, {part.min.x, y, z}), row);
}

std::size_t voxelSize(const VoxelSource::Description& d)
{
    return voxelTypeSize(d.type) * static_cast<std::size_t>(d.components);
}

Status noBase()
{
    return {ErrorCode::VALUE_INVALID, "the editable voxel source has no voxels"};
}

} // namespace

std::size_t EditableVoxelSource::KeyHash::operator()(const Key& key) const
{
    std::size_t hash = static_cast<std::size_t>(key.level);
    for (int axis = 0; axis < 3; ++axis)
        hash = hash * 1000003u ^ static_cast<std::size_t>(key.block[axis]);
    return hash;
}

EditableVoxelSource::EditableVoxelSource(const EditableVoxelSource& o, const osg::CopyOp& op)
    : VoxelSource(o, op),
      _base(dynamic_cast<VoxelSource*>(op(static_cast<const osg::Object*>(o._base.get())))),
      _maximumBytes(o._maximumBytes), _levelRule(o._levelRule)
{
    std::shared_lock<std::shared_mutex> lock(o._mutex);
    _blocks = o._blocks;
    _bytes = o._bytes;
}

bool EditableVoxelSource::isChanged() const
{
    std::shared_lock<std::shared_mutex> lock(_mutex);
    for (const auto& block : _blocks)
        if (block.second->written) return true;
    return false;
}

std::size_t EditableVoxelSource::getBytes() const
{
    std::shared_lock<std::shared_mutex> lock(_mutex);
    return _bytes;
}

core::Box3i EditableVoxelSource::samplesOf(const Key& key) const
{
    const core::Box3i all{glm::ivec3(0), core::BrickTree::levelSize(describe().size, key.level)};
    return intersection(core::Box3i{BLOCK * key.block, BLOCK * (key.block + 1)}, all);
}

// Calls function(block, its samples, those in the region) for each block in memory. Returns whether
// these have all of the region. Expects the lock.
template <class Function>
bool EditableVoxelSource::forOwnBlocks(int level, const core::Box3i& region,
                                       Function&& function) const
{
    const core::Box3i blocks = blocksOf(region);
    std::int64_t found = 0;
    const auto visit = [&](const Key& key, const BlockPtr& block) {
        ++found;
        const core::Box3i samples = samplesOf(key);
        function(block, samples, intersection(samples, region));
    };
    if (blockCount(blocks) > static_cast<std::int64_t>(_blocks.size())) {
        for (const auto& block : _blocks) {
            const glm::ivec3& c = block.first.block;
            if (block.first.level == level && !intersection(blocks, {c, c + 1}).empty())
                visit(block.first, block.second);
        }
        return found == blockCount(blocks);
    }
    Key key{level, glm::ivec3(0)};
    for (key.block.z = blocks.min.z; key.block.z < blocks.max.z; ++key.block.z)
        for (key.block.y = blocks.min.y; key.block.y < blocks.max.y; ++key.block.y)
            for (key.block.x = blocks.min.x; key.block.x < blocks.max.x; ++key.block.x)
                if (const auto block = _blocks.find(key); block != _blocks.end())
                    visit(key, block->second);
    return found == blockCount(blocks);
}

// The blocks of all levels that writing to a region of level 0 changes, and that are not in memory.
std::vector<EditableVoxelSource::Key> EditableVoxelSource::missing(const core::Box3i& region) const
{
    std::vector<Key> keys;
    std::shared_lock<std::shared_mutex> lock(_mutex);
    core::Box3i part = region;
    for (int level = 0; level < levelCount(); ++level, part = coarser(part)) {
        const core::Box3i blocks = blocksOf(part);
        Key key{level, glm::ivec3(0)};
        for (key.block.z = blocks.min.z; key.block.z < blocks.max.z; ++key.block.z)
            for (key.block.y = blocks.min.y; key.block.y < blocks.max.y; ++key.block.y)
                for (key.block.x = blocks.min.x; key.block.x < blocks.max.x; ++key.block.x)
                    if (_blocks.find(key) == _blocks.end()) keys.push_back(key);
    }
    return keys;
}

Status EditableVoxelSource::readBlock(const Key& key, BlockPtr& block) const
{
    const Description d = describe();
    const core::Box3i samples = samplesOf(key);
    block = std::make_shared<Block>();
    block->samples.resize(
        static_cast<std::size_t>(core::voxelBytes(samples.size(), d.type, d.components)));
    Status status = _base->readLevel(key.level, samples, block->samples.data());
    if (status.ok())
        block->range = core::scanRange(
            {block->samples.data(), d.type, d.components, samples.size()}, d.components - 1);
    return status;
}

Status EditableVoxelSource::readBlocks(const std::vector<Key>& keys)
{
    std::vector<BlockPtr> blocks(keys.size());
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (Status status = readBlock(keys[i], blocks[i]); !status.ok()) return status;
        bytes += blocks[i]->samples.size();
    }
    const std::unique_lock<std::shared_mutex> lock(_mutex);
    for (std::size_t i = 0; i < keys.size(); ++i)
        _blocks[keys[i]] = blocks[i];
    _bytes += bytes;
    return {};
}

Status EditableVoxelSource::hold(const core::Box3i& region)
{
    if (!_base) return noBase();
    const Description d = describe();
    if (Status status = checkRegion(region, d.size); !status.ok()) return status;
    try { // a user's source may throw
        const std::vector<Key> keys = missing(region);
        const std::size_t block = std::size_t(BLOCK) * BLOCK * BLOCK * voxelSize(d);
        if (keys.size() * block > _maximumBytes || getBytes() > _maximumBytes - keys.size() * block)
            return {ErrorCode::TOO_LARGE, "changed voxels would take more than the bound of " +
                                              std::to_string(_maximumBytes) + " bytes"};
        return readBlocks(keys);
    } catch (const std::bad_alloc&) {
        return {ErrorCode::TOO_LARGE, "there is no memory for changed voxels"};
    } catch (const std::exception& e) {
        return {ErrorCode::FILE_UNREADABLE, std::string("the voxel source threw: ") + e.what()};
    } catch (...) {
        return {ErrorCode::FILE_UNREADABLE, "the voxel source threw"};
    }
}

// Leaves out blocks that are not in memory.
void EditableVoxelSource::paste(int level, const core::Box3i& region, const unsigned char* samples)
{
    const Description d = describe();
    const core::Box3i blocks = blocksOf(region);
    Key key{level, glm::ivec3(0)};
    const std::unique_lock<std::shared_mutex> lock(_mutex);
    for (key.block.z = blocks.min.z; key.block.z < blocks.max.z; ++key.block.z)
        for (key.block.y = blocks.min.y; key.block.y < blocks.max.y; ++key.block.y)
            for (key.block.x = blocks.min.x; key.block.x < blocks.max.x; ++key.block.x) {
                const auto found = _blocks.find(key);
                if (found == _blocks.end()) continue;
                BlockPtr& block = found->second;
                if (_editing) _before.emplace(key, block);
                // Someone else has it as it was.
                if (block.use_count() > 1) block = std::make_shared<Block>(*block);
                const core::Box3i own = samplesOf(key);
                copyPart(samples, region, block->samples.data(), own, intersection(own, region),
                         voxelSize(d));
                block->range = core::scanRange(
                    {block->samples.data(), d.type, d.components, own.size()}, d.components - 1);
                block->written = true;
            }
}

Status EditableVoxelSource::write(const core::Box3i& region, const void* samples)
{
    if (!_base) return noBase();
    if (Status status = checkRegion(region, describe().size); !status.ok()) return status;
    if (region.empty()) return {};
    if (!missing(region).empty())
        return {ErrorCode::VALUE_INVALID, "voxels are written to that are not held"};
    paste(0, region, static_cast<const unsigned char*>(samples));
    return {};
}

void EditableVoxelSource::updateLevels(const std::vector<core::Box3i>& changed)
{
    if (levelCount() <= 1 || !_base) return;
    const Description d = describe();
    std::vector<core::Box3i> boxes = changed;
    std::vector<unsigned char> fine, coarse;
    for (int level = 1; level < levelCount(); ++level) {
        const core::Box3i all{glm::ivec3(0), core::BrickTree::levelSize(d.size, level - 1)};
        for (core::Box3i& box : boxes)
            box = coarser(box);
        boxes = core::coveringBoxes(boxes);
        for (const core::Box3i& box : boxes) {
            const core::Box3i below = intersection(core::Box3i{2 * box.min, 2 * box.max}, all);
            fine.resize(std::size_t(core::sampleCount(below.size())) * voxelSize(d));
            coarse.resize(std::size_t(core::sampleCount(box.size())) * voxelSize(d));
            if (!readLevel(level - 1, below, fine.data()).ok()) continue; // not held
            core::downsample(fine.data(), below.size(), d.type, d.components, _levelRule,
                             coarse.data());
            paste(level, box, coarse.data());
        }
    }
}

void EditableVoxelSource::beginEdit()
{
    const std::unique_lock<std::shared_mutex> lock(_mutex);
    _editing = true;
    _before.clear();
}

EditableVoxelSource::Edit EditableVoxelSource::endEdit(std::vector<core::Box3i> boxes)
{
    Edit edit;
    edit._boxes = std::move(boxes);
    const std::unique_lock<std::shared_mutex> lock(_mutex);
    for (const auto& before : _before) {
        const auto found = _blocks.find(before.first);
        if (found == _blocks.end()) continue; // another's undo has taken it back
        const BlockPtr& after = found->second;
        edit._changes.push_back({before.first.level, before.first.block, before.second, after});
        edit._bytes += before.second->samples.size() + after->samples.size();
    }
    _editing = false;
    _before.clear();
    return edit;
}

void EditableVoxelSource::put(const Edit& edit, bool after)
{
    const std::unique_lock<std::shared_mutex> lock(_mutex);
    for (const Edit::Change& change : edit._changes) {
        const BlockPtr& block = after ? change.after : change.before;
        BlockPtr& own = _blocks[{change.level, change.block}];
        if (own) _bytes -= own->samples.size();
        _bytes += block->samples.size();
        own = block;
        if (block->written) continue;
        _bytes -= block->samples.size();
        _blocks.erase({change.level, change.block}); // the base has the same
    }
}

void EditableVoxelSource::undo(const Edit& edit)
{
    put(edit, false);
}

void EditableVoxelSource::redo(const Edit& edit)
{
    put(edit, true);
}

VoxelSource::Description EditableVoxelSource::describe() const
{
    return _base ? _base->describe() : Description();
}

int EditableVoxelSource::levelCount() const
{
    return _base ? _base->levelCount() : 1;
}

int EditableVoxelSource::pageSize() const
{
    return _base ? _base->pageSize() : VoxelSource::pageSize();
}

Status EditableVoxelSource::read(const core::Box3i& region, void* destination) const
{
    return readLevel(0, region, destination);
}

Status EditableVoxelSource::readLevel(int level, const core::Box3i& region, void* destination) const
{
    if (!_base) return noBase();
    if (region.empty()) return {};
    const Description d = describe();
    auto* to = static_cast<unsigned char*>(destination);
    const auto copyOwn = [&]() {
        std::shared_lock<std::shared_mutex> lock(_mutex);
        return forOwnBlocks(
            level, region,
            [&](const BlockPtr& block, const core::Box3i& own, const core::Box3i& part) {
                copyPart(block->samples.data(), own, to, region, part, voxelSize(d));
            });
    };
    if (level >= 0 && level < levelCount() &&
        checkRegion(region, core::BrickTree::levelSize(d.size, level)).ok() && copyOwn())
        return {};
    Status status = _base->readLevel(level, region, destination);
    if (status.ok()) copyOwn();
    return status;
}

VoxelBlock EditableVoxelSource::share(const core::Box3i& region) const
{
    if (!_base) return {};
    {
        std::shared_lock<std::shared_mutex> lock(_mutex);
        bool any = false;
        forOwnBlocks(0, region,
                     [&](const BlockPtr&, const core::Box3i&, const core::Box3i&) { any = true; });
        if (any) return {};
    }
    return _base->share(region);
}

std::optional<std::pair<double, double>>
EditableVoxelSource::valueRange(const core::Box3i& region) const
{
    return levelRange(0, region);
}

std::optional<std::pair<double, double>>
EditableVoxelSource::levelRange(int level, const core::Box3i& region) const
{
    if (!_base || level < 0 || level >= levelCount() || region.empty()) return std::nullopt;
    const glm::ivec3 size = describe().size;
    core::Box3i all = region; // of level 0
    for (int axis = 0; axis < 3; ++axis) {
        all.min[axis] = static_cast<int>(
            std::min<std::int64_t>(std::int64_t(region.min[axis]) << level, size[axis]));
        all.max[axis] = static_cast<int>(
            std::min<std::int64_t>(std::int64_t(region.max[axis]) << level, size[axis]));
    }
    core::ValueRange range;
    {
        std::shared_lock<std::shared_mutex> lock(_mutex);
        const auto expand = [&](const BlockPtr& block, const core::Box3i&, const core::Box3i&) {
            range.expand(block->range);
        };
        if (forOwnBlocks(0, all, expand)) return std::make_pair(range.low, range.high);
    }
    const auto known = _base->levelRange(level, region);
    if (!known) return std::nullopt;
    range.expand({known->first, known->second});
    return std::make_pair(range.low, range.high);
}

Result<osg::ref_ptr<EditableVoxelSource>> makeEditable(Voxels& voxels)
{
    if (!voxels.valid())
        return Status(ErrorCode::VALUE_INVALID, "there are no voxels to be changed");
    if (auto* editable = dynamic_cast<EditableVoxelSource*>(voxels.getSource()))
        return osg::ref_ptr<EditableVoxelSource>(editable);
    if (voxels.getStepCount() > 1)
        return Status(ErrorCode::NOT_SUPPORTED, "voxels of " +
                                                    std::to_string(voxels.getStepCount()) +
                                                    " time steps cannot be changed");
    const osg::ref_ptr<EditableVoxelSource> source = new EditableVoxelSource(voxels.getSource());
    const CallerReports here;
    const Status status = voxels.exchangeSource(source);
    if (!status.ok()) return status;
    return source;
}

} // namespace osgVolumizer
