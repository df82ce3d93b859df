#include "CellRay.h"

#include "AdaptiveStep.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

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

void count(const RayIntegration& options, double atVoxel)
{
    if (options.tried && atVoxel >= options.betweenVoxel.x && atVoxel <= options.betweenVoxel.y)
        ++*options.tried;
}

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

glm::dvec3 RayShading::shade(const glm::dvec3& color, const glm::dvec3& gradient,
                             const glm::dvec3& toLight, const glm::dvec3& toEye) const
{
    const glm::dvec3 n = gradient / std::sqrt(glm::dot(gradient, gradient) + 1e-8);
    const glm::dvec3 between = toLight + toEye;
    const glm::dvec3 h = between / std::sqrt(std::max(glm::dot(between, between), 1e-30));
    const double highlight = std::pow(std::max(std::abs(glm::dot(n, h)), 1e-30), shininess);
    return color * (ambient + diffuse * std::abs(glm::dot(n, toLight))) + specular * highlight;
}

CellRay::CellRay(const RayPath& path, const FractionField& field, const GradientField& gradient,
                 bool nearest)
    : _toLight(path.toLight), _nearest(nearest)
{
    const glm::dvec3 all = path.endVoxel - path.beginVoxel, allUnits = path.voxelToUnits * all;
    const double length = glm::length(all);
    _unitsPerVoxel = glm::length(allUnits) / length;
    _toEye = -glm::normalize(allUnits);
    const glm::dvec3 rate = all / length;
    const glm::dmat3 toUnits = glm::inverse(glm::transpose(path.voxelToUnits));
    Faces faces = facesOn(nearest ? path.beginVoxel + 0.5 : path.beginVoxel, rate);
    const auto value = [&](double t) { return float(field(path.beginVoxel + t * rate)); };
    const auto slope = [&](double t) {
        return glm::vec3(toUnits * gradient(path.beginVoxel + t * rate));
    };
    constexpr double LEAST = 1e-9; // of a cell's length
    double begin = 0.0;
    float before = nearest ? 0.0f : value(0.0);
    glm::vec3 slopeBefore(0.0f);
    if (gradient && !nearest) slopeBefore = slope(0.0);
    while (begin < length) {
        const double end =
            std::min({faces.next.x, faces.next.y, faces.next.z, length - LEAST}) + LEAST;
        for (int axis = 0; axis < 3; ++axis)
            if (faces.next[axis] < end) faces.next[axis] += faces.distance[axis];
        const double third = (end - begin) / 3.0, middle = 0.5 * (begin + end);
        if (nearest) {
            _values.emplace_back(value(middle));
        } else {
            const float after = value(end);
            _values.emplace_back(before, value(begin + third), value(end - third), after);
            before = after;
        }
        if (gradient) {
            const glm::vec3 d = slope(nearest ? middle : end);
            const glm::vec3 a = nearest ? d : slopeBefore, b = nearest ? d : slope(begin + third),
                            c = nearest ? d : slope(end - third);
            _gradients.push_back(
                {{a.x, b.x, c.x, d.x}, {a.y, b.y, c.y, d.y}, {a.z, b.z, c.z, d.z}});
            slopeBefore = d;
        }
        _ends.push_back(end);
        begin = end;
    }
}

glm::dvec3 CellRay::gradient(std::size_t cell, double s) const
{
    const Gradients& g = _gradients[cell];
    return {Cubic(glm::dvec4(g.x)).at(s), Cubic(glm::dvec4(g.y)).at(s),
            Cubic(glm::dvec4(g.z)).at(s)};
}

glm::dvec4 CellRay::lit(const glm::dvec4& color, std::size_t cell, double s,
                        const RayIntegration& options) const
{
    if (!options.shading || !(color.a > 0.0)) return color;
    const glm::dvec3 slope = gradient(cell, s);
    return glm::dvec4(options.shading->shade(glm::dvec3(color), slope, _toLight, _toEye), color.a);
}

template <class Visit>
void CellRay::visitPieces(const IntervalTable& table, double longestVoxel, const Visit& visit) const
{
    int interval = -1;
    double begin = 0.0;
    for (std::size_t i = 0; i < _ends.size(); ++i) {
        const double length = _ends[i] - begin, longest = PIECE_SLACK * longestVoxel / length;
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
                if (to > s && !visit(i, cubic, s, to, length, interval)) return;
                s = to;
                if (passes && !isLong) interval += rises ? 1 : -1;
            }
        }
    }
}

