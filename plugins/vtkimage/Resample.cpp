#include "Resample.h"

#include <osgVolumizer/Error.h>
#include <osgVolumizer/Paging.h>
#include <osgVolumizer/core/voxels/VoxelData.h>
#include <osgVolumizer/core/voxels/VoxelDispatch.h>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace vtkimage {

namespace {

/// Between two samples of an axis, a place each.
struct Places
{
    std::vector<std::int64_t> below; ///< the sample at or before it
    std::vector<double> weight;      ///< of the one after, [0, 1)
};
using AllPlaces = std::array<Places, 3>;

void add(Places& places, double place, std::int64_t samples)
{
    const double p = std::clamp(place, 0.0, static_cast<double>(samples - 1));
    const double below = std::floor(p);
    places.below.push_back(static_cast<std::int64_t>(below));
    places.weight.push_back(p - below);
}

// Where the samples of the even lattice lie among those of the uneven one.
Places placesInUneven(const std::vector<double>& x, int count, double start, double step)
{
    Places places;
    std::size_t i = 0;
    const double sign = step < 0.0 ? -1.0 : 1.0;
    for (int k = 0; k < count; ++k) {
        const double at = start + step * k;
        while (i + 2 < x.size() && sign * at >= sign * x[i + 1])
            ++i;
        const double part = (at - x[i]) / (x[i + 1] - x[i]);
        add(places, static_cast<double>(i) + std::clamp(part, 0.0, 1.0),
            static_cast<std::int64_t>(x.size()));
    }
    return places;
}

AllPlaces placesOf(const Lattice& uneven, const Lattice& even, bool inEven)
{
    AllPlaces all;
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<double>& x = uneven.uneven[std::size_t(axis)];
        Places& places = all[std::size_t(axis)];
        const double start = even.position[axis], step = even.steps[axis][axis];
        if (x.empty())
            for (int i = 0; i < even.size[axis]; ++i)
                add(places, i, even.size[axis]);
        else if (inEven)
            for (const double at : x)
                add(places, (at - start) / step, even.size[axis]);
        else
            places = placesInUneven(x, even.size[axis], start, step);
    }
    return all;
}

template <class T>
double interpolate(const core::VoxelView& from, const AllPlaces& places, const glm::ivec3& at,
                   int component)
{
    const T* data = static_cast<const T*>(from.data) + component;
    double sum = 0.0;
    for (int corner = 0; corner < 8; ++corner) {
        double weight = 1.0;
        std::int64_t index = 0;
        for (int axis = 2; axis >= 0; --axis) {
            const Places& p = places[std::size_t(axis)];
            const auto i = static_cast<std::size_t>(at[axis]);
            const bool after = (corner >> axis & 1) != 0;
            weight *= after ? p.weight[i] : 1.0 - p.weight[i];
            index = index * from.size[axis] + p.below[i] + (after ? 1 : 0);
        }
        // What has no weight may be a hole, or not there.
        if (weight > 0.0) sum += weight * static_cast<double>(data[index * from.components]);
    }
    return sum;
}

/// Calls `row(y, z, values)` with what is interpolated at each row of places.
template <class Row>
void interpolateRows(const core::VoxelView& from, const AllPlaces& places, Row&& row)
{
    glm::ivec3 size;
    for (int axis = 0; axis < 3; ++axis)
        size[axis] = static_cast<int>(places[std::size_t(axis)].below.size());
    std::vector<double> values(std::size_t(size.x) * std::size_t(from.components));
    core::visitVoxelType(from.type, [&](auto tag) {
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y) {
                std::size_t i = 0;
                for (int x = 0; x < size.x; ++x)
                    for (int c = 0; c < from.components; ++c)
                        values[i++] = interpolate<decltype(tag)>(from, places, {x, y, z}, c);
                row(values);
            }
    });
}

core::VoxelView viewOf(const MemoryVoxelSource& source)
{
    const VoxelSource::Description d = source.describe();
    return {source.data(), d.type, d.components, d.size};
}

} // namespace

Lattice evenLattice(const Lattice& uneven, std::size_t bytesPerSample)
{
    constexpr int DENSEST = 4;
    constexpr std::int64_t SMALL = std::int64_t(1) << 24;
    const std::int64_t most =
        std::min(std::max(8 * core::sampleCount(uneven.size), SMALL),
                 getPagingBudget().memoryBytes / 2 / std::int64_t(bytesPerSample));
    Lattice even = uneven;
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<double>& x = uneven.uneven[std::size_t(axis)];
        if (x.empty()) continue;
        const double length = std::abs(x.back() - x.front());
        double least = length;
        for (std::size_t i = 1; i < x.size(); ++i)
            least = std::min(least, std::abs(x[i] - x[i - 1]));
        const double n = static_cast<double>(x.size()), wanted = std::ceil(length / least) + 1.0;
        even.size[axis] = static_cast<int>(std::clamp(wanted, n, DENSEST * n));
    }
    // The densest axis gives way first.
    while (core::sampleCount(even.size) > most) {
        int densest = 0;
        const auto density = [&](int axis) { return double(even.size[axis]) / uneven.size[axis]; };
        for (int axis = 1; axis < 3; ++axis)
            if (density(axis) > density(densest)) densest = axis;
        if (even.size[densest] <= uneven.size[densest]) break;
        even.size[densest] = std::max(uneven.size[densest], even.size[densest] * 9 / 10);
    }
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<double>& x = even.uneven[std::size_t(axis)];
        if (!x.empty()) even.steps[axis][axis] = (x.back() - x.front()) / (even.size[axis] - 1);
        x.clear();
    }
    return even;
}

Result<osg::ref_ptr<MemoryVoxelSource>>
resample(const MemoryVoxelSource& voxels, const Lattice& uneven, const Lattice& even, double& error)
{
    VoxelSource::Description d = voxels.describe();
    d.size = even.size;
    if (d.components == 1 && d.type != VoxelType::FLOAT64) d.type = VoxelType::FLOAT32;
    const CallerReports quiet;
    osg::ref_ptr<MemoryVoxelSource> result = new MemoryVoxelSource;
    if (Status status = result->allocate(d); !status.ok()) return status;
    auto* out = static_cast<unsigned char*>(result->data());
    interpolateRows(
        viewOf(voxels), placesOf(uneven, even, false), [&](const std::vector<double>& row) {
            core::convertVoxels(row.data(), VoxelType::FLOAT64, out, d.type, row.size());
            out += row.size() * voxelTypeSize(d.type);
        });
    // Back at the places of the samples.
    const core::VoxelView original = viewOf(voxels);
    std::int64_t index = 0;
    error = 0.0;
    interpolateRows(
        viewOf(*result), placesOf(uneven, even, true), [&](const std::vector<double>& row) {
            for (std::size_t i = 0; i < row.size(); ++i) {
                const int c = static_cast<int>(i) % original.components;
                const double off = std::abs(row[i] - core::voxelValue(original, index, c));
                if (off > error && std::isfinite(off)) error = off;
                if (c == original.components - 1) ++index;
            }
        });
    return result;
}

} // namespace vtkimage
} // namespace osgVolumizer
