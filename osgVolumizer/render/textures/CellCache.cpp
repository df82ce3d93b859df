#include "CellCache.h"

#include "BrickResidency.h"

#include <iterator>

namespace osgVolumizer {
namespace render {

namespace {

core::VoxelView viewOf(const Voxels& voxels, std::int64_t brick, const Voxels::Block& block)
{
    core::VoxelView view;
    view.data = block.data;
    view.type = voxels.getType();
    view.size = voxels.getLayout().brick(brick).samples.size();
    view.components = voxels.getComponents();
    return view;
}

} // namespace

std::shared_ptr<const BrickCells> CellCache::get(const Voxels& voxels, std::int64_t brick,
                                                 const OccupancyQuery& query)
{
    const unsigned modified = voxels.getModifiedCount(brick), layout = voxels.getLayoutCount();
    const OccupancyKey key = occupancyKey(voxels, query);
    std::shared_ptr<Brick> held;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        std::shared_ptr<Brick>& known = _bricks[brick];
        if (!known) known = std::make_shared<Brick>();
        held = known;
    }
    Brick& entry = *held;
    std::lock_guard<std::mutex> lock(entry.mutex);
    if (entry.modifiedCount != modified || entry.layoutCount != layout) {
        if (entry.layoutCount != layout || !update(voxels, brick, entry)) {
            entry.linear = entry.cubic = nullptr;
            entry.layers = nullptr;
        }
        entry.modifiedCount = modified;
        entry.layoutCount = layout;
        entry.cells.clear();
    }
    if (const auto* known = entry.cells.find(key)) return *known;
    if (!scan(voxels, brick, query.cubic, entry)) return nullptr;
    const core::CellGrid& grid = *(query.cubic ? entry.cubic : entry.linear);
    return entry.cells.add(
        key, findOccupied(voxels, voxels.getLayout().brick(brick), grid, *entry.layers, query));
}

std::shared_ptr<const BrickCells> CellCache::join(const Voxels& voxels, const OccupancyQuery& query,
                                                  const std::vector<Part>& parts)
{
    const OccupancyKey key = occupancyKey(voxels, query);
    const unsigned layout = voxels.getLayoutCount();
    std::lock_guard<std::mutex> lock(_mutex);
    _joined.removeIf([layout](const auto& entry) { return entry.value.layoutCount != layout; });
    Joined* known = _joined.find(key);
    Joined& joined = known ? *known : _joined.add(key, {layout, {}, {}, nullptr});
    bool changed = !joined.cells;
    for (auto part = joined.parts.begin(); part != joined.parts.end();) {
        const bool old = joined.modifiedCounts[part->first] != voxels.getModifiedCount(part->first);
        changed = changed || old;
        part = old ? joined.parts.erase(part) : std::next(part);
    }
    for (const Part& part : parts) {
        auto& cells = joined.parts[part.first];
        changed = changed || cells != part.second;
        cells = part.second;
        joined.modifiedCounts[part.first] = voxels.getModifiedCount(part.first);
    }
    if (changed) joined.cells = joinCells(voxels, joined.parts);
    return joined.cells;
}

// Looks again at the cells whose samples have changed; false where all have to be looked at.
bool CellCache::update(const Voxels& voxels, std::int64_t brick, Brick& entry)
{
    if (!entry.layers) return false;
    const core::Box3i samples = voxels.getLayout().brick(brick).samples;
    const auto changed = voxels.getChanges(entry.modifiedCount, samples);
    if (!changed) return false;
    bool readable = true;
    const auto rangeOf = [&](const core::Box3i& box) {
        const Result<VoxelBlock> block = voxels.readSamples(box);
        readable = readable && block.ok();
        if (!block.ok()) return core::ValueRange();
        return core::scanRange({block->data, voxels.getType(), voxels.getComponents(), box.size()},
                               shownComponent(voxels));
    };
    core::CellGrid* const grids[] = {entry.linear.get(), entry.cubic.get()};
    for (const auto support : {core::FilterSupport::LINEAR, core::FilterSupport::CUBIC}) {
        core::CellGrid* const grid = grids[static_cast<int>(support)];
        if (!grid) continue;
        for (const std::size_t cell : core::cellsTouching(*grid, support, *changed))
            core::setCellRange(*grid, cell,
                               rangeOf(core::cellSamples(*grid, cell, support, samples)));
    }
    const core::CellGrid* const known = entry.linear ? entry.linear.get() : entry.cubic.get();
    if (known && readable) core::rescanLayers(*entry.layers, *known, samples, *changed, rangeOf);
    return known && readable;
}

bool CellCache::scan(const Voxels& voxels, std::int64_t brick, bool cubic, Brick& entry)
{
    auto& grid = cubic ? entry.cubic : entry.linear;
    if (grid && entry.layers) return grid->cellCount() > 0;
    const VoxelBlock block = BrickResidency::load(voxels, brick);
    if (!block) return false;
    const core::VoxelView view = viewOf(voxels, brick, block);
    const int component = shownComponent(voxels);
    const glm::dvec3 origin(voxels.getLayout().brick(brick).samples.min);
    grid = std::make_shared<core::CellGrid>(core::scanCells(
        view, cellSizeFor(view.size), origin,
        cubic ? core::FilterSupport::CUBIC : core::FilterSupport::LINEAR, component));
    if (!entry.layers)
        entry.layers = std::make_shared<core::LayerRanges>(core::scanLayers(view, component));
    return grid->cellCount() > 0;
}

bool CellCache::isScanned(const Voxels& voxels, std::int64_t brick) const
{
    std::shared_ptr<Brick> entry;
    {
        std::lock_guard<std::mutex> lock(_mutex);
        const auto found = _bricks.find(brick);
        if (found == _bricks.end()) return false;
        entry = found->second;
    }
    std::lock_guard<std::mutex> lock(entry->mutex);
    return entry->layers && entry->modifiedCount == voxels.getModifiedCount(brick) &&
           entry->layoutCount == voxels.getLayoutCount();
}

std::vector<std::shared_ptr<CellCache::Brick>> CellCache::allBricks() const
{
    std::lock_guard<std::mutex> lock(_mutex);
    std::vector<std::shared_ptr<Brick>> all;
    for (const auto& brick : _bricks)
        all.push_back(brick.second);
    return all;
}

void CellCache::resizeGLObjectBuffers(unsigned int maximum)
{
    for (const std::shared_ptr<Brick>& brick : allBricks()) {
        std::lock_guard<std::mutex> lock(brick->mutex);
        for (const auto& cells : brick->cells)
            if (cells.value->texture) cells.value->texture->resizeGLObjectBuffers(maximum);
    }
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& joined : _joined)
        joined.value.cells->texture->resizeGLObjectBuffers(maximum);
}

void CellCache::releaseGLObjects(osg::State* state) const
{
    for (const std::shared_ptr<Brick>& brick : allBricks()) {
        std::lock_guard<std::mutex> lock(brick->mutex);
        for (const auto& cells : brick->cells)
            if (cells.value->texture) cells.value->texture->releaseGLObjects(state);
    }
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& joined : _joined)
        joined.value.cells->texture->releaseGLObjects(state);
}

} // namespace render
} // namespace osgVolumizer
