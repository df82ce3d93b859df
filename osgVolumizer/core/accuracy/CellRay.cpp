#include "CellRay.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

constexpr double GAUSS = 0.21132486540518713; // (1 - 1/sqrt(3)) / 2
constexpr double MOST_BITS = 1.0;             // of extinction in a piece,
constexpr double LEAST_PART = 1.0 / 64.0;     // unless it is as short a part of a cell

// Value along a cell, from 0 to 1.
struct Cubic
{
    double a, b, c, d;

    explicit Cubic(const glm::dvec4& y) // at 0, 1/3, 2/3, 1
        : a(y.x), b(-5.5 * y.x + 9.0 * y.y - 4.5 * y.z + y.w),
          c(9.0 * y.x - 22.5 * y.y + 18.0 * y.z - 4.5 * y.w),
          d(4.5 * (3.0 * (y.y - y.z) + y.w - y.x))
    {
    }
    double at(double s) const { return a + s * (b + s * (c + s * d)); }
    double slope(double s) const { return b + s * (2.0 * c + s * 3.0 * d); }
    // Where it turns round, both in order; 1 where it does not within the cell.
    glm::dvec2 turns() const
    {
        const double discriminant = c * c - 3.0 * d * b;
        if (!(discriminant > 0.0)) return {1.0, 1.0};
        const double q = -(c + std::copysign(std::sqrt(discriminant), c));
        const auto within = [](double s) { return s > 0.0 && s < 1.0 ? s : 1.0; };
        const double r0 = within(q / (3.0 * d)), r1 = within(b / q);
        return {std::min(r0, r1), std::max(r0, r1)};
    }
    // Where it has a value that lies between those at two ends, between which it does not turn.
    double find(double value, double low, double high) const
    {
        const double from = at(low), rising = at(high) > from ? 1.0 : -1.0;
        // From a parabola that agrees in both ends' values, and in the slope at the first.
        const double h = high - low, slope0 = slope(low);
        const double bend = (at(high) - from - slope0 * h) / (h * h), rest = value - from;
        const double root = std::sqrt(std::max(slope0 * slope0 + 4.0 * bend * rest, 0.0));
        double s = low + 2.0 * rest / (slope0 + rising * root);
        if (!(s > low && s < high)) s = 0.5 * (low + high);
        for (int i = 0; i < 8; ++i) {
            const double off = at(s) - value;
            if (off * rising > 0.0)
                high = s;
            else
                low = s;
            const double next = s - off / slope(s);
            const double kept = next >= low && next <= high ? next : 0.5 * (low + high);
            if (std::abs(kept - s) < 1e-15) break;
            s = kept;
        }
        return s;
    }
};

// Distance along the ray of the next face of a cell on each axis, and from one to the next.
struct Faces
{
    glm::dvec3 next, distance;
};

Faces facesOn(const glm::dvec3& begin, const glm::dvec3& rate)
{
    Faces faces;
    for (int axis = 0; axis < 3; ++axis) {
        const double r = rate[axis];
        const double face = r > 0.0 ? std::floor(begin[axis]) + 1.0 : std::ceil(begin[axis]) - 1.0;
        faces.next[axis] = r != 0.0 ? (face - begin[axis]) / r : INFINITY;
        faces.distance[axis] = r != 0.0 ? 1.0 / std::abs(r) : INFINITY;
    }
    return faces;
}

} // namespace

glm::dvec4 lightOfPiece(const glm::dvec4& first, const glm::dvec4& second, double lengthUnits)
{
    constexpr double LN2 = 0.6931471805599453;
    const double e0 = first.a * lengthUnits * LN2, e1 = second.a * lengthUnits * LN2;
    const double all = 0.5 * (e0 + e1);
    // What is absorbed up to either point.
    constexpr double WIDTH = 1.0 - 2.0 * GAUSS, BEND = 0.5 * GAUSS * GAUSS / WIDTH;
    const double d0 = std::max(GAUSS * e0 - BEND * (e1 - e0), 0.0);
    const double d1 = all - std::max(GAUSS * e1 - BEND * (e0 - e1), 0.0);
    const double opacity = -std::expm1(-all);
    const double mean = -0.5 * (std::expm1(-d0) + std::expm1(-d1));
    // By parts: of a colour that goes from c0 to c1, c1 times all less what of it came too late.
    const glm::dvec3 change = glm::dvec3(second - first) / WIDTH;
    const glm::dvec3 end = glm::dvec3(second) + GAUSS * change;
    return glm::dvec4(glm::max(end * opacity - change * mean, 0.0), opacity);
}

