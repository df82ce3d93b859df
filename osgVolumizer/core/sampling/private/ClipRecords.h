#pragma once

#include "../../geometry/Box.h"

#include <cstddef>
#include <vector>

namespace osgVolumizer {
namespace core {

/// A convex polygon of vertex records that is clipped by one plane after another (Sutherland and
/// Hodgman, "Reentrant polygon clipping", CACM 17, 1974), with one addition: every edge remembers
/// the line that it was cut from, and new points are interpolated on that line, from its low to its
/// high end. So a point does not depend on what else was cut off, nor on the side that is kept:
/// neighbouring bricks, and tetrahedra that share the line, get the same bits, provided all clip
/// along x, y and z in this order.
class RecordPolygon
{
public:
    /// Starts with no vertices of `stride` values each.
    void reset(int stride)
    {
        _stride = static_cast<std::size_t>(stride);
        _used = 0;
        _corners.clear();
    }
    /// Room for one more record; valid until the next call. Append in order, then close().
    double* append()
    {
        _corners.push_back({static_cast<int>(_used), 0, 0});
        return grow();
    }
    /// Connects the appended vertices.
    void close()
    {
        const std::size_t n = _corners.size();
        for (std::size_t i = 0; i < n; ++i) {
            _corners[i].lineFrom = _corners[i].record;
            _corners[i].lineTo = _corners[i + 1 == n ? 0 : i + 1].record;
        }
    }
    std::size_t size() const { return _corners.size(); }
    const double* record(std::size_t corner) const { return at(_corners[corner].record); }
    /// What clipping changes; records that were made stay where they are.
    class Shape
    {
        friend class RecordPolygon;
        struct Corner
        {
            int record, lineFrom, lineTo;
        };
        std::vector<Corner> corners;
        std::size_t used = 0;
    };
    /// Remembers the polygon as it is, to go back to it after clipping. Both keep their memory.
    void save(Shape& shape) const
    {
        shape.corners.assign(_corners.begin(), _corners.end());
        shape.used = _used;
    }
    /// Expects that `shape` was saved since the last reset().
    void restore(const Shape& shape)
    {
        _corners.assign(shape.corners.begin(), shape.corners.end());
        _used = shape.used;
    }

    /// Keeps the part with value >= limit (`above`) or value < limit, the value being that of field
    /// `field`. The field is set to the limit exactly in the points that are made.
    void clipField(int field, double limit, bool above);
    /// Keeps the part in the half-space; `field` is where the three coordinates are. The other side
    /// of the same plane gets the same points; what lies in the plane belongs to the side that the
    /// first non-zero coordinate of the normal points to.
    void clipPlane(int field, const Plane& plane);
    /// Keeps the part in the half-open box; `field` is where the three coordinates are.
    void clipBox(int field, const Box3d& box) { clipBox(field, box, extent(field)); }
    /// The same where the extent is known.
    void clipBox(int field, const Box3d& box, const Box3d& extent);
    Box3d extent(int field) const;

private:
    /// A vertex, and the line that carries the edge from it to the next.
    using Corner = Shape::Corner;

    const double* at(int record) const
    {
        return _values.data() + static_cast<std::size_t>(record) * _stride;
    }
    double* grow()
    {
        ++_used;
        if (_values.size() < _used * _stride) _values.resize(2 * _used * _stride);
        return _values.data() + (_used - 1) * _stride;
    }
    /// Makes the point where edge `i` crosses the limit; returns its record.
    template <class Value, class Finish>
    int cross(std::size_t i, Value value, double limit, Finish finish);
    template <class Value, class Finish>
    void clip(Value value, double limit, bool above, Finish finish);

    std::size_t _stride = 3;
    std::size_t _used = 0; ///< records
    std::vector<double> _values;
    std::vector<Corner> _corners, _next;
    std::vector<double> _heights;
};

} // namespace core
} // namespace osgVolumizer
