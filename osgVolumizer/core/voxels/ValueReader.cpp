#include "ValueReader.h"

#include "VoxelDispatch.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace osgVolumizer {
namespace core {

namespace {

// The trilinear interpolant in the cell beyond a corner; NaN where samples are no
// numbers.
template <class T>
double interpolate(const VoxelView& view, int component, const glm::ivec3& corner,
                   const glm::dvec3& f)
{
    using Number = std::conditional_t<std::is_same<T, Half>::value, float, T>;
    const glm::ivec3& n = view.size;
    const std::int64_t voxel = view.components, row = voxel * n.x, layer = row * n.y;
    const T* v = static_cast<const T*>(view.data) + component + voxel * corner.x + row * corner.y +
                 layer * corner.z;
    // Beyond the last sample the weight is 0.
    const std::int64_t dx = corner.x + 1 < n.x ? voxel : 0, dy = corner.y + 1 < n.y ? row : 0,
                       dz = corner.z + 1 < n.z ? layer : 0;
    const auto edge = [&](std::int64_t i) {
        const double a = double(Number(v[i])), b = double(Number(v[i + dx]));
        return a + f.x * (b - a);
    };
    const auto face = [&](std::int64_t i) {
        const double a = edge(i), b = edge(i + dy);
        return a + f.y * (b - a);
    };
    const double a = face(0), b = face(dz), value = a + f.z * (b - a);
    return std::isfinite(value) ? value : NAN;
}

bool contains(const Box3d& halfOpen, const glm::dvec3& p)
{
    return glm::all(glm::lessThanEqual(halfOpen.min, p)) &&
           glm::all(glm::lessThan(p, halfOpen.max));
}

} // namespace

ValueReader::ValueReader(const BrickLayout& layout, Load load, Interpolation interpolation,
                         int component, double holeValue)
    : _layout(layout), _load(std::move(load)), _interpolation(interpolation), _component(component),
      _holeValue(holeValue), _extent(layout.extent())
{
}

ValueReader::Loaded ValueReader::load(std::int64_t index) const
{
    const BrickPlace place = _layout.brick(index);
    Loaded loaded;
    loaded.brick = _load(index);
    loaded.box = place.clipBox;
    const glm::ivec3 coordinates = _layout.coordinates(index);
    for (int axis = 0; axis < 3; ++axis)
        if (coordinates[axis] + 1 == _layout.count()[axis])
            loaded.box.max[axis] = std::nextafter(loaded.box.max[axis], INFINITY);
    loaded.first = glm::dvec3(place.samples.min);
    if (loaded.brick.view.data)
        loaded.read = visitVoxelType(loaded.brick.view.type,
                                     [](auto tag) -> Read { return interpolate<decltype(tag)>; });
    return loaded;
}

const ValueReader::Loaded* ValueReader::find(const glm::dvec3& positionVoxel)
{
    if (_last && contains(_last->box, positionVoxel)) return _last;
    const std::int64_t index = _layout.brickAt(positionVoxel);
    if (index < 0) return nullptr;
    auto found = _bricks.find(index);
    if (found == _bricks.end()) found = _bricks.emplace(index, load(index)).first;
    return _last = &found->second;
}

double ValueReader::value(const glm::dvec3& positionVoxel)
{
    const Loaded* brick = find(positionVoxel);
    if (!brick || !brick->read) return NAN;
    const VoxelView& view = brick->brick.view;
    const glm::ivec3 last = view.size - 1;
    const glm::dvec3 local =
        glm::clamp(positionVoxel - brick->first, glm::dvec3(0.0), glm::dvec3(last));
    const bool nearest = _interpolation == NEAREST;
    const glm::dvec3 whole =
        nearest ? glm::floor(local + 0.5) : glm::min(glm::floor(local), glm::dvec3(last - 1));
    const glm::dvec3 corner = glm::max(whole, glm::dvec3(0.0));
    const glm::dvec3 fraction = nearest ? glm::dvec3(0.0) : local - corner;
    const double value = brick->read(view, _component, glm::ivec3(corner), fraction);
    return std::isnan(value) ? _holeValue : value;
}

double ValueReader::difference(const glm::dvec3& positionVoxel, int axis, double here)
{
    glm::dvec3 low = positionVoxel, high = positionVoxel;
    low[axis] = std::max(low[axis] - 1.0, _extent.min[axis]);
    high[axis] = std::min(high[axis] + 1.0, _extent.max[axis]);
    double lowValue = value(low), highValue = value(high);
    if (std::isnan(lowValue)) {
        low = positionVoxel;
        lowValue = here;
    }
    if (std::isnan(highValue)) {
        high = positionVoxel;
        highValue = here;
    }
    return (highValue - lowValue) / (high[axis] - low[axis]); // 0/0 where neither is known
}

glm::dvec3 ValueReader::gradient(const glm::dvec3& positionVoxel)
{
    const double here = value(positionVoxel);
    if (std::isnan(here)) return glm::dvec3(NAN);
    glm::dvec3 gradient;
    for (int axis = 0; axis < 3; ++axis)
        gradient[axis] = difference(positionVoxel, axis, here);
    return gradient;
}

} // namespace core
} // namespace osgVolumizer
