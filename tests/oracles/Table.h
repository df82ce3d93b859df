#pragma once

#include <osgVolumizer/core/transfer/TransferFunction.h>

#include <glm/vec2.hpp>

#include <vector>

namespace osgVolumizer {
namespace oracle {

/// A transfer function by its points, evaluated without the library's code: linear between points,
/// constant beyond the ends; of two points at one value the later holds from there on.
class Table
{
public:
    using Point = core::TransferFunction::Point;

    /// Transparent.
    Table() : Table({{0.0, glm::dvec4(0.0)}}) {}
    /// Points at values that ascend, over the fraction of `range` (data values); (0, 1) leaves them
    /// alone.
    explicit Table(std::vector<Point> points, const glm::dvec2& range = glm::dvec2(0.0, 1.0));
    explicit Table(const core::TransferFunction& f, const glm::dvec2& range = glm::dvec2(0.0, 1.0))
        : Table(f.points(), range)
    {
    }
    /// The same colour everywhere.
    static Table constant(const glm::dvec4& color) { return Table({{0.0, color}}); }

    glm::dvec4 color(double value) const;
    /// -ln(1 - alpha), alpha no more than 1 - 2^-24.
    static double extinction(double alpha);
    /// Where the function has a kink or a jump, ascending.
    const std::vector<double>& knots() const { return _knots; }

private:
    std::vector<Point> _points;
    std::vector<double> _knots;
};

} // namespace oracle
} // namespace osgVolumizer
