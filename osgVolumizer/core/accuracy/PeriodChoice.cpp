#include "PeriodChoice.h"

#include "FilterError.h"
#include "RandomRays.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

// More rays are added where they disagree about the error by more than this: standard deviation of
// the mean square, relative.
constexpr double DOUBT = 0.15;
// What is taken for the truth has so many samples a voxel; that is enough for periods down to
// COARSE_TRUTH voxels, and four times as many for all.
constexpr double SAMPLES_PER_VOXEL = 8.0, COARSE_TRUTH = 0.5;
constexpr double LONGEST = 16.0, SHORTEST = 0.0625; // periods, voxels
// Errors of few rays, and of steps that count along the view axis and not along the ray, are off by
// this.
constexpr double SAFETY = 1.35;
// The part of a tolerance that filtering may take. Squares of errors add, so that it is within what
// SAFETY leaves.
constexpr double FILTER_SHARE = 0.25;
// What a step with integrals costs, in steps without.
constexpr double INTEGRAL_COST = 1.25;

// Mean of the rays' squared errors, and its standard deviation.
struct MeanSquare
{
    double mean = 0.0, deviation = 0.0;
};

MeanSquare errorOf(const RandomRays& set, const ExtinctionTable& table, double periodVoxel)
{
    const std::vector<RandomRays::Ray>& rays = set.rays();
    const double periodIntervals = periodVoxel * set.samplesPerVoxel();
    double sum = 0.0, squares = 0.0;
    for (const RandomRays::Ray& ray : rays) {
        const glm::dvec4 d = ray.samples.integrate(table, periodIntervals) - ray.light;
        const double square = 0.25 * glm::dot(d, d);
        sum += square;
        squares += square * square;
    }
    if (rays.empty()) return {};
    const double count = static_cast<double>(rays.size()), mean = sum / count;
    return {mean, std::sqrt(std::max(squares / count - mean * mean, 0.0) / count)};
}

// Root mean square error, at the upper end of what so few rays leave uncertain: where a few rays
// have all the error, as with jumps in the table, that is much more than what they happen to show.
double upperError(RandomRays& rays, const ExtinctionTable& table, double periodVoxel,
                  double tolerance)
{
    MeanSquare e = errorOf(rays, table, periodVoxel);
    const auto matters = [&]() {
        const double error = SAFETY * std::sqrt(e.mean);
        return e.deviation > DOUBT * e.mean && error < 2.0 * tolerance;
    };
    while (matters() && rays.doubleRays())
        e = errorOf(rays, table, periodVoxel);
    return SAFETY * std::sqrt(e.mean + 2.0 * e.deviation);
}

// The longest period of a sequence, and then of what lies between, whose error is within the
// tolerance.
PeriodChoice longestPeriod(RandomRays& rays, const ExtinctionTable& table, double tolerance,
                           const glm::dvec2& periods)
{
    constexpr double RATIO = 0.7937005259840998; // 2^(-1/3)
    PeriodChoice choice;
    choice.integrals = table.integrals;
    double longerError = 0.0;
    for (double period = periods.x; period > 0.999 * periods.y; period *= RATIO) {
        const double error = upperError(rays, table, period, tolerance);
        choice.periodVoxel = period;
        choice.error = error;
        if (error <= tolerance) {
            // Between this one and the longer one the error is taken for a power of the period.
            if (longerError > tolerance && error > 0.0)
                choice.periodVoxel *= std::pow(1.0 / RATIO, std::log(tolerance / error) /
                                                                std::log(longerError / error));
            return choice;
        }
        longerError = error;
    }
    return choice;
}

// Period, the longest and the shortest given, and kind of table.
PeriodChoice cheapest(RandomRays& rays, const PeriodQuestion& q, const glm::dvec2& periods)
{
    if (q.integrals.empty()) return longestPeriod(rays, q.midpoints, q.tolerance, periods);
    const PeriodChoice runs = longestPeriod(rays, q.integrals, q.tolerance, periods);
    if (q.midpoints.empty()) return runs;
    const PeriodChoice points = longestPeriod(rays, q.midpoints, q.tolerance, periods);
    if (points.error > q.tolerance || runs.error > q.tolerance)
        return runs.error < points.error ? runs : points;
    return runs.periodVoxel > INTEGRAL_COST * points.periodVoxel ? runs : points;
}

PeriodChoice choose(const FractionField& field, const PeriodQuestion& question)
{
    RandomRays coarse(field, question, SAMPLES_PER_VOXEL);
    const PeriodChoice choice = cheapest(coarse, question, {LONGEST, COARSE_TRUTH});
    if (choice.error <= question.tolerance) return choice;
    RandomRays fine(field, question, 4.0 * SAMPLES_PER_VOXEL);
    return cheapest(fine, question, {COARSE_TRUTH, SHORTEST});
}

} // namespace

PeriodChoice choosePeriod(const FractionField& field, const PeriodQuestion& question)
{
    if (question.box.empty()) return {};
    PeriodChoice choice = choose(field, question);
    choice.filterError = core::filterError(field, question, PeriodChoice::FILTER_WEIGHT);
    return choice;
}

bool PeriodChoice::permits(double filterWeight, double tolerance) const
{
    return filterError * filterWeight <= FILTER_SHARE * tolerance * FILTER_WEIGHT;
}

} // namespace core
} // namespace osgVolumizer
