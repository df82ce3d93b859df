#include "SculptTool.h"

#include "VoxelData.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace osgVolumizer {
namespace core {

namespace {

// A value under T > 0. NaN for one that stays.
double sculpted(const SculptTool& tool, double value, double t)
{
    constexpr double STAYS = std::numeric_limits<double>::quiet_NaN();
    const double width = tool.high - tool.low;
    const bool hole = !std::isfinite(value);
    const double v = hole ? tool.low : value;
    switch (tool.operation) {
    case SculptOperation::PERLIN_ADD:
        return v < tool.high ? v + t * (tool.high - v) : STAYS;
    case SculptOperation::PERLIN_SUB:
        return !hole && v > tool.low ? v - t * (v - tool.low) : STAYS;
    case SculptOperation::MAX_ADD:
        return hole || v < tool.low + t * width ? tool.low + t * width : STAYS;
    case SculptOperation::MIN_SUB:
        return !hole && v > tool.high - t * width ? tool.high - t * width : STAYS;
    case SculptOperation::ERASE:
        return tool.erased;
    }
    return STAYS;
}

// One row of samples: as numbers, and as it will be.
class Row
{
public:
    Row(const SculptTool& tool, VoxelType type, int components, int samples)
        : _tool(tool), _type(type), _components(components),
          _voxel(voxelTypeSize(type) * static_cast<std::size_t>(components)),
          _values(static_cast<std::size_t>(samples) * static_cast<std::size_t>(components)),
          _bytes(static_cast<std::size_t>(samples) * _voxel),
          _set(static_cast<std::size_t>(samples))
    {
    }

    // The first and the last sample that changes, half-open; first >= last for none.
    glm::ivec2 apply(unsigned char* data, const glm::dvec3& first)
    {
        const int samples = static_cast<int>(_bytes.size() / _voxel);
        convertVoxels(data, _type, _values.data(), VoxelType::FLOAT64, _values.size());
        glm::ivec2 touched(samples, 0);
        std::fill(_set.begin(), _set.end(), char(0));
        for (int x = 0; x < samples; ++x) {
            const double t = toolValue(_tool, {first.x + x, first.y, first.z});
            if (!(t > 0.0)) continue;
            double& value = _values[std::size_t(x * _components + _components - 1)];
            const double result = sculpted(_tool, value, t);
            if (std::isnan(result)) continue;
            value = result;
            _set[std::size_t(x)] = 1;
            touched = {std::min(touched.x, x), x + 1};
        }
        return touched.x < touched.y ? write(data, touched) : touched;
    }

private:
    // Byte by byte, so that what is rounded to what it was is no change.
    glm::ivec2 write(unsigned char* data, const glm::ivec2& touched)
    {
        const auto first = std::size_t(touched.x), count = std::size_t(touched.y - touched.x);
        const auto components = std::size_t(_components);
        convertVoxels(_values.data() + first * components, VoxelType::FLOAT64,
                      _bytes.data() + first * _voxel, _type, count * components);
        glm::ivec2 changed(touched.y, touched.x);
        const std::size_t part = voxelTypeSize(_type), alpha = _voxel - part;
        for (int x = touched.x; x < touched.y; ++x) {
            const std::size_t at = std::size_t(x) * _voxel + alpha;
            if (!_set[std::size_t(x)] || std::memcmp(data + at, _bytes.data() + at, part) == 0)
                continue;
            std::memcpy(data + at, _bytes.data() + at, part);
            changed = {std::min(changed.x, x), x + 1};
        }
        return changed;
    }

    const SculptTool& _tool;
    const VoxelType _type;
    const int _components;
    const std::size_t _voxel;
    std::vector<double> _values;
    std::vector<unsigned char> _bytes;
    std::vector<char> _set; // the samples that are to have another value
};

} // namespace

double toolValue(const SculptTool& tool, const glm::dvec3& offset)
{
    const glm::dvec3 d = glm::abs(offset / tool.radius);
    const double distance =
        tool.shape == SculptShape::ROUND ? glm::length(d) : std::max({d.x, d.y, d.z});
    return tool.strength * std::max(0.0, 1.0 - distance);
}

Box3i toolBox(const SculptTool& tool, const glm::dvec3& middleVoxel)
{
    constexpr double FAR = 1 << 30; // beyond all volumes
    const glm::dvec3 low = glm::clamp(glm::ceil(middleVoxel - tool.radius), -FAR, FAR);
    const glm::dvec3 high = glm::clamp(glm::floor(middleVoxel + tool.radius), -FAR, FAR);
    return {glm::ivec3(low), glm::ivec3(high) + 1};
}

void applyTool(const SculptTool& tool, const glm::dvec3& middleVoxel, void* data,
               const Box3i& samples, VoxelType type, int components, std::vector<Box3i>& changed)
{
    if (samples.empty()) return;
    const glm::ivec3 size = samples.size();
    Row row(tool, type, components, size.x);
    auto* bytes = static_cast<unsigned char*>(data);
    const std::size_t rowBytes =
        static_cast<std::size_t>(voxelBytes({size.x, 1, 1}, type, components));
    for (int z = samples.min.z; z < samples.max.z; ++z)
        for (int y = samples.min.y; y < samples.max.y; ++y, bytes += rowBytes) {
            const glm::ivec2 part = row.apply(bytes, glm::dvec3(samples.min.x, y, z) - middleVoxel);
            if (part.x < part.y)
                changed.push_back(
                    {{samples.min.x + part.x, y, z}, {samples.min.x + part.y, y + 1, z + 1}});
        }
}

} // namespace core
} // namespace osgVolumizer
