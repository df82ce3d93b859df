#include "Occupancy.h"

#include "VoxelDispatch.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <type_traits>

namespace osgVolumizer {
namespace core {

namespace {

/// Samples that a filter in cell `cell` of an axis touches: [first, end).
struct SampleSpan
{
    int first, end;
};

SampleSpan samplesOfCell(int cell, int cellSize, int samples, int support)
{
    const std::int64_t first = std::int64_t(cell) * cellSize - support;
    const std::int64_t end = std::int64_t(cell + 1) * cellSize + support + 1;
    return {static_cast<int>(std::max<std::int64_t>(first, 0)),
            static_cast<int>(std::min<std::int64_t>(end, samples))};
}

float roundedDown(double v)
{
    const float f = static_cast<float>(v);
    return static_cast<double>(f) > v ? std::nextafter(f, -INFINITY) : f;
}

float roundedUp(double v)
{
    const float f = static_cast<float>(v);
    return static_cast<double>(f) < v ? std::nextafter(f, INFINITY) : f;
}

/// Ranges over a bundle of parallel rows, sample by sample: vector instructions all the way.
template <class T>
class RowBundle
{
public:
    using C = std::conditional_t<std::is_same<T, Half>::value, float, T>;

    explicit RowBundle(std::size_t samples) : _low(samples), _high(samples) {}
    void clear()
    {
        std::fill(_low.begin(), _low.end(), HIGHEST);
        std::fill(_high.begin(), _high.end(), LOWEST);
    }
    void add(const T* row, std::size_t stride)
    {
        if (stride == 1) // known to the compiler here, so that it vectorises
            for (std::size_t i = 0; i < _low.size(); ++i)
                add(i, static_cast<C>(row[i]));
        else
            for (std::size_t i = 0; i < _low.size(); ++i)
                add(i, static_cast<C>(row[i * stride]));
    }
    ValueRange range(const SampleSpan& span) const
    {
        const C low = *std::min_element(_low.begin() + span.first, _low.begin() + span.end);
        const C high = *std::max_element(_high.begin() + span.first, _high.begin() + span.end);
        if (low > high) return {};
        return {static_cast<double>(low), static_cast<double>(high)};
    }

private:
    static constexpr C LOWEST = std::numeric_limits<C>::lowest();
    static constexpr C HIGHEST = std::numeric_limits<C>::max();

    void add(std::size_t i, C v)
    {
        // All comparisons are false for NaN; the bounds take infinities out.
        const bool finite = v >= LOWEST && v <= HIGHEST;
        _low[i] = finite && v < _low[i] ? v : _low[i];
        _high[i] = finite && v > _high[i] ? v : _high[i];
    }

