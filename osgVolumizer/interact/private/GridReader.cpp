#include "GridReader.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace picking {

namespace {

bool contains(const core::Box3d& box, const glm::ivec3& cell)
{
    for (int a = 0; a < 3; ++a)
        if (!(cell[a] >= box.min[a] && cell[a] < box.max[a])) return false;
    return true;
}

} // namespace

GridReader::GridReader(const Voxels& voxels, int level, int step, bool wide)
    : _voxels(voxels), _cache(pickData<SampleCache>(voxels)), _level(level), _step(step),
      _wide(wide)
{
    if (voxels.isPaged()) {
        const core::BrickTree& tree = voxels.getTree();
        const core::TreeBrick brick = tree.brick(tree.index(level, glm::ivec3(0)));
        _size = core::BrickTree::levelSize(tree.size(), level);
        _count = tree.count(level);
        _spacing = brick.spacing;
        _offset = brick.offset;
    } else {
        _size = voxels.getLayout().size();
        _count = voxels.getLayout().count();
    }
}

// By the middle of the cell: of two bricks that meet in a cell both have its samples.
glm::ivec3 GridReader::coordinatesOf(const glm::ivec3& cell) const
{
    if (_voxels.isPaged())
        return glm::clamp(cell / _voxels.getTree().step(), glm::ivec3(0), _count - 1);
    const core::BrickLayout& layout = _voxels.getLayout();
    const core::Box3d all = layout.extent();
    const glm::dvec3 middle = glm::clamp(glm::dvec3(cell) + 0.5, all.min, all.max);
    return layout.coordinates(layout.brickAt(middle));
}

GridReader::Place GridReader::placeAt(const glm::ivec3& c) const
{
    Place place;
    const bool paged = _voxels.isPaged();
    place.index = paged ? _voxels.getTree().index(_level, c) : _voxels.getLayout().index(c);
    if (paged) {
        const glm::dvec3 step(_voxels.getTree().step());
        place.box = {glm::dvec3(c) * step, glm::dvec3(c + 1) * step};
    } else {
        const core::Box3d clip = _voxels.getLayout().brick(place.index).clipBox;
        place.box = {glm::ceil(clip.min - 0.5), glm::ceil(clip.max - 0.5)};
    }
    constexpr double END = std::numeric_limits<double>::infinity();
    for (int a = 0; a < 3; ++a) {
        if (c[a] == 0) place.box.min[a] = -END;
        if (c[a] + 1 == _count[a]) place.box.max[a] = END;
    }
    return place;
}

GridReader::Place GridReader::placeOf(const glm::ivec3& cell) const
{
    return placeAt(coordinatesOf(cell));
}

std::vector<GridReader::Place> GridReader::placesIn(const core::Box3d& box) const
{
    const auto coordinates = [this](const glm::dvec3& place) {
        const glm::dvec3 held = glm::clamp(place, glm::dvec3(-1.0), glm::dvec3(_size));
        return coordinatesOf(glm::ivec3(glm::floor(held)));
    };
    const glm::ivec3 low = coordinates(box.min), high = coordinates(box.max);
    std::vector<Place> places;
    glm::ivec3 c;
    for (c.z = low.z; c.z <= high.z; ++c.z)
        for (c.y = low.y; c.y <= high.y; ++c.y)
            for (c.x = low.x; c.x <= high.x; ++c.x)
                places.push_back(placeAt(c));
    return places;
}

std::int64_t GridReader::bytesOf(std::int64_t index) const
{
    const core::Box3i samples = _voxels.isPaged() ? _voxels.getTree().brick(index).samples
                                                  : _voxels.getLayout().brick(index).samples;
    return core::voxelBytes(samples.size(), _voxels.getType(), _voxels.getComponents());
}

bool GridReader::knownRange(std::int64_t index, core::ValueRange& range) const
{
    if (!_voxels.isPaged()) {
        const auto known = _voxels.getBrickRange(index);
        range = {known.first, known.second};
        return true;
    }
    const auto known = _voxels.getPageRange(index, _step);
    if (known) range = {known->first, known->second};
    return known.has_value();
}

GridReader::Loaded& GridReader::find(const glm::ivec3& cell)
{
    constexpr std::size_t MANY = 256; // more would be held in memory than the cache may keep
    if (_last && contains(_last->place.box, cell)) return *_last;
    const Place place = placeOf(cell);
    auto found = _loaded.find(place.index);
    if (found == _loaded.end()) {
        if (_loaded.size() >= MANY) _loaded.clear();
        Loaded loaded;
        loaded.place = place;
        loaded.rangeKnown = knownRange(place.index, loaded.range);
        found = _loaded.emplace(place.index, std::move(loaded)).first;
    }
    return *(_last = &found->second);
}

const SampleChunk& GridReader::chunkOf(Loaded& loaded)
{
    if (!loaded.chunk) {
        loaded.chunk = _cache->get(_voxels, loaded.place.index, _step);
        _failed = _failed || !loaded.chunk->wasRead();
    }
    return *loaded.chunk;
}

GridReader::Part GridReader::partAt(const glm::ivec3& cell, const Shows& shows)
{
    Loaded& loaded = find(cell);
    Part part{loaded.place.box, false, loaded.range};
    if (loaded.rangeKnown && (loaded.range.empty() || !shows(loaded.range))) return part;
    const SampleChunk& chunk = chunkOf(loaded);
    if (!chunk.hasSamples()) return part;
    const core::CellGrid& cells = chunk.cells(_wide);
    const glm::ivec3 local = glm::clamp((cell - chunk.samples().min) / SampleChunk::CELL,
                                        glm::ivec3(0), cells.count - 1);
    const glm::dvec3 low(chunk.samples().min + local * SampleChunk::CELL);
    for (int a = 0; a < 3; ++a) {
        if (local[a] > 0) part.box.min[a] = std::max(part.box.min[a], low[a]);
        if (local[a] + 1 < cells.count[a])
            part.box.max[a] = std::min(part.box.max[a], low[a] + SampleChunk::CELL);
    }
    const std::size_t i = cells.index(local.x, local.y, local.z);
    part.range = {cells.low[i], cells.high[i]};
    part.shown = !part.range.empty() && shows(part.range);
    return part;
}

bool GridReader::fetch(const glm::ivec3& cell, int first, int count, int component, double* values)
{
    const SampleChunk& chunk = chunkOf(find(cell));
    if (!chunk.hasSamples()) return false;
    const glm::ivec3 size = chunk.size();
    std::int64_t steps[3][4];
    for (int a = 0; a < 3; ++a)
        for (int i = 0; i < count; ++i) {
            const int inLevel = std::clamp(cell[a] + first + i, 0, _size[a] - 1);
            steps[a][i] = std::clamp(inLevel - chunk.samples().min[a], 0, size[a] - 1);
        }
    std::int64_t indices[64];
    int n = 0;
    for (int k = 0; k < count; ++k)
        for (int j = 0; j < count; ++j)
            for (int i = 0; i < count; ++i)
                indices[n++] = steps[0][i] + std::int64_t(size.x) *
                                                 (steps[1][j] + std::int64_t(size.y) * steps[2][k]);
    chunk.fetch(indices, n, component, values);
    return true;
}

double GridReader::rawSample(const glm::ivec3& place, int component)
{
    const glm::ivec3 held = glm::clamp(place, glm::ivec3(0), _size - 1);
    return chunkOf(find(held)).rawSample(held, component);
}

} // namespace picking
} // namespace osgVolumizer
