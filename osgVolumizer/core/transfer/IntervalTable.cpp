#include "IntervalTable.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

constexpr double BITS = 1.0 / 0.6931471805599453; // in units of -ln(transmittance)
constexpr double ENTRY_ERROR = 1e-6;              // of interpolation between entries
constexpr int MOST_ENTRIES = 4097;                // of an interval
constexpr double LEAST_THROUGH = 1e-3;            // what is almost opaque is all one
// Of what is let through, at one end of an interval to that at the other: extinction, which is its
// logarithm, is then near a polynomial of third degree, which Gauss's rule of two points
// integrates.
constexpr double MOST_CHANGE = 1.4;

using Points = std::vector<TransferFunction::Point>;

glm::dvec4 weighted(const glm::dvec4& c)
{
    return {glm::dvec3(c) * c.a, c.a};
}

double largest(const glm::dvec4& v)
{
    const glm::dvec4 a = glm::abs(v);
    return std::max({a.x, a.y, a.z, a.w});
}

// Of what is emitted and absorbed, per value, from one point to the next.
glm::dvec4 slope(const TransferFunction::Point& a, const TransferFunction::Point& b)
{
    return (weighted(b.color) - weighted(a.color)) / (b.value - a.value);
}

// Points first to last are at one value. Both ends of the table are corners.
bool isCorner(const Points& points, std::size_t first, std::size_t last, double sharpness)
{
    if (first == 0 || last + 1 == points.size()) return true;
    if (last > first) return largest(points[last].color - points[first].color) > 0.0;
    const glm::dvec4 before = slope(points[first - 1], points[first]);
    const glm::dvec4 after = slope(points[last], points[last + 1]);
    const double kink =
        largest(after - before) / std::max(1.0 - points[first].color.a, LEAST_THROUGH);
    return kink > 0.0 && kink >= sharpness;
}

// The function between two of its points, and what it is there from within.
struct Interval
{
    std::size_t first, last; // points
    double low, high;
};

glm::dvec4 entryOf(const Points& points, const Interval& interval, double value)
{
    const auto begin = points.begin() + std::ptrdiff_t(interval.first),
               end = points.begin() + std::ptrdiff_t(interval.last);
    std::size_t i = interval.first;
    if (begin < end) {
        const auto next = std::upper_bound(
            begin + 1, end, value,
            [](double v, const TransferFunction::Point& point) { return v < point.value; });
        i += std::size_t(next - begin) - 1;
    }
    glm::dvec4 c = points[i].color;
    if (i < interval.last) {
        const double width = points[i + 1].value - points[i].value;
        const double f = width > 0.0 ? (value - points[i].value) / width : 0.0;
        c = glm::mix(c, points[i + 1].color, std::clamp(f, 0.0, 1.0));
    }
    return {glm::dvec3(c), extinctionFromOpacity(c.a) * BITS};
}

std::vector<glm::dvec4> entries(const Points& points, const Interval& interval, int count)
{
    std::vector<glm::dvec4> result;
    for (int i = 0; i < count; ++i)
        result.push_back(
            entryOf(points, interval, glm::mix(interval.low, interval.high, i / (count - 1.0))));
    return result;
}

// Relative to the largest extinction where that is less than a bit, as opacity units may be any.
double errorOf(const std::vector<glm::dvec4>& few, const std::vector<glm::dvec4>& twiceAsMany)
{
    double thickest = 1e-30, error = 0.0;
    for (const glm::dvec4& entry : twiceAsMany)
        thickest = std::max(thickest, std::min(entry.a, 1.0));
    for (std::size_t i = 0; i + 1 < few.size(); ++i) {
        const glm::dvec4 truth = twiceAsMany[2 * i + 1];
        const glm::dvec4 off = glm::abs(0.5 * (few[i] + few[i + 1]) - truth);
        error = std::max({error, off.r, off.g, off.b, off.a / std::max(thickest, truth.a)});
    }
    return error;
}

