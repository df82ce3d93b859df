#pragma once

#include "../Export.h"
#include "../voxels/BrickLayout.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Puts the bricks of a lattice into visibility order. Along any ray from the eye the distance in
/// cells from the eye's cell never falls, on any axis; so the order of these three numbers,
/// farthest first, is exact, wherever the eye is, also inside. Only comparisons, no rounding.
class OSGVOLUMIZER_CORE_EXPORT BrickOrder
{
public:
    BrickOrder() = default;
    /// \param splits per axis, the ascending coordinates where one clip box ends and the next
    /// begins, outer ends included: count + 1 values
    explicit BrickOrder(std::vector<double> x, std::vector<double> y, std::vector<double> z)
        : _splits{std::move(x), std::move(y), std::move(z)}
    {
    }
    explicit BrickOrder(const BrickLayout& layout);

    glm::ivec3 count() const;
    /// Sorts brick numbers (BrickLayout::index) far to near.
    /// \param eyeVoxel the eye in the voxel frame, homogeneous: w = 0 is a direction towards the
    /// eye (parallel projection)
    void sort(const glm::dvec4& eyeVoxel, std::vector<std::int64_t>& bricks) const;

private:
    std::vector<double> _splits[3];
};

} // namespace core
} // namespace osgVolumizer
