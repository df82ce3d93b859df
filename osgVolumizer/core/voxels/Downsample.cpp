#include "Downsample.h"

#include "VoxelData.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace osgVolumizer {
namespace core {

namespace {

// Of scalars; NaN where there is nothing else.
double meanOf(const double* values, int count)
{
    double sum = 0.0;
    int used = 0;
    for (int i = 0; i < count; ++i) {
        if (std::isnan(values[i])) continue;
        sum += values[i];
        ++used;
    }
    return used ? sum / used : std::numeric_limits<double>::quiet_NaN();
}

double modeOf(double* values, int count)
{
    std::sort(values, values + count);
    double best = values[0];
    int most = 0;
    for (int i = 0; i < count;) {
        int end = i + 1;
        while (end < count && values[end] == values[i])
            ++end;
        if (end - i > most) {
            most = end - i;
            best = values[i];
        }
        i = end;
    }
    return best;
}

// Straight RGBA: colours weighted by alpha, so that what is transparent does not bleed.
void meanColor(const double* colors, int count, double* mean)
{
    double sums[4] = {0.0, 0.0, 0.0, 0.0}, plain[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < count; ++i) {
        const double* c = colors + 4 * i;
        for (int k = 0; k < 3; ++k) {
            sums[k] += c[3] * c[k];
            plain[k] += c[k];
        }
        sums[3] += c[3];
    }
    for (int k = 0; k < 3; ++k)
        mean[k] = sums[3] != 0.0 ? sums[k] / sums[3] : plain[k] / count;
    mean[3] = sums[3] / count;
}

} // namespace

void downsample(const void* fine, const glm::ivec3& size, VoxelType type, int components,
                LevelRule rule, void* coarse)
{
    const glm::ivec3 half = size / 2 + size % 2;
    const std::size_t voxel = voxelTypeSize(type) * static_cast<std::size_t>(components);
    const auto* in = static_cast<const unsigned char*>(fine);
    auto* out = static_cast<unsigned char*>(coarse);
    const auto rowValues = static_cast<std::size_t>(size.x) * static_cast<std::size_t>(components);
    std::vector<double> rows[4];
    std::vector<double> result(static_cast<std::size_t>(half.x * components));
    double group[8 * 4];
    for (int z = 0; z < half.z; ++z)
        for (int y = 0; y < half.y; ++y) {
            int rowCount = 0;
            for (int k = 2 * z; k < std::min(2 * z + 2, size.z); ++k)
                for (int j = 2 * y; j < std::min(2 * y + 2, size.y); ++j) {
                    std::vector<double>& row = rows[rowCount++];
                    row.resize(rowValues);
                    const std::size_t offset =
                        (std::size_t(k) * size.y + std::size_t(j)) * std::size_t(size.x) * voxel;
                    convertVoxels(in + offset, type, row.data(), VoxelType::FLOAT64, rowValues);
                }
            for (int x = 0; x < half.x; ++x) {
                int count = 0;
                for (int r = 0; r < rowCount; ++r)
                    for (int i = 2 * x; i < std::min(2 * x + 2, size.x); ++i, ++count)
                        std::copy_n(rows[r].data() + std::size_t(i) * components, components,
                                    group + count * components);
                double* to = result.data() + std::size_t(x) * components;
                if (components == 4)
                    meanColor(group, count, to);
                else
                    *to = rule == LevelRule::MODE ? modeOf(group, count) : meanOf(group, count);
            }
            convertVoxels(result.data(), VoxelType::FLOAT64, out, type, result.size());
            out += static_cast<std::size_t>(half.x) * voxel;
        }
}

} // namespace core
} // namespace osgVolumizer
