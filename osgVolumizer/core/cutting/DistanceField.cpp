#include "DistanceField.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace osgVolumizer {
namespace core {

namespace {

constexpr int BLOCK = 8; // cells along the edge of a block whose range is kept
constexpr std::uint32_t NO_TRIANGLE = 0xffffffffu;

double distanceTo(const TriangleMesh& mesh, std::uint32_t triangle, const glm::dvec3& p)
{
    return squaredDistance(p, mesh.corner(triangle, 0), mesh.corner(triangle, 1),
                           mesh.corner(triangle, 2));
}

// Where the line of y and z (along x) meets a triangle; false where it does not. A line through an
// edge or a corner meets one of the triangles there, or an even number: edges are half-open in z,
// and the place on an edge does not depend on the triangle that it is asked for.
bool meetsLine(const TriangleMesh& mesh, std::size_t triangle, double y, double z, double& x)
{
    bool inside = false;
    for (std::size_t k = 0; k < 3; ++k) {
        std::uint32_t i = mesh.indices[3 * triangle + k];
        std::uint32_t j = mesh.indices[3 * triangle + (k + 1) % 3];
        if (i > j) std::swap(i, j);
        const glm::dvec3 &a = mesh.vertices[i], &b = mesh.vertices[j];
        if ((a.z > z) == (b.z > z)) continue;
        if (y < a.y + (z - a.z) / (b.z - a.z) * (b.y - a.y)) inside = !inside;
    }
    if (!inside) return false;
    const glm::dvec3& a = mesh.corner(triangle, 0);
    const glm::dvec3 normal =
        glm::cross(mesh.corner(triangle, 1) - a, mesh.corner(triangle, 2) - a);
    double low = a.x, high = a.x;
    for (int k = 1; k < 3; ++k) {
        low = std::min(low, mesh.corner(triangle, k).x);
        high = std::max(high, mesh.corner(triangle, k).x);
    }
    const double plane = a.x - (normal.y * (y - a.y) + normal.z * (z - a.z)) / normal.x;
    x = std::isfinite(plane) ? std::clamp(plane, low, high) : 0.5 * (low + high);
    return true;
}

} // namespace

DistanceField::DistanceField(const Box3d& box, const glm::ivec3& samples, double reach)
    : _box(box), _samples(glm::max(samples, 2)), _reach(reach)
{
    const glm::ivec3& n = _samples;
    _values.assign(std::size_t(n.x) * std::size_t(n.y) * std::size_t(n.z),
                   static_cast<float>(_reach));
    findBlocks();
}

template <class F>
void DistanceField::forSamples(const Box3i& part, F&& f) const
{
    glm::ivec3 i;
    for (i.z = part.min.z; i.z < part.max.z; ++i.z)
        for (i.y = part.min.y; i.y < part.max.y; ++i.y)
            for (i.x = part.min.x; i.x < part.max.x; ++i.x)
                f(i);
}

glm::dvec3 DistanceField::gridPlace(const glm::dvec3& place) const
{
    return glm::clamp((place - _box.min) / spacing(), glm::dvec3(0.0), glm::dvec3(_samples - 1));
}

double DistanceField::at(const glm::dvec3& place) const
{
    const glm::dvec3 p = gridPlace(place);
    const glm::ivec3 low = glm::min(glm::ivec3(p), _samples - 2);
    const glm::dvec3 f = p - glm::dvec3(low);
    double sum = 0.0;
    for (int k = 0; k < 8; ++k) {
        const glm::ivec3 corner(k & 1, k >> 1 & 1, k >> 2);
        const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(corner));
        sum += w.x * w.y * w.z * double(_values[index(low + corner)]);
    }
    return sum;
}

ValueRange DistanceField::rangeIn(const Box3d& box) const
{
    const glm::ivec3 first = glm::min(glm::ivec3(gridPlace(box.min)), _samples - 2) / BLOCK;
    const glm::ivec3 last = glm::min(glm::ivec3(gridPlace(box.max)), _samples - 2) / BLOCK;
    ValueRange range;
    for (int z = first.z; z <= last.z; ++z)
        for (int y = first.y; y <= last.y; ++y)
            for (int x = first.x; x <= last.x; ++x)
                range.expand(
                    _blocks[std::size_t(x) +
                            std::size_t(_blockCount.x) *
                                (std::size_t(y) + std::size_t(_blockCount.y) * std::size_t(z))]);
    return range;
}

