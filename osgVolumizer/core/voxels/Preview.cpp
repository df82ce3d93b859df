#include "Preview.h"

#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace core {

namespace {

// First multiple of step that is not below v.
int multiple(int v, int step)
{
    return (v + step - 1) / step * step;
}

} // namespace

Preview::Preview(const glm::ivec3& size, int spacing) : _spacing(spacing)
{
    const double samples = static_cast<double>(sampleCount(size));
    _step = std::max(1, static_cast<int>(std::ceil(std::cbrt(samples / 4194304.0))));
    _size = (size + _step - 1) / _step;
    _values.assign(static_cast<std::size_t>(sampleCount(_size)),
                   std::numeric_limits<float>::quiet_NaN());
}

void Preview::add(const VoxelView& part, const glm::ivec3& origin)
{
    const glm::ivec3 end = origin + part.size;
    std::vector<double> row(static_cast<std::size_t>(part.size.x));
    for (int z = multiple(origin.z, _step); z < end.z; z += _step)
        for (int y = multiple(origin.y, _step); y < end.y; y += _step) {
            const std::int64_t first =
                part.size.x * ((y - origin.y) + std::int64_t(part.size.y) * (z - origin.z));
            for (int x = 0; x < part.size.x; ++x)
                row[static_cast<std::size_t>(x)] = voxelValue(part, first + x);
            const std::int64_t to = _size.x * (y / _step + std::int64_t(_size.y) * (z / _step));
            for (int x = multiple(origin.x, _step); x < end.x; x += _step)
                _values[static_cast<std::size_t>(to + x / _step)] =
                    static_cast<float>(row[static_cast<std::size_t>(x - origin.x)]);
            for (std::size_t x = 2; x < row.size(); ++x) {
                const double one = row[x - 1] - row[x - 2], two = row[x] - row[x - 2];
                if (!std::isfinite(one * one + two * two)) continue;
                _one += one * one;
                _two += two * two;
            }
        }
}

VoxelView Preview::view() const
{
    return {_values.data(), VoxelType::FLOAT32, 1, _size};
}

double Preview::smoothness() const
{
    return _one > 0.0 ? _two / _one : 0.0;
}

} // namespace core
} // namespace osgVolumizer