CellRay::CellRay(const FractionField& field, const glm::dvec3& beginVoxel,
                 const glm::dvec3& endVoxel, double lengthUnits, bool nearest)
    : _nearest(nearest)
{
    const double length = glm::length(endVoxel - beginVoxel);
    _unitsPerVoxel = lengthUnits / length;
    const glm::dvec3 rate = (endVoxel - beginVoxel) / length;
    Faces faces = facesOn(nearest ? beginVoxel + 0.5 : beginVoxel, rate);
    const auto value = [&](double t) { return float(field(beginVoxel + t * rate)); };
    constexpr double LEAST = 1e-9; // of a cell's length
    double begin = 0.0;
    float before = nearest ? 0.0f : value(0.0);
    while (begin < length) {
        const double end =
            std::min({faces.next.x, faces.next.y, faces.next.z, length - LEAST}) + LEAST;
        for (int axis = 0; axis < 3; ++axis)
            if (faces.next[axis] < end) faces.next[axis] += faces.distance[axis];
        if (nearest) {
            _values.emplace_back(value(0.5 * (begin + end)));
        } else {
            const double third = (end - begin) / 3.0;
            const float after = value(end);
            _values.emplace_back(before, value(begin + third), value(end - third), after);
            before = after;
        }
        _ends.push_back(end);
        begin = end;
    }
}

template <class Visit>
void CellRay::visitPieces(const IntervalTable& table, double longestVoxel, const Visit& visit) const
{
    int interval = -1;
    double begin = 0.0;
    for (std::size_t i = 0; i < _ends.size(); ++i) {
        const double length = _ends[i] - begin, longest = longestVoxel / length;
        begin = _ends[i];
        const glm::dvec4 values(_values[i]);
        if (std::isnan(values.x + values.y + values.z + values.w)) {
            interval = -1;
            continue;
        }
        if (interval < 0 || _nearest) interval = table.find(values.x);
        const Cubic cubic(values);
        const glm::dvec2 turns = cubic.turns();
        double s = 0.0;
        for (const double end : {turns.x, turns.y, 1.0}) {
            const double last = cubic.at(end);
            const bool rises = last > cubic.at(s);
            while (s < end) {
                double to = end;
                const double corner = rises ? table.of(interval).y : table.of(interval).x;
                const bool passes = rises ? last > corner : last < corner;
                if (passes) {
                    const double here = cubic.at(s);
                    to = (rises ? here < corner : here > corner) ? cubic.find(corner, s, end) : s;
                }
                const double thick = table.largestExtinction(interval) * length * _unitsPerVoxel;
                const double most =
                    std::min(longest, std::max(MOST_BITS / std::max(thick, 1e-300), LEAST_PART));
                const bool isLong = to - s > most;
                if (isLong) to = s + most;
                if (to > s && !visit(cubic, s, to, length, interval)) return;
                s = to;
                if (passes && !isLong) interval += rises ? 1 : -1;
            }
        }
    }
}

glm::dvec4 CellRay::integrate(const IntervalTable& table, double longestVoxel,
                              double opaqueEnough) const
{
    glm::dvec4 light(0.0);
    visitPieces(table, longestVoxel,
                [&](const Cubic& cubic, double from, double to, double length, int interval) {
                    const double part = to - from;
                    const glm::dvec4 a = table.at(interval, cubic.at(from + GAUSS * part));
                    const glm::dvec4 b = table.at(interval, cubic.at(to - GAUSS * part));
                    light += (1.0 - light.a) * lightOfPiece(a, b, part * length * _unitsPerVoxel);
                    return 1.0 - light.a > opaqueEnough;
                });
    return light;
}

std::size_t CellRay::pieceCount(const IntervalTable& table, double longestVoxel) const
{
    std::size_t count = 0;
    visitPieces(table, longestVoxel, [&](const Cubic&, double, double, double, int) {
        ++count;
        return true;
    });
    return count;
}

glm::dvec4 CellRay::integrate(const ExtinctionTable& table, double periodVoxel,
                              double opaqueEnough) const
{
    const int steps = std::max(1, static_cast<int>(lengthVoxel() / periodVoxel + 0.5));
    const double h = lengthVoxel() / steps;
    std::size_t cell = 0;
    double cellBegin = 0.0;
    const auto at = [&](double t) {
        while (cell + 1 < _ends.size() && t > _ends[cell])
            cellBegin = _ends[cell++];
        return Cubic(glm::dvec4(_values[cell])).at((t - cellBegin) / (_ends[cell] - cellBegin));
    };
    glm::dvec3 color(0.0);
    double through = 1.0, before = at(0.0);
    for (int i = 0; i < steps && through > opaqueEnough; ++i) {
        const double after = table.integrals ? at((i + 1) * h) : 0.0;
        const glm::dvec4 c =
            table.integrals ? table.mean(before, after) : table.at(at((i + 0.5) * h));
        const double next = through * std::exp2(-c.a * h * _unitsPerVoxel);
        color += (through - next) * glm::dvec3(c);
        through = next;
        before = after;
    }
    return glm::dvec4(color, 1.0 - through);
}

} // namespace core
} // namespace osgVolumizer
