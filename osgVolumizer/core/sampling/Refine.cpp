#include "Refine.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace osgVolumizer {
namespace core {

namespace {

constexpr std::uint32_t UNSPLIT = 0xfffffffeu;
constexpr int EDGES[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

double squaredLength(const glm::dvec3& a, const glm::dvec3& b)
{
    return glm::dot(a - b, a - b);
}

bool before(const glm::dvec3& a, const glm::dvec3& b)
{
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// A strict order of edges that depends on their positions only: longer first.
bool goesFirst(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d)
{
    const double ab = squaredLength(a, b), cd = squaredLength(c, d);
    if (ab != cd) return ab > cd;
    const glm::dvec3 &p = before(a, b) ? a : b, &q = before(a, b) ? b : a;
    const glm::dvec3 &r = before(c, d) ? c : d, &s = before(c, d) ? d : c;
    return p != r ? before(p, r) : before(q, s);
}

} // namespace

double Refiner::valueAt(const TetraSet& set, std::size_t vertex) const
{
    const VertexFormat& format = set.vertices.format();
    const double* r = set.vertices.record(vertex);
    const double* p = r + format.positionOffset();
    return (*_value)(p, format.voxelCoordinateSize == 3 ? r + format.voxelCoordinateOffset() : p);
}

std::uint32_t Refiner::middle(TetraSet& out, std::vector<double>& values, TetraSet::Index a,
                              TetraSet::Index b)
{
    std::uint32_t& known = _middles(a, b);
    if (known != EdgeMap::NONE) return known;
    known = UNSPLIT;
    if (!(squaredLength(out.vertices.position(a), out.vertices.position(b)) > _shortestSquared))
        return known;
    const std::size_t m = out.vertices.size();
    out.vertices.resize(m + 1);
    const double *p = out.vertices.record(a), *q = out.vertices.record(b);
    double* r = out.vertices.record(m);
    for (int k = 0; k < out.vertices.format().stride(); ++k)
        r[k] = 0.5 * (p[k] + q[k]);
    const double v = valueAt(out, m);
    if (std::abs(v - 0.5 * (values[a] + values[b])) > _tolerance) {
        values.push_back(v);
        known = static_cast<std::uint32_t>(m);
    } else {
        out.vertices.resize(m);
    }
    return known;
}

Status Refiner::refine(const TetraSet& in, const Box3d& bounds, const Function& value,
                       double tolerance, TetraSet& out, std::vector<double>& values)
{
    _value = &value;
    _tolerance = tolerance;
    _shortestSquared = glm::dot(bounds.size(), bounds.size()) * SHORTEST_EDGE * SHORTEST_EDGE;
    _middles.clear();
    _parents.clear();
    out.vertices = in.vertices;
    out.indices.clear();
    values.clear();
    for (std::size_t i = 0; i < in.vertices.size(); ++i)
        values.push_back(valueAt(in, i));
    for (std::size_t i = 0; i < in.indices.size(); i += 4) {
        _stack.assign(in.indices.begin() + static_cast<std::ptrdiff_t>(i),
                      in.indices.begin() + static_cast<std::ptrdiff_t>(i + 4));
        while (!_stack.empty()) {
            TetraSet::Index t[4];
            std::copy(_stack.end() - 4, _stack.end(), t);
            _stack.resize(_stack.size() - 4);
            int split = -1;
            std::uint32_t m = UNSPLIT;
            for (int e = 0; e < 6; ++e) {
                const TetraSet::Index a = t[EDGES[e][0]], b = t[EDGES[e][1]];
                const std::uint32_t v = middle(out, values, a, b);
                if (v == UNSPLIT) continue;
                if (split < 0 || goesFirst(out.vertices.position(a), out.vertices.position(b),
                                           out.vertices.position(t[EDGES[split][0]]),
                                           out.vertices.position(t[EDGES[split][1]]))) {
                    split = e;
                    m = v;
                }
            }
            if (split < 0) {
                out.indices.insert(out.indices.end(), t, t + 4);
                _parents.push_back(static_cast<std::uint32_t>(i / 4));
                if (out.tetraCount() > in.tetraCount() + MAX_NEW_TETRAHEDRA)
                    return {ErrorCode::TOO_LARGE,
                            "polygonize: the tolerance of " + std::to_string(tolerance) +
                                " of a layer needs more than 2^20 tetrahedra besides.",
                            static_cast<std::int64_t>(i / 4)};
                continue;
            }
            // Replacing either end by the middle keeps the orientation.
            for (int end = 0; end < 2; ++end) {
                TetraSet::Index child[4] = {t[0], t[1], t[2], t[3]};
                child[EDGES[split][end]] = m;
                _stack.insert(_stack.end(), child, child + 4);
            }
        }
    }
    return {};
}

} // namespace core
} // namespace osgVolumizer
