#include "ClipRecords.h"

#include "Interpolate.h"

#include <algorithm>

namespace osgVolumizer {
namespace core {

template <class Value, class Finish>
int RecordPolygon::cross(std::size_t i, Value value, double limit, Finish finish)
{
    double* r = grow();
    const double *p = at(_corners[i].lineFrom), *q = at(_corners[i].lineTo);
    double low = value(p), high = value(q);
    if (low > high) std::swap(p, q), std::swap(low, high);
    const double t = high > low ? std::min(1.0, std::max(0.0, (limit - low) / (high - low))) : 0.0;
    interpolate(p, q, t, _stride, r);
    finish(r);
    return static_cast<int>(_used) - 1;
}

template <class Value, class Finish>
void RecordPolygon::clip(Value value, double limit, bool above, Finish finish)
{
    const std::size_t n = _corners.size();
    if (n == 0) return;
    _heights.resize(n);
    bool anyAbove = false, anyBelow = false;
    for (std::size_t i = 0; i < n; ++i) {
        _heights[i] = value(at(_corners[i].record));
        anyAbove = anyAbove || _heights[i] > limit;
        anyBelow = anyBelow || _heights[i] < limit;
    }
    // A polygon in the plane itself belongs to the side above.
    if (above ? !anyBelow : !anyAbove && anyBelow) return;
    if (!(anyAbove && anyBelow)) {
        _corners.clear();
        return;
    }
    _next.clear();
    std::size_t leave = n; // where in _next the polygon leaves the half-space
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t j = i + 1 == n ? 0 : i + 1;
        const bool iIn = above ? _heights[i] >= limit : _heights[i] < limit;
        const bool jIn = above ? _heights[j] >= limit : _heights[j] < limit;
        const Corner corner = _corners[i];
        if (iIn) _next.push_back(corner);
        if (iIn == jIn) continue;
        // A crossing at a vertex is that vertex; if it is kept, it is in the list already.
        const bool onVertex = _heights[i] == limit || _heights[j] == limit;
        if (!onVertex || !above) {
            const int cut = !onVertex              ? cross(i, value, limit, finish)
                            : _heights[i] == limit ? corner.record
                                                   : _corners[j].record;
            _next.push_back({cut, corner.lineFrom, corner.lineTo});
        }
        if (iIn) leave = _next.size() - 1;
    }
    // The new edge runs between the two points where the polygon leaves and enters.
    if (leave < _next.size()) {
        _next[leave].lineFrom = _next[leave].record;
        _next[leave].lineTo = _next[leave + 1 == _next.size() ? 0 : leave + 1].record;
    }
    _corners.swap(_next);
    if (_corners.size() < 3) _corners.clear();
}

void RecordPolygon::clipField(int field, double limit, bool above)
{
    clip([field](const double* r) { return r[field]; }, limit, above,
         [field, limit](double* r) { r[field] = limit; });
}

void RecordPolygon::clipPlane(int field, const Plane& plane)
{
    // Of a plane and its negative one is chosen for both sides, so that they get the same points.
    const glm::dvec3& n = plane.normal;
    const bool above = n.x != 0.0 ? n.x > 0.0 : n.y != 0.0 ? n.y > 0.0 : n.z >= 0.0;
    const Plane upper = above ? plane : Plane{-n, -plane.offset};
    clip(
        [field, &upper](const double* r) {
            return upper.distance({r[field], r[field + 1], r[field + 2]});
        },
        0.0, above, [](double*) {});
}

Box3d RecordPolygon::extent(int field) const
{
    Box3d box;
    for (const Corner& c : _corners) {
        const double* r = at(c.record) + field;
        box.expand({r[0], r[1], r[2]});
    }
    return box;
}

void RecordPolygon::clipBox(int field, const Box3d& box, const Box3d& extent)
{
    for (int a = 0; a < 3; ++a) {
        // What lies in a plane of the box as a whole belongs to the upper side. A polygon that ends
        // at a plane is not cut by it, also where rounding has laid all of a remnant into the
        // plane.
        if (extent.max[a] < box.min[a] || extent.min[a] >= box.max[a]) _corners.clear();
        if (extent.min[a] < box.min[a]) clipField(field + a, box.min[a], true);
        if (extent.max[a] > box.max[a]) clipField(field + a, box.max[a], false);
    }
}

} // namespace core
} // namespace osgVolumizer
