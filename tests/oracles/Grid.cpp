#include "Grid.h"

#include "Roots.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace osgVolumizer {
namespace oracle {

/// Corners of the cell around a point, and the point's place in it.
struct Grid::Cell
{
    double corner[8]; ///< bit 0 of the index selects x + 1, and so on
    glm::dvec3 f;
};

Grid::Grid(const glm::ivec3& size, std::vector<double> samples, Interpolation how)
    : _size(size), _samples(std::move(samples)), _interpolation(how)
{
}

Grid::Grid(const glm::ivec3& size, const Field& field, const glm::dmat4& gridToField,
           Interpolation how)
    : _size(size), _interpolation(how)
{
    _samples.reserve(std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z));
    for (int k = 0; k < size.z; ++k)
        for (int j = 0; j < size.y; ++j)
            for (int i = 0; i < size.x; ++i)
                _samples.push_back(field.value(glm::dvec3(gridToField * glm::dvec4(i, j, k, 1.0))));
}

Grid::Cell Grid::cellAt(const glm::dvec3& p) const
{
    Cell cell;
    int low[3], high[3];
    for (int a = 0; a < 3; ++a) {
        const double v = std::clamp(p[a], 0.0, double(_size[a] - 1));
        low[a] = std::clamp(int(v), 0, std::max(0, _size[a] - 2));
        high[a] = std::min(low[a] + 1, _size[a] - 1);
        cell.f[a] = v - low[a];
    }
    for (int c = 0; c < 8; ++c)
        cell.corner[c] =
            sample(c & 1 ? high[0] : low[0], c & 2 ? high[1] : low[1], c & 4 ? high[2] : low[2]);
    return cell;
}

double Grid::cubicValue(const glm::dvec3& p) const
{
    int index[3][4];
    double weight[3][4];
    for (int a = 0; a < 3; ++a) {
        const double v = std::clamp(p[a], 0.0, double(_size[a] - 1));
        const int low = int(v);
        for (int n = 0; n < 4; ++n) {
            index[a][n] = std::clamp(low + n - 1, 0, _size[a] - 1);
            const double d = std::abs(v - (low + n - 1));
            weight[a][n] = d < 1.0   ? (1.5 * d - 2.5) * d * d + 1.0
                           : d < 2.0 ? ((-0.5 * d + 2.5) * d - 4.0) * d + 2.0
                                     : 0.0;
        }
    }
    double sum = 0.0;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i)
                sum += weight[0][i] * weight[1][j] * weight[2][k] *
                       sample(index[0][i], index[1][j], index[2][k]);
    return sum;
}

double Grid::value(const glm::dvec3& p) const
{
    if (_interpolation == NEAREST) {
        int i[3];
        for (int a = 0; a < 3; ++a)
            i[a] = int(std::floor(std::clamp(p[a], 0.0, double(_size[a] - 1)) + 0.5));
        return sample(i[0], i[1], i[2]);
    }
    if (_interpolation == CUBIC) return cubicValue(p);
    const Cell cell = cellAt(p);
    const double* c = cell.corner;
    const glm::dvec3& f = cell.f;
    const double x00 = c[0] + f.x * (c[1] - c[0]), x10 = c[2] + f.x * (c[3] - c[2]);
    const double x01 = c[4] + f.x * (c[5] - c[4]), x11 = c[6] + f.x * (c[7] - c[6]);
    const double y0 = x00 + f.y * (x10 - x00), y1 = x01 + f.y * (x11 - x01);
    return y0 + f.z * (y1 - y0);
}

glm::dvec3 Grid::gradient(const glm::dvec3& p) const
{
    glm::dvec3 g(0.0);
    if (_interpolation == NEAREST) return g;
    const Cell cell = cellAt(p);
    for (int c = 0; c < 8; ++c) {
        double weight[3], slope[3];
        for (int a = 0; a < 3; ++a) {
            const bool upper = (c >> a) & 1;
            weight[a] = upper ? cell.f[a] : 1.0 - cell.f[a];
            slope[a] = upper ? 1.0 : -1.0;
        }
        g += cell.corner[c] * glm::dvec3(slope[0] * weight[1] * weight[2],
                                         weight[0] * slope[1] * weight[2],
                                         weight[0] * weight[1] * slope[2]);
    }
    return g;
}

