#include "PageCells.h"

#include "../../core/voxels/VoxelData.h"

#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

// From the frame of a level's samples to that of level 0.
void moveToVoxelFrame(const core::TreeBrick& brick, BrickCells& cells)
{
    cells.box.min = brick.spacing * cells.box.min + brick.offset;
    cells.box.max = brick.spacing * cells.box.max + brick.offset;
    cells.origin = glm::vec3(brick.spacing * glm::dvec3(cells.origin) + brick.offset);
    cells.cellSize *= static_cast<float>(brick.spacing);
    cells.marchedVolume *= std::pow(brick.spacing, 3.0);
}

} // namespace

PageCells::PageCells(const Voxels& voxels, const core::TreeBrick& brick, const VoxelBlock& block)
    : _brick(brick)
{
    const core::VoxelView view{block.data, voxels.getType(), voxels.getComponents(),
                               brick.samples.size()};
    const int component = shownComponent(voxels);
    _grid = core::scanCells(view, cellSizeFor(view.size), glm::dvec3(brick.samples.min),
                            core::FilterSupport::LINEAR, component);
    _layers = core::scanLayers(view, component);
}

std::shared_ptr<const BrickCells> PageCells::get(const Voxels& voxels, const OccupancyQuery& query)
{
    const OccupancyKey key = occupancyKey(voxels, query);
    std::lock_guard<std::mutex> lock(_mutex);
    if (const auto* known = _cells.find(key)) return *known;
    core::BrickPlace place;
    place.samples = _brick.samples;
    place.clipBox = {(_brick.clipBox.min - _brick.offset) / _brick.spacing,
                     (_brick.clipBox.max - _brick.offset) / _brick.spacing};
    auto cells = std::make_shared<BrickCells>(
        *findOccupied(voxels, place, _grid, _layers, query, {_brick.spacing, _brick.offset}));
    moveToVoxelFrame(_brick, *cells);
    return _cells.add(key, cells);
}

void PageCells::resizeGLObjectBuffers(unsigned int maximum)
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& cells : _cells)
        if (cells.value->texture) cells.value->texture->resizeGLObjectBuffers(maximum);
}

void PageCells::releaseGLObjects(osg::State* state)
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& cells : _cells)
        if (cells.value->texture) cells.value->texture->releaseGLObjects(state);
}

} // namespace render
} // namespace osgVolumizer