// Doubles entries until that makes no difference.
std::vector<glm::dvec4> enoughEntries(const Points& points, const Interval& interval)
{
    if (interval.first == interval.last) return {entryOf(points, interval, interval.low)};
    const bool bends = interval.last - interval.first > 1;
    int count = bends ? 65 : 2;
    std::vector<glm::dvec4> few = entries(points, interval, count);
    while (count < MOST_ENTRIES) {
        count = 2 * count - 1;
        std::vector<glm::dvec4> more = entries(points, interval, count);
        const bool enough = errorOf(few, more) < ENTRY_ERROR;
        few.swap(more);
        if (enough) return count > 3 ? few : more;
    }
    return few;
}

// Adds an interval, cut where what is let through passes a power of MOST_CHANGE.
void addInterval(const Points& points, const Interval& whole, std::vector<Interval>& intervals)
{
    const auto levelOf = [](const glm::dvec4& c) {
        return -std::log(std::max(1.0 - c.a, LEAST_THROUGH)) / std::log(MOST_CHANGE);
    };
    double low = whole.low;
    for (std::size_t i = whole.first; i < whole.last; ++i) {
        const TransferFunction::Point &a = points[i], &b = points[i + 1];
        const double from = levelOf(a.color), to = levelOf(b.color);
        const double step = to > from ? 1.0 : -1.0;
        for (double level = to > from ? std::floor(from) + 1.0 : std::ceil(from) - 1.0;
             (to - level) * step > 0.0; level += step) {
            const double alpha = 1.0 - std::pow(MOST_CHANGE, -level);
            const double f = (alpha - a.color.a) / (b.color.a - a.color.a);
            const double value = glm::mix(a.value, b.value, f);
            if (!(value > low && value < whole.high)) continue;
            intervals.push_back({whole.first, whole.last, low, value});
            low = value;
        }
    }
    intervals.push_back({whole.first, whole.last, low, whole.high});
}

// The first and the last are constant.
std::vector<Interval> cutAtCorners(const Points& points, double sharpness)
{
    std::vector<Interval> intervals;
    std::size_t begin = 0;
    double low = -double(IntervalTable::FAR_AWAY);
    for (std::size_t first = 0, last = 0; first < points.size(); first = last + 1) {
        last = first;
        while (last + 1 < points.size() && points[last + 1].value == points[first].value)
            ++last;
        if (!isCorner(points, first, last, sharpness)) continue;
        addInterval(points, {begin, first, low, points[first].value}, intervals);
        begin = last;
        low = points[first].value;
    }
    intervals.push_back({begin, begin, low, double(IntervalTable::FAR_AWAY)});
    return intervals;
}

} // namespace

int IntervalTable::find(double value) const
{
    int low = 0, high = intervals - 1;
    while (low < high) {
        const int middle = (low + high + 1) / 2;
        if (value < double(of(middle).x))
            high = middle - 1;
        else
            low = middle;
    }
    return low;
}

glm::dvec4 IntervalTable::at(int interval, double value) const
{
    const glm::dvec4 in(of(interval));
    const double entry = in.z + std::max(std::clamp(value, in.x, in.y) - in.x, 0.0) * in.w;
    const auto i = std::min(static_cast<std::size_t>(entry), texels.size() - 2);
    return glm::mix(glm::dvec4(texels[i]), glm::dvec4(texels[i + 1]), entry - double(i));
}

IntervalTable makeIntervalTable(const TransferFunction& function, double sharpness)
{
    const Points& points = function.points();
    const std::vector<Interval> intervals = cutAtCorners(points, sharpness);
    IntervalTable table;
    table.intervals = static_cast<int>(intervals.size());
    table.texels.resize(2 * intervals.size());
    for (std::size_t k = 0; k < intervals.size(); ++k) {
        const Interval& interval = intervals[k];
        const std::vector<glm::dvec4> colors = enoughEntries(points, interval);
        const double width = interval.high - interval.low;
        table.texels[2 * k] = glm::vec4(interval.low, interval.high, double(table.texels.size()),
                                        (double(colors.size()) - 1.0) / width);
        for (const glm::dvec4& color : colors)
            table.texels[2 * k + 1].x = std::max(table.texels[2 * k + 1].x, float(color.a));
        table.texels.insert(table.texels.end(), colors.begin(), colors.end());
    }
    table.texels.push_back(table.texels.back());
    return table;
}

} // namespace core
} // namespace osgVolumizer
