#pragma once

#include <osgVolumizer/core/accuracy/PeriodChoice.h>
#include <osgVolumizer/core/transfer/PreIntegration.h>
#include <osgVolumizer/core/transfer/TransferFunction.h>

#include <cmath>
#include <functional>
#include <vector>

namespace osgVolumizer {
namespace core {

/// A transfer function of fractions in every form that rays are integrated with.
struct TableForms
{
    static constexpr int ENTRIES = 16384;
    TransferFunction function;
    std::vector<glm::vec4> midpoints, integrals;
    IntervalTable table, exact;

    explicit TableForms(const std::vector<TransferFunction::Point>& points)
        : function(*TransferFunction::create(points)),
          midpoints(function.tabulateExtinction(ENTRIES, 0.0, 1.0, false)),
          table(makeIntervalTable(function, 0.03)), exact(makeIntervalTable(function, 0.0))
    {
        const double bits = 1.0 / std::log(2.0), half = 0.5 / (ENTRIES - 1.0);
        for (glm::vec4& t : midpoints)
            t.a *= static_cast<float>(bits);
        integrals = midpoints;
        const TransferIntegral integral(function);
        for (const glm::dvec4& sum : integral.tabulate(ENTRIES + 1, -half, 1.0 + half))
            integrals.emplace_back(sum * bits);
    }
    TableForms(const TableForms&) = delete;
    TableForms& operator=(const TableForms&) = delete;

    PeriodQuestion question(double tolerance) const
    {
        PeriodQuestion q;
        q.tolerance = tolerance;
        q.opaqueEnough = 0.02 * tolerance;
        q.midpoints = {midpoints.data(), ENTRIES, false};
        q.integrals = {integrals.data(), ENTRIES, true};
        q.table = &table;
        q.exact = &exact;
        return q;
    }
};

/// Points at equal distances whose opacity is a function of the fraction, of one colour.
inline std::vector<TransferFunction::Point>
opacityPoints(int count, const std::function<double(double)>& opacity)
{
    std::vector<TransferFunction::Point> points;
    for (int i = 0; i < count; ++i) {
        const double v = i / (count - 1.0);
        points.push_back({v, {1.0, 0.5, 0.25, opacity(v)}});
    }
    return points;
}

} // namespace core
} // namespace osgVolumizer