void Grid::appendBreaks(const glm::dvec3& origin, const glm::dvec3& direction, double t0, double t1,
                        const std::vector<double>& values, std::vector<double>& breaks) const
{
    std::vector<double> faces{t0, t1};
    const double shift = _interpolation == NEAREST ? 0.5 : 0.0;
    for (int a = 0; a < 3; ++a) {
        if (direction[a] == 0.0) continue;
        double low = origin[a] + t0 * direction[a], high = origin[a] + t1 * direction[a];
        if (low > high) std::swap(low, high);
        const int first = std::max(0, int(std::ceil(std::max(low, -1.0) - shift)));
        const int last = std::min(_size[a] - 1, int(std::floor(std::min(high, 1e9) - shift)));
        for (int plane = first; plane <= last; ++plane) {
            const double t = (plane + shift - origin[a]) / direction[a];
            if (t > t0 && t < t1) faces.push_back(t);
        }
    }
    std::sort(faces.begin(), faces.end());
    if (_interpolation == LINEAR && !values.empty()) {
        for (std::size_t i = 0; i + 1 < faces.size(); ++i) {
            const double step = (faces[i + 1] - faces[i]) / 3.0;
            double f[4]; // along a line in a cell, the trilinear interpolant is a cubic
            for (int n = 0; n < 4; ++n)
                f[n] = value(origin + (faces[i] + n * step) * direction);
            appendCubicRoots(f, values, faces[i], faces[i + 1], breaks);
        }
    }
    if (_interpolation == CUBIC)
        for (std::size_t i = 0; i + 1 < faces.size(); ++i)
            for (int n = 1; n < 4; ++n)
                breaks.push_back(faces[i] + 0.25 * n * (faces[i + 1] - faces[i]));
    breaks.insert(breaks.end(), faces.begin() + 1, faces.end() - 1);
}

namespace {

// Calls f with a value of the C++ type that a voxel type stands for.
template <class F>
void withType(VoxelType type, F f)
{
    switch (type) {
    case VoxelType::INT8:
        f(std::int8_t());
        break;
    case VoxelType::UINT8:
        f(std::uint8_t());
        break;
    case VoxelType::INT16:
        f(std::int16_t());
        break;
    case VoxelType::UINT16:
        f(std::uint16_t());
        break;
    case VoxelType::INT32:
        f(std::int32_t());
        break;
    case VoxelType::UINT32:
        f(std::uint32_t());
        break;
    case VoxelType::FLOAT32:
        f(float());
        break;
    case VoxelType::FLOAT64:
        f(double());
        break;
    case VoxelType::HALF:
        break;
    }
}

} // namespace

std::vector<double> toDoubles(const void* voxels, std::size_t count, VoxelType type)
{
    std::vector<double> result;
    result.reserve(count);
    withType(type, [&](auto value) {
        const auto* bytes = static_cast<const unsigned char*>(voxels);
        for (std::size_t i = 0; i < count; ++i) {
            std::memcpy(&value, bytes + i * sizeof(value), sizeof(value));
            result.push_back(double(value));
        }
    });
    return result;
}

std::vector<unsigned char> fromDoubles(const std::vector<double>& values, VoxelType type)
{
    std::vector<unsigned char> result;
    withType(type, [&](auto sample) {
        using T = decltype(sample);
        result.resize(values.size() * sizeof(T));
        for (std::size_t i = 0; i < values.size(); ++i) {
            double v = values[i];
            if (std::is_integral<T>::value)
                v = std::clamp(std::floor(v + 0.5), double(std::numeric_limits<T>::lowest()),
                               double(std::numeric_limits<T>::max()));
            sample = static_cast<T>(v);
            std::memcpy(result.data() + i * sizeof(T), &sample, sizeof(T));
        }
    });
    return result;
}

} // namespace oracle
} // namespace osgVolumizer