    std::vector<C> _low, _high;
};

/// One raster pass of the chamfer: `step` 1 forwards, -1 backwards.
void chamferPass(const glm::ivec3& n, int step, std::vector<std::uint8_t>& distance)
{
    const auto at = [&](int x, int y, int z) -> std::uint8_t& {
        return distance[static_cast<std::size_t>(x) +
                        static_cast<std::size_t>(n.x) *
                            (static_cast<std::size_t>(y) +
                             static_cast<std::size_t>(n.y) * static_cast<std::size_t>(z))];
    };
    const auto first = [&](int axis) { return step > 0 ? 0 : n[axis] - 1; };
    const auto inside = [&](int v, int axis) { return v >= 0 && v < n[axis]; };
    for (int z = first(2); inside(z, 2); z += step)
        for (int y = first(1); inside(y, 1); y += step)
            for (int x = first(0); inside(x, 0); x += step) {
                int nearest = at(x, y, z);
                const auto visit = [&](int dx, int dy, int dz) {
                    if (inside(x + dx, 0) && inside(y + dy, 1) && inside(z + dz, 2))
                        nearest = std::min(nearest, at(x + dx, y + dy, z + dz) + 1);
                };
                for (int d = -1; d <= 1; ++d) {
                    for (int e = -1; e <= 1; ++e)
                        visit(e, d, -step);
                    visit(d, -step, 0);
                }
                visit(-step, 0, 0);
                at(x, y, z) = static_cast<std::uint8_t>(std::min(nearest, 255));
            }
}

} // namespace

CellGrid scanCells(const VoxelView& view, int cellSize, const glm::dvec3& originVoxel,
                   FilterSupport support, int component)
{
    CellGrid grid;
    grid.originVoxel = originVoxel;
    grid.cellSize = std::max(cellSize, 1);
    if (sampleCount(view.size) == 0) return grid;
    for (int axis = 0; axis < 3; ++axis)
        grid.count[axis] = std::max(1, (view.size[axis] - 2) / grid.cellSize + 1);
    const std::size_t cells = static_cast<std::size_t>(sampleCount(grid.count));
    grid.low.assign(cells, INFINITY);
    grid.high.assign(cells, -INFINITY);
    const auto span = [&](int cell, int axis) {
        return samplesOfCell(cell, grid.cellSize, view.size[axis], static_cast<int>(support));
    };
    visitVoxelType(view.type, [&](auto tag) {
        using T = decltype(tag);
        const std::size_t stride = static_cast<std::size_t>(view.components);
        const std::size_t rowLength = static_cast<std::size_t>(view.size.x) * stride;
        const T* values = static_cast<const T*>(view.data) + component;
        RowBundle<T> bundle(static_cast<std::size_t>(view.size.x));
        for (int z = 0; z < grid.count.z; ++z)
            for (int y = 0; y < grid.count.y; ++y) {
                const SampleSpan spanY = span(y, 1), spanZ = span(z, 2);
                bundle.clear();
                for (int k = spanZ.first; k < spanZ.end; ++k)
                    for (int j = spanY.first; j < spanY.end; ++j)
                        bundle.add(values + rowLength * (static_cast<std::size_t>(k) *
                                                             static_cast<std::size_t>(view.size.y) +
                                                         static_cast<std::size_t>(j)),
                                   stride);
                for (int x = 0; x < grid.count.x; ++x) {
                    const ValueRange range = bundle.range(span(x, 0));
                    if (range.empty()) continue;
                    grid.low[grid.index(x, y, z)] = roundedDown(range.low);
                    grid.high[grid.index(x, y, z)] = roundedUp(range.high);
                }
            }
    });
    return grid;
}

std::vector<std::size_t> cellsTouching(const CellGrid& grid, FilterSupport support,
                                       const std::vector<Box3i>& samples)
{
    const glm::ivec3 origin(grid.originVoxel);
    const int reach = static_cast<int>(support);
    std::set<std::size_t> cells;
    for (const Box3i& box : samples) {
        glm::ivec3 first, last;
        for (int axis = 0; axis < 3; ++axis) {
            // A sample between two cells belongs to both; one beyond the last to that.
            const int low = std::max(box.min[axis] - origin[axis] - reach - 1, 0);
            const int high = std::max(box.max[axis] - 1 - origin[axis] + reach, 0);
            first[axis] = std::min(low / grid.cellSize, grid.count[axis] - 1);
            last[axis] = std::min(high / grid.cellSize, grid.count[axis] - 1);
        }
        for (int z = first.z; z <= last.z; ++z)
            for (int y = first.y; y <= last.y; ++y)
                for (int x = first.x; x <= last.x; ++x)
                    cells.insert(grid.index(x, y, z));
    }
    return {cells.begin(), cells.end()};
}

Box3i cellSamples(const CellGrid& grid, std::size_t cell, FilterSupport support,
                  const Box3i& brickSamples)
{
    const auto columns = static_cast<std::size_t>(grid.count.x);
    const auto rows = static_cast<std::size_t>(grid.count.y);
    const glm::ivec3 place(static_cast<int>(cell % columns),
                           static_cast<int>(cell / columns % rows),
                           static_cast<int>(cell / columns / rows));
    const glm::ivec3 origin(grid.originVoxel);
    Box3i box;
    for (int axis = 0; axis < 3; ++axis) {
        const SampleSpan span = samplesOfCell(place[axis], grid.cellSize, brickSamples.size()[axis],
                                              static_cast<int>(support));
        box.min[axis] = origin[axis] + span.first;
        box.max[axis] = origin[axis] + span.end;
    }
    return box;
}

void setCellRange(CellGrid& grid, std::size_t cell, const ValueRange& range)
{
    grid.low[cell] = range.empty() ? INFINITY : roundedDown(range.low);
    grid.high[cell] = range.empty() ? -INFINITY : roundedUp(range.high);
}

std::vector<std::uint8_t>
occupiedCells(const CellGrid& grid,
              const std::function<double(double low, double high)>& maximumOpacity,
              double threshold)
{
    std::vector<std::uint8_t> occupied(grid.cellCount(), 0);
    for (std::size_t i = 0; i < occupied.size(); ++i)
        if (grid.low[i] <= grid.high[i] &&
            maximumOpacity(static_cast<double>(grid.low[i]), static_cast<double>(grid.high[i])) >
                threshold)
            occupied[i] = 255;
    return occupied;
}

std::vector<std::uint8_t> chebyshevDistance(const glm::ivec3& count,
                                            const std::vector<std::uint8_t>& occupied)
{
    std::vector<std::uint8_t> distance(occupied.size());
    std::transform(occupied.begin(), occupied.end(), distance.begin(),
                   [](std::uint8_t o) { return static_cast<std::uint8_t>(o ? 0 : 255); });
    chamferPass(count, 1, distance);
    chamferPass(count, -1, distance);
    return distance;
}

} // namespace core
} // namespace osgVolumizer
