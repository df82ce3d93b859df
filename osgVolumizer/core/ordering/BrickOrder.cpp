#include "BrickOrder.h"

#include <algorithm>
#include <cstdlib>

namespace osgVolumizer {
namespace core {

BrickOrder::BrickOrder(const BrickLayout& layout)
{
    for (int a = 0; a < 3; ++a) {
        const int n = layout.count()[a];
        for (int i = 0; i < n; ++i) {
            glm::ivec3 brick(0);
            brick[a] = i;
            const Box3d box = layout.brick(layout.index(brick)).clipBox;
            if (i == 0) _splits[a].push_back(box.min[a]);
            _splits[a].push_back(box.max[a]);
        }
    }
}

glm::ivec3 BrickOrder::count() const
{
    glm::ivec3 n;
    for (int a = 0; a < 3; ++a)
        n[a] = std::max<int>(1, static_cast<int>(_splits[a].size())) - 1;
    return n;
}

void BrickOrder::sort(const glm::dvec4& eyeVoxel, std::vector<std::int64_t>& bricks) const
{
    const glm::ivec3 n = count();
    std::int64_t cell[3]; // of the eye; -1 or n outside
    for (int a = 0; a < 3; ++a) {
        if (eyeVoxel.w == 0.0) {
            cell[a] = eyeVoxel[a] > 0.0 ? n[a] : -1;
            continue;
        }
        const double eye = eyeVoxel[a] / eyeVoxel.w;
        cell[a] =
            std::upper_bound(_splits[a].begin(), _splits[a].end(), eye) - _splits[a].begin() - 1;
    }
    const auto distance = [&](std::int64_t brick) {
        const std::int64_t x = std::abs(brick % n.x - cell[0]);
        const std::int64_t y = std::abs(brick / n.x % n.y - cell[1]);
        const std::int64_t z = std::abs(brick / n.x / n.y - cell[2]);
        return (z * (n.y + 2) + y) * (n.x + 2) + x;
    };
    std::sort(bricks.begin(), bricks.end(), [&](std::int64_t a, std::int64_t b) {
        const std::int64_t da = distance(a), db = distance(b);
        return da != db ? da > db : a < b;
    });
}

} // namespace core
} // namespace osgVolumizer