glm::dvec2 CellRay::shownPart(const IntervalTable& table) const
{
    glm::dvec2 part(lengthVoxel(), 0.0);
    visitPieces(table, lengthVoxel(),
                [&](std::size_t cell, const Cubic& cubic, double from, double to, double length,
                    int interval) {
                    const double inset = GAUSS * (to - from);
                    if (table.at(interval, cubic.at(from + inset)).a > 0.0 ||
                        table.at(interval, cubic.at(to - inset)).a > 0.0) {
                        part.x = std::min(part.x, cellBegin(cell) + from * length);
                        part.y = cellBegin(cell) + to * length;
                    }
                    return true;
                });
    return part.x <= part.y ? part : glm::dvec2(0.0);
}

glm::dvec4 CellRay::integrate(const IntervalTable& table, double longestVoxel,
                              const RayIntegration& options) const
{
    glm::dvec4 light(0.0);
    visitPieces(table, longestVoxel,
                [&](std::size_t cell, const Cubic& cubic, double from, double to, double length,
                    int interval) {
                    const double part = to - from, s0 = from + GAUSS * part, s1 = to - GAUSS * part;
                    const glm::dvec4 a = table.at(interval, cubic.at(s0));
                    const glm::dvec4 b = table.at(interval, cubic.at(s1));
                    count(options, cellBegin(cell) + 0.5 * (from + to) * length);
                    light += (1.0 - light.a) * lightOfPiece(lit(a, cell, s0, options),
                                                            lit(b, cell, s1, options),
                                                            part * length * _unitsPerVoxel);
                    return 1.0 - light.a > options.opaqueEnough;
                });
    return light;
}

// A place on a ray that moves on, or back a little.
class CellRay::Walk
{
public:
    explicit Walk(const CellRay& ray) : _ray(ray) {}

    double valueAt(double t)
    {
        go(t);
        return Cubic(glm::dvec4(_ray._values[_cell])).at(_s);
    }
    glm::dvec4 lit(const glm::dvec4& color, double t, const RayIntegration& options)
    {
        if (!options.shading) return color;
        go(t);
        return _ray.lit(color, _cell, _s, options);
    }

private:
    void go(double t)
    {
        const std::vector<double>& ends = _ray._ends;
        while (_cell + 1 < ends.size() && t > ends[_cell])
            ++_cell;
        while (_cell > 0 && t <= ends[_cell - 1])
            --_cell;
        const double begin = _ray.cellBegin(_cell);
        _s = (t - begin) / (ends[_cell] - begin);
    }

    const CellRay& _ray;
    std::size_t _cell = 0;
    double _s = 0.0;
};

glm::dvec4 CellRay::integrate(const ExtinctionTable& table, double periodVoxel,
                              const RayIntegration& options) const
{
    const int steps = std::max(1, static_cast<int>(lengthVoxel() / periodVoxel + 0.5));
    const double h = lengthVoxel() / steps;
    Walk walk(*this);
    glm::dvec3 color(0.0);
    double through = 1.0, before = walk.valueAt(0.0);
    for (int i = 0; i < steps && through > options.opaqueEnough; ++i) {
        const double middle = (i + 0.5) * h,
                     after = table.integrals ? walk.valueAt((i + 1) * h) : 0.0;
        const glm::dvec4 c =
            walk.lit(table.integrals ? table.mean(before, after) : table.at(walk.valueAt(middle)),
                     middle, options);
        count(options, middle);
        const double next = through * std::exp2(-c.a * h * _unitsPerVoxel);
        color += (through - next) * glm::dvec3(c);
        through = next;
        before = after;
    }
    return glm::dvec4(color, 1.0 - through);
}

glm::dvec4 CellRay::integrateAdaptively(const ExtinctionTable& table, double periodVoxel,
                                        const RayIntegration& options) const
{
    Walk walk(*this);
    AdaptiveStep step;
    glm::dvec3 color(0.0);
    double through = 1.0, begin = 0.0, before = walk.valueAt(0.0);
    while (begin < lengthVoxel() && through > options.opaqueEnough) {
        const double end = std::min(begin + step.stretch * periodVoxel, lengthVoxel());
        const double after = walk.valueAt(end);
        const glm::dvec4 c = table.mean(before, after);
        const double next = through * std::exp2(-c.a * (end - begin) * _unitsPerVoxel);
        count(options, 0.5 * (begin + end));
        if (!step.suits(through - next, periodVoxel)) continue;
        color += (through - next) * glm::dvec3(walk.lit(c, 0.5 * (begin + end), options));
        through = next;
        before = after;
        begin = end;
    }
    return glm::dvec4(color, 1.0 - through);
}

} // namespace core
} // namespace osgVolumizer
