#include "VisibleSphere.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace core {

namespace {

constexpr int CELLS = 32;            // along each axis
constexpr double LEFT_OUT = 0.005;   // share of what shows, at each end
constexpr double SHOWS_FULLY = 0.02; // opacity of a sample that counts as one

struct Cells
{
    std::vector<double> weight = std::vector<double>(CELLS * CELLS * CELLS, 0.0);
    glm::dvec3 size{1.0}; ///< object units

    glm::dvec3 center(int i) const
    {
        return (glm::dvec3(i % CELLS, i / CELLS % CELLS, i / (CELLS * CELLS)) + 0.5) * size;
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
    cells.size = glm::dvec3(voxels.size) * spacing / double(CELLS);
    std::int64_t i = 0;
    for (int z = 0; z < voxels.size.z; ++z)
        for (int y = 0; y < voxels.size.y; ++y) {
            const int row =
                CELLS * (y * CELLS / voxels.size.y + CELLS * (z * CELLS / voxels.size.z));
            for (int x = 0; x < voxels.size.x; ++x, ++i) {
                const double v = (voxelValue(voxels, i) - range.low) * scale;
                if (std::isnan(v)) continue;
                const double entry = std::clamp(v, 0.0, double(weights.size() - 1));
                cells.weight[static_cast<std::size_t>(row + x * CELLS / voxels.size.x)] +=
                    weights[static_cast<std::size_t>(entry + 0.5)];
            }
        }
    return cells;
}

// The middle between where a share of all the weight lies below, and above.
double middle(const std::array<double, CELLS>& weight, double total)
{
    int low = 0, high = CELLS - 1;
    for (double sum = weight[0]; sum < LEFT_OUT * total && low + 1 < CELLS;)
        sum += weight[static_cast<std::size_t>(++low)];
    for (double sum = weight[CELLS - 1]; sum < LEFT_OUT * total && high > low;)
        sum += weight[static_cast<std::size_t>(--high)];
    return 0.5 * (low + high + 1);
}

} // namespace

std::optional<Sphere> visibleSphere(const VoxelView& voxels, const ValueRange& range,
                                    const TransferFunction& function, const glm::dvec3& spacing)
{
    const Cells cells = weigh(voxels, range, function, spacing);
    std::array<double, CELLS> along[3] = {};
    double total = 0.0;
    for (int i = 0; i < CELLS * CELLS * CELLS; ++i) {
        const double w = cells.weight[static_cast<std::size_t>(i)];
        const int place[] = {i % CELLS, i / CELLS % CELLS, i / (CELLS * CELLS)};
        for (int axis = 0; axis < 3; ++axis)
            along[axis][static_cast<std::size_t>(place[axis])] += w;
        total += w;
    }
    if (!(total > 0.0)) return std::nullopt;
    Sphere sphere;
    for (int axis = 0; axis < 3; ++axis)
        sphere.center[axis] = middle(along[axis], total) * cells.size[axis];
    std::vector<std::pair<double, double>> byDistance; // and weight
    for (int i = 0; i < CELLS * CELLS * CELLS; ++i)
        if (const double w = cells.weight[static_cast<std::size_t>(i)]; w > 0.0)
            byDistance.emplace_back(glm::distance(cells.center(i), sphere.center), w);
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
