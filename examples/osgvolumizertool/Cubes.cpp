#include "Cubes.h"

#include <osgVolumizer/core/voxels/VoxelData.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace osgVolumizer;

Cubes::Cubes(const glm::ivec3& size, int edge, VoxelType type) : _edge(edge)
{
    _description.size = size;
    _description.type = type;
}

Status Cubes::read(const core::Box3i& region, void* destination) const
{
    double lowest = 0.0, highest = 1.0;
    voxelTypeRange(_description.type, lowest, highest);
    // Distance from the centre along each axis, 1 at the surface, which runs half a voxel outside.
    const auto distance = [&](int v) {
        return std::fabs(2.0 * (v % _edge) - (_edge - 1.0)) / _edge;
    };
    const std::size_t voxel = voxelTypeSize(_description.type);
    auto* to = static_cast<unsigned char*>(destination);
    std::vector<double> row(static_cast<std::size_t>(std::max(region.size().x, 0)));
    for (int z = region.min.z; z < region.max.z; ++z)
        for (int y = region.min.y; y < region.max.y; ++y, to += row.size() * voxel) {
            const double across = std::max(distance(y), distance(z));
            for (std::size_t i = 0; i < row.size(); ++i)
                row[i] = 1.0 - std::max(across, distance(region.min.x + static_cast<int>(i)));
            core::convertVoxels(row.data(), VoxelType::FLOAT64, to, _description.type, row.size(),
                                highest);
        }
    return {};
}
