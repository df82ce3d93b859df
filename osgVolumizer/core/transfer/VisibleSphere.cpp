#include "VisibleSphere.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace core {

namespace {

constexpr int MOST_CELLS = 32;       // along each axis
constexpr double LEFT_OUT = 0.005;   // share of what shows, at each end
constexpr double SHOWS_FULLY = 0.02; // opacity of a sample that counts as one

struct Cells
{
    glm::ivec3 count{0};
    glm::dvec3 size{1.0}; ///< object units
    std::vector<double> weight;

    std::size_t index(const glm::ivec3& c) const
    {
        return static_cast<std::size_t>(c.x + count.x * (c.y + count.y * c.z));
    }
    glm::dvec3 center(const glm::ivec3& c) const { return (glm::dvec3(c) + 0.5) * size; }
    template <class Visit>
    void forEach(Visit visit) const
    {
        glm::ivec3 c;
        for (c.z = 0; c.z < count.z; ++c.z)
            for (c.y = 0; c.y < count.y; ++c.y)
                for (c.x = 0; c.x < count.x; ++c.x)
                    visit(c, weight[index(c)]);
    }
};

// How much each of the entries of a fine table shows.
std::vector<double> weightsOf(const TransferFunction& function)
{
    std::vector<double> weights(1024);
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const double opacity = function.evaluate(double(i) / double(weights.size() - 1)).a;
        weights[i] = std::min(1.0, opacity / SHOWS_FULLY);
    }
    return weights;
}

Cells weigh(const VoxelView& voxels, const ValueRange& range, const TransferFunction& function,
            const glm::dvec3& spacing)
{
    const std::vector<double> weights = weightsOf(function);
    const double scale = double(weights.size() - 1) / (range.high - range.low);
    Cells cells;
    cells.count = glm::min(voxels.size, glm::ivec3(MOST_CELLS));
    cells.size = glm::dvec3(voxels.size) * spacing / glm::dvec3(cells.count);
    cells.weight.assign(static_cast<std::size_t>(cells.count.x) * cells.count.y * cells.count.z,
                        0.0);
    std::int64_t i = 0;
    glm::ivec3 p;
    for (p.z = 0; p.z < voxels.size.z; ++p.z)
        for (p.y = 0; p.y < voxels.size.y; ++p.y)
            for (p.x = 0; p.x < voxels.size.x; ++p.x, ++i) {
                const double v = (voxelValue(voxels, i) - range.low) * scale;
                if (std::isnan(v)) continue;
                const double entry = std::clamp(v, 0.0, double(weights.size() - 1));
                // At most four million samples in 32 cells: the product fits.
                cells.weight[cells.index(p * cells.count / voxels.size)] +=
                    weights[static_cast<std::size_t>(entry + 0.5)];
            }
    return cells;
}

// The middle between where a share of all the weight lies below, and above; in cells.
double middle(const std::vector<double>& weight, double total)
{
    std::size_t low = 0, high = weight.size() - 1;
    for (double sum = weight[low]; sum < LEFT_OUT * total && low < high;)
        sum += weight[++low];
    for (double sum = weight[high]; sum < LEFT_OUT * total && high > low;)
        sum += weight[--high];
    return 0.5 * static_cast<double>(low + high + 1);
}

} // namespace

std::optional<BoundingSphere> visibleSphere(const VoxelView& voxels, const ValueRange& range,
                                            const TransferFunction& function,
                                            const glm::dvec3& spacing)
{
    const Cells cells = weigh(voxels, range, function, spacing);
    std::vector<double> along[3];
    for (int axis = 0; axis < 3; ++axis)
        along[axis].assign(static_cast<std::size_t>(cells.count[axis]), 0.0);
    double total = 0.0;
    cells.forEach([&](const glm::ivec3& c, double weight) {
        for (int axis = 0; axis < 3; ++axis)
            along[axis][static_cast<std::size_t>(c[axis])] += weight;
        total += weight;
    });
    if (!(total > 0.0)) return std::nullopt;
    BoundingSphere sphere;
    for (int axis = 0; axis < 3; ++axis)
        sphere.center[axis] = middle(along[axis], total) * cells.size[axis];
    std::vector<std::pair<double, double>> byDistance; // and weight
    cells.forEach([&](const glm::ivec3& c, double weight) {
        if (weight > 0.0)
            byDistance.emplace_back(glm::distance(cells.center(c), sphere.center), weight);
    });
    std::sort(byDistance.begin(), byDistance.end());
    double sum = 0.0;
    for (const auto& [distance, weight] : byDistance) {
        sphere.radius = distance + 0.5 * glm::length(cells.size);
        sum += weight;
        if (sum >= (1.0 - LEFT_OUT) * total) break;
    }
    // Samples lie in the middle of what cells were made of.
    sphere.center -= 0.5 * spacing;
    return sphere;
}

} // namespace core
} // namespace osgVolumizer