void DistanceField::findBlocks()
{
    _blockCount = (_samples - 2) / BLOCK + 1;
    _blocks.assign(std::size_t(_blockCount.x) * std::size_t(_blockCount.y) *
                       std::size_t(_blockCount.z),
                   ValueRange());
    std::size_t block = 0;
    forSamples({glm::ivec3(0), _blockCount}, [&](const glm::ivec3& b) {
        ValueRange& range = _blocks[block++];
        const Box3i part{b * BLOCK, glm::min(b * BLOCK + BLOCK + 1, _samples)};
        forSamples(part, [&](const glm::ivec3& i) {
            const double v = _values[index(i)];
            range.expand({v, v});
        });
    });
}

void DistanceField::keepLess(const std::vector<float>& values)
{
    for (std::size_t i = 0; i < values.size(); ++i)
        _values[i] = std::min(_values[i], values[i]);
    findBlocks();
}

void DistanceField::cutByDistance(const std::function<double(const glm::dvec3&)>& distance)
{
    std::vector<float> values(_values.size());
    forSamples({glm::ivec3(0), _samples}, [&](const glm::ivec3& i) {
        values[index(i)] = static_cast<float>(std::clamp(distance(sampleAt(i)), -_reach, _reach));
    });
    keepLess(values);
}

void DistanceField::cutByFunction(const std::function<double(const glm::dvec3&)>& function,
                                  bool distances)
{
    std::vector<double> f(_values.size());
    forSamples({glm::ivec3(0), _samples}, [&](const glm::ivec3& i) {
        const double value = function(sampleAt(i));
        f[index(i)] = std::isnan(value) ? -std::numeric_limits<double>::max() : value;
    });
    std::vector<float> values = distances ? distancesTo(zerosOf(f)) : scaledToDistances(f);
    for (std::size_t i = 0; distances && i < values.size(); ++i)
        if (!(f[i] > 0.0)) values[i] = -values[i];
    keepLess(values);
}

// Where nothing changes all lies on one side.
std::vector<float> DistanceField::scaledToDistances(const std::vector<double>& f) const
{
    double steepest = 0.0; // change per unit of length
    const glm::dvec3 edges = spacing();
    forSamples({glm::ivec3(0), _samples}, [&](const glm::ivec3& i) {
        glm::dvec3 rate(0.0);
        for (int axis = 0; axis < 3; ++axis) {
            glm::ivec3 next = i;
            if (++next[axis] < _samples[axis])
                rate[axis] = (f[index(next)] - f[index(i)]) / edges[axis];
        }
        const double length = glm::length(rate);
        if (std::isfinite(length)) steepest = std::max(steepest, length);
    });
    std::vector<float> values(f.size());
    for (std::size_t i = 0; i < f.size(); ++i) {
        const double scaled = steepest > 0.0 ? f[i] / steepest : f[i] > 0.0 ? _reach : -_reach;
        values[i] = static_cast<float>(std::clamp(scaled, -_reach, _reach));
    }
    return values;
}

// As triangles of one point each.
TriangleMesh DistanceField::zerosOf(const std::vector<double>& f) const
{
    TriangleMesh points;
    forSamples({glm::ivec3(0), _samples}, [&](const glm::ivec3& i) {
        for (int axis = 0; axis < 3; ++axis) {
            glm::ivec3 next = i;
            if (++next[axis] >= _samples[axis]) continue;
            const double a = f[index(i)], b = f[index(next)];
            if ((a > 0.0) == (b > 0.0)) continue;
            const auto number = static_cast<std::uint32_t>(points.vertices.size());
            points.vertices.push_back(glm::mix(sampleAt(i), sampleAt(next), a / (a - b)));
            points.indices.insert(points.indices.end(), 3, number);
        }
    });
    return points;
}

void DistanceField::cutBySurface(const TriangleMesh& mesh, bool keepInside)
{
    const std::vector<std::uint8_t> inside = insideOf(mesh);
    std::vector<float> values = distancesTo(mesh);
    for (std::size_t i = 0; i < values.size(); ++i)
        if ((inside[i] != 0) != keepInside) values[i] = -values[i];
    keepLess(values);
}

