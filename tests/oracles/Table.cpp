#include "Table.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace oracle {

Table::Table(std::vector<Point> points, const glm::dvec2& range) : _points(std::move(points))
{
    for (Point& p : _points) {
        p.value = range.x + p.value * (range.y - range.x);
        if (_points.size() > 1) _knots.push_back(p.value);
    }
}

glm::dvec4 Table::color(double value) const
{
    const auto after = std::upper_bound(_points.begin(), _points.end(), value,
                                        [](double v, const Point& p) { return v < p.value; });
    if (after == _points.begin()) return _points.front().color;
    if (after == _points.end()) return _points.back().color;
    const Point& a = *(after - 1);
    const double f = (value - a.value) / (after->value - a.value);
    return a.color + f * (after->color - a.color);
}

double Table::extinction(double alpha)
{
    return -std::log1p(-std::min(alpha, 1.0 - 0x1p-24));
}

} // namespace oracle
} // namespace osgVolumizer
