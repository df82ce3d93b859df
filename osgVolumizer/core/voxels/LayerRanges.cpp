#include "LayerRanges.h"

#include "VoxelDispatch.h"

#include <algorithm>
#include <limits>
#include <type_traits>

namespace osgVolumizer {
namespace core {

namespace {

// Ranges over many rows, sample by sample, so that no comparison waits for the one before.
template <class C>
struct Rows
{
    static constexpr C LOWEST = std::numeric_limits<C>::lowest();
    static constexpr C HIGHEST = std::numeric_limits<C>::max();

    explicit Rows(std::size_t samples) : low(samples, HIGHEST), high(samples, LOWEST) {}

    template <class T>
    void add(const T* row, std::size_t stride)
    {
        for (std::size_t i = 0; i < low.size(); ++i) {
            const C v = static_cast<C>(row[i * stride]);
            const bool finite = v >= LOWEST && v <= HIGHEST; // false for NaN too
            low[i] = finite && v < low[i] ? v : low[i];
            high[i] = finite && v > high[i] ? v : high[i];
        }
    }
    ValueRange sample(std::size_t i) const
    {
        if (low[i] > high[i]) return {};
        return {static_cast<double>(low[i]), static_cast<double>(high[i])};
    }
    ValueRange all() const
    {
        ValueRange range;
        for (std::size_t i = 0; i < low.size(); ++i)
            range.expand(sample(i));
        return range;
    }

    std::vector<C> low, high;
};

// The cells that have a layer, each sample of it in one of them.
std::vector<std::size_t> cellsOfLayer(const CellGrid& grid, int axis, int layer)
{
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    std::vector<std::size_t> cells;
    glm::ivec3 cell;
    cell[axis] = std::min(layer / grid.cellSize, grid.count[axis] - 1);
    for (cell[v] = 0; cell[v] < grid.count[v]; ++cell[v])
        for (cell[u] = 0; cell[u] < grid.count[u]; ++cell[u])
            cells.push_back(grid.index(cell.x, cell.y, cell.z));
    return cells;
}

// Looks at cells in the order of how low (or high) they may reach, until none can reach further.
ValueRange layerRange(const CellGrid& grid, const Box3i& brickSamples, int axis, int layer,
                      const std::function<ValueRange(const Box3i&)>& rangeOf)
{
    std::vector<std::size_t> cells = cellsOfLayer(grid, axis, layer);
    ValueRange range;
    const auto look = [&](std::size_t cell) {
        Box3i part = cellSamples(grid, cell, FilterSupport::LINEAR, brickSamples);
        part.min[axis] = brickSamples.min[axis] + layer;
        part.max[axis] = part.min[axis] + 1;
        range.expand(rangeOf(part));
    };
    std::sort(cells.begin(), cells.end(),
              [&grid](std::size_t a, std::size_t b) { return grid.low[a] < grid.low[b]; });
    for (const std::size_t cell : cells) {
        if (!(double(grid.low[cell]) < range.low)) break;
        look(cell);
    }
    std::sort(cells.begin(), cells.end(),
              [&grid](std::size_t a, std::size_t b) { return grid.high[a] > grid.high[b]; });
    for (const std::size_t cell : cells) {
        if (!(double(grid.high[cell]) > range.high)) break;
        look(cell);
    }
    return range;
}

} // namespace

LayerRanges scanLayers(const VoxelView& view, int component)
{
    LayerRanges result;
    if (sampleCount(view.size) == 0) return result;
    visitVoxelType(view.type, [&](auto tag) {
        using T = decltype(tag);
        using C = std::conditional_t<std::is_same<T, Half>::value, float, T>;
        const auto stride = static_cast<std::size_t>(view.components);
        const auto samples = static_cast<std::size_t>(view.size.x);
        const T* row = static_cast<const T*>(view.data) + component;
        std::vector<Rows<C>> byY(static_cast<std::size_t>(view.size.y), Rows<C>(samples));
        for (int z = 0; z < view.size.z; ++z) {
            Rows<C> layer(samples);
            for (Rows<C>& rows : byY) {
                layer.add(row, stride);
                rows.add(row, stride);
                row += samples * stride;
            }
            result.axis[2].push_back(layer.all());
        }
        result.axis[0].resize(samples);
        for (const Rows<C>& rows : byY) {
            result.axis[1].push_back(rows.all());
            for (std::size_t x = 0; x < samples; ++x)
                result.axis[0][x].expand(rows.sample(x));
        }
    });
    return result;
}

void rescanLayers(LayerRanges& layers, const CellGrid& grid, const Box3i& brickSamples,
                  const std::vector<Box3i>& changed,
                  const std::function<ValueRange(const Box3i&)>& rangeOf)
{
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<ValueRange>& all = layers.axis[axis];
        std::vector<char> touched(all.size(), 0);
        for (const Box3i& box : changed)
            for (int i = box.min[axis]; i < box.max[axis]; ++i)
                touched[static_cast<std::size_t>(i - brickSamples.min[axis])] = 1;
        for (std::size_t i = 0; i < all.size(); ++i)
            if (touched[i])
                all[i] = layerRange(grid, brickSamples, axis, static_cast<int>(i), rangeOf);
    }
}

} // namespace core
} // namespace osgVolumizer