std::vector<std::uint8_t> DistanceField::insideOf(const TriangleMesh& mesh) const
{
    const glm::dvec3 edges = spacing();
    std::vector<std::vector<double>> rows(std::size_t(_samples.y) * std::size_t(_samples.z));
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        Box3d bounds;
        for (int k = 0; k < 3; ++k)
            bounds.expand(mesh.corner(t, k));
        const glm::ivec3 first(gridPlace(bounds.min)), last(glm::ceil(gridPlace(bounds.max)));
        for (int z = first.z; z <= last.z; ++z)
            for (int y = first.y; y <= last.y; ++y) {
                double x = 0.0;
                if (meetsLine(mesh, t, _box.min.y + y * edges.y, _box.min.z + z * edges.z, x))
                    rows[std::size_t(y) + std::size_t(_samples.y) * std::size_t(z)].push_back(x);
            }
    }
    std::vector<std::uint8_t> inside(_values.size(), 0);
    for (std::size_t row = 0; row < rows.size(); ++row) {
        std::sort(rows[row].begin(), rows[row].end());
        auto next = rows[row].begin();
        std::uint8_t in = 0;
        for (int x = 0; x < _samples.x; ++x) {
            for (; next != rows[row].end() && *next <= _box.min.x + x * edges.x; ++next)
                in ^= 1;
            inside[row * std::size_t(_samples.x) + std::size_t(x)] = in;
        }
    }
    return inside;
}

// Exact next to the mesh; farther away the nearest triangle is that of a neighbour (Danielsson,
// "Euclidean distance mapping", CGIP 14, 1980): as good as never wrong.
std::vector<float> DistanceField::distancesTo(const TriangleMesh& mesh) const
{
    constexpr double FAR_AWAY = 1e300;
    std::vector<double> squares(_values.size(), FAR_AWAY);
    std::vector<std::uint32_t> nearest(_values.size(), NO_TRIANGLE);
    const auto look = [&](const glm::ivec3& i, std::uint32_t triangle) {
        const std::size_t at = index(i);
        if (nearest[at] == triangle) return;
        const double square = distanceTo(mesh, triangle, sampleAt(i));
        if (!(square < squares[at])) return;
        squares[at] = square;
        nearest[at] = triangle;
    };
    const glm::dvec3 edges = spacing();
    const double seeded = 1.8 * std::max({edges.x, edges.y, edges.z});
    for (std::size_t t = 0; t < mesh.triangleCount(); ++t) {
        Box3d bounds;
        for (int k = 0; k < 3; ++k)
            bounds.expand(mesh.corner(t, k));
        const glm::dvec3 low = (bounds.min - seeded - _box.min) / edges;
        const glm::dvec3 high = (bounds.max + seeded - _box.min) / edges;
        const glm::dvec3 end(_samples - 1);
        if (glm::any(glm::lessThan(high, glm::dvec3(0.0))) || glm::any(glm::greaterThan(low, end)))
            continue;
        const Box3i part{glm::ivec3(glm::ceil(glm::clamp(low, glm::dvec3(0.0), end))),
                         glm::ivec3(glm::floor(glm::clamp(high, glm::dvec3(0.0), end))) + 1};
        const glm::dvec3& a = mesh.corner(t, 0);
        glm::dvec3 normal = glm::cross(mesh.corner(t, 1) - a, mesh.corner(t, 2) - a);
        const double length = glm::length(normal);
        normal = length > 0.0 ? normal / length : glm::dvec3(0.0);
        forSamples(part, [&](const glm::ivec3& i) {
            if (std::abs(glm::dot(normal, sampleAt(i) - a)) <= seeded)
                look(i, static_cast<std::uint32_t>(t));
        });
    }
    const Box3i all{glm::ivec3(0), _samples};
    const bool farther = _reach > seeded;
    for (int pass = 0; farther && pass < 2; ++pass)
        for (std::size_t n = 0; n < _values.size(); ++n) {
            const std::size_t at = pass == 0 ? n : _values.size() - 1 - n;
            const glm::ivec3 i(int(at % std::size_t(_samples.x)),
                               int(at / std::size_t(_samples.x) % std::size_t(_samples.y)),
                               int(at / (std::size_t(_samples.x) * std::size_t(_samples.y))));
            for (int k = 0; k < 13; ++k) { // the neighbours that come before
                const glm::ivec3 step(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
                const glm::ivec3 j = pass == 0 ? i + step : i - step;
                if (glm::any(glm::lessThan(j, all.min)) ||
                    glm::any(glm::greaterThanEqual(j, all.max)))
                    continue;
                if (const std::uint32_t t = nearest[index(j)]; t != NO_TRIANGLE) look(i, t);
            }
        }
    std::vector<float> distances(_values.size());
    for (std::size_t i = 0; i < distances.size(); ++i)
        distances[i] = static_cast<float>(std::min(std::sqrt(squares[i]), _reach));
    return distances;
}

} // namespace core
} // namespace osgVolumizer
