#include "PeriodChoice.h"

#include "FilterError.h"
#include "RandomRays.h"

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace core {

namespace {

// More rays are wanted where they disagree about the error by more than this: standard deviation of
// the mean square, relative.
constexpr double DOUBT = 0.15;
// Or where fewer than this show something.
constexpr std::size_t FEWEST_SHOWN = 400;
constexpr double LEAP = 4.0;     // what shows nothing is leapt over, but for this, voxels
constexpr double VISIBLE = 1e-3; // opacity of a ray that shows something
constexpr double LONGEST = 8.0;  // period, voxels
// Errors of few rays, in few directions, are off by this.
constexpr double SAFETY = 1.5;
// The part of a tolerance that filtering may take. Squares of errors add, so that it is within what
// SAFETY leaves.
constexpr double FILTER_SHARE = 0.25;
// What a step with integrals costs, in steps without, and one that adapts; and a piece, where the
// table has corners within its range, and where not. What light adds to a sample.
constexpr double INTEGRAL_COST = 1.25, ADAPTIVE_COST = 1.35, CORNER_COST = 6.4, PIECE_COST = 1.9;
constexpr double LIGHT_COST = 3.0;
// A picture has so many rays that differ: what it shows may be off by more than what many show. Of
// errors that few rays have, as those that graze a jump, their number in a picture counts: 2.4 more
// than expected where that is a few, besides twice the deviation, bound 999 of 1000.
constexpr double VIEW = 300.0, FEW_EVENTS = 2.4;
// The rays of one direction tell of it as if so many average ones were among them.
constexpr double FEW = 30.0;
// Floats and the texture units of a card, which take no part in this.
constexpr double LEAST_ERROR = 2e-6;

// The shortest that are tried, voxels.
struct Shortest
{
    double truth;  // longest piece of what is taken for the truth
    double piece;  // longest one that may be chosen
    double period; // of steps
};

// Normals turn faster than values change.
Shortest shortestFor(const PeriodQuestion& q)
{
    if (q.shading)
        return q.tolerance < 3e-4 ? Shortest{1.0 / 64.0, 1.0 / 32.0, 1.0 / 32.0}
                                  : Shortest{1.0 / 32.0, 1.0 / 16.0, 1.0 / 16.0};
    return q.tolerance < 3e-5 ? Shortest{1.0 / 16.0, 1.0 / 8.0, 1.0 / 16.0}
                              : Shortest{1.0 / 8.0, 1.0 / 4.0, 1.0 / 16.0};
}

// A ray that shows something, and what.
struct ShownRay
{
    const CellRay* ray;
    std::size_t direction;
    glm::dvec2 part;  ///< what is not leapt over, voxels
    glm::dvec4 light; ///< premultiplied
};

// Finds errors of rules.
class Judge
{
public:
    Judge(const PeriodQuestion& question, const std::vector<CellRay>& rays, std::size_t count)
        : _question(question)
    {
        const double truth = shortestFor(question).truth;
        for (std::size_t i = 0; i < std::min(count, rays.size()); ++i) {
            const double rough = rays[i].integrate(*question.table, LONGEST, {VISIBLE}).a;
            if (!(rough > VISIBLE)) continue;
            const glm::dvec2 part = rays[i].shownPart(*question.table);
            _rays.push_back({&rays[i], i % RandomRays::DIRECTIONS, part + glm::dvec2(-LEAP, LEAP),
                             rays[i].integrate(*question.exact, truth, {0.0, question.shading})});
        }
        _doubts = _rays.size() < FEWEST_SHOWN;
    }

    bool isEmpty() const { return _rays.empty(); }
    // Whether errors that decided were uncertain.
    bool doubts() const { return _doubts; }

    // Root mean square error of a view, at the upper end of what so few rays leave uncertain: where
    // a few rays have all the error, as with jumps in the table, that is much more than what they
    // happen to show.
    double error(RayRule rule, double periodVoxel)
    {
        double sum = 0.0, squares = 0.0;
        std::array<double, RandomRays::DIRECTIONS> sums{}, counts{};
        _samples = 0;
        for (const ShownRay& shown : _rays) {
            const glm::dvec4 d = integrate(shown, rule, periodVoxel) - shown.light;
            const double square = 0.25 * glm::dot(d, d);
            sum += square;
            squares += square * square;
            sums[shown.direction] += square;
            counts[shown.direction] += 1.0;
        }
        if (_rays.empty()) return 0.0;
        const auto count = static_cast<double>(_rays.size());
        const double mean = sum / count;
        const double ofRay = std::sqrt(std::max(squares / count - mean * mean, 0.0));
        const double deviation = ofRay / std::sqrt(count);
        const double perRay = 1.0 / count + 1.0 / VIEW;
        double worst = mean + 2.0 * ofRay * std::sqrt(perRay);
        if (mean > 0.0) worst += FEW_EVENTS * ofRay * ofRay / mean * perRay;
        for (std::size_t i = 0; i < sums.size(); ++i)
            worst = std::max(worst, (sums[i] + FEW * mean) / (counts[i] + FEW));
        const double upper = SAFETY * std::sqrt(worst) + LEAST_ERROR;
        if (deviation > DOUBT * mean && upper > _question.tolerance &&
            SAFETY * std::sqrt(mean) < _question.tolerance)
            _doubts = true;
        return upper;
    }

    // Of the last error(): what its steps or pieces cost, in samples a ray.
    double cost(RayRule rule) const
    {
        const double light = _question.shading ? LIGHT_COST : 0.0;
        return costOf(rule, light) * static_cast<double>(_samples) /
               static_cast<double>(std::max<std::size_t>(_rays.size(), 1));
    }

private:
    double costOf(RayRule rule, double light) const
    {
        const bool corners = _question.table->intervals > 3;
        switch (rule) {
        case RayRule::MIDPOINTS:
            return 1.0 + light;
        case RayRule::INTEGRALS:
            return INTEGRAL_COST + light;
        case RayRule::ADAPTIVE:
            return ADAPTIVE_COST + light;
        case RayRule::CELLS:
            break;
        }
        return (corners ? CORNER_COST : PIECE_COST) + 2.0 * light;
    }

    glm::dvec4 integrate(const ShownRay& shown, RayRule rule, double periodVoxel)
    {
        const CellRay& ray = *shown.ray;
        const RayIntegration options{_question.opaqueEnough, _question.shading, &_samples,
                                     shown.part};
        switch (rule) {
        case RayRule::MIDPOINTS:
            return ray.integrate(_question.midpoints, periodVoxel, options);
        case RayRule::INTEGRALS:
            return ray.integrate(_question.integrals, periodVoxel, options);
        case RayRule::ADAPTIVE:
            return ray.integrateAdaptively(_question.integrals, periodVoxel, options);
        case RayRule::CELLS:
            break;
        }
        return ray.integrate(*_question.table, periodVoxel, options);
    }

    const PeriodQuestion& _question;
    std::vector<ShownRay> _rays;
    std::size_t _samples = 0;
    bool _doubts = false;
};

// A choice and what it costs, in samples a ray.
struct Candidate
{
    PeriodChoice choice;
    double cost = std::numeric_limits<double>::infinity();
    bool keeps = false;
};

Candidate cellsFor(const PeriodQuestion& q, Judge& judge)
{
    Candidate candidate;
    candidate.choice.rule = RayRule::CELLS;
    const double finest = shortestFor(q).piece;
    for (double longest = PeriodChoice::ONE_PIECE; longest > 0.9 * finest; longest *= 0.5) {
        candidate.choice.periodVoxel = longest;
        candidate.choice.error = judge.error(RayRule::CELLS, longest);
        candidate.cost = judge.cost(RayRule::CELLS);
        candidate.keeps = candidate.choice.error <= q.tolerance;
        if (candidate.keeps) break;
    }
    return candidate;
}

// The longest period of a sequence, and then of what lies between, whose error is within the
// tolerance; none shorter than what would cost more than is known to do.
Candidate stepsFor(const PeriodQuestion& q, Judge& judge, RayRule rule, double mostCost)
{
    constexpr double RATIO = 0.7937005259840998; // 2^(-1/3)
    constexpr double FASTEST = 0.5;              // RATIO to the power of 3
    Candidate candidate;
    candidate.choice.rule = rule;
    candidate.choice.error = std::numeric_limits<double>::infinity();
    double longerError = 0.0;
    const double shortest = shortestFor(q).period;
    for (double period = LONGEST; period > 0.999 * shortest; period *= RATIO) {
        // Errors that fall faster than by third order do so since the few rays that had them happen
        // to have none.
        const double error = std::max(judge.error(rule, period), longerError * FASTEST);
        candidate.choice.periodVoxel = period;
        candidate.choice.error = error;
        candidate.cost = judge.cost(rule);
        candidate.keeps = error <= q.tolerance;
        if (candidate.keeps) {
            // Between this one and the longer one the error is taken for a power of the period.
            double longer = 1.0;
            if (longerError > q.tolerance && error > 0.0)
                longer = std::pow(1.0 / RATIO,
                                  std::log(q.tolerance / error) / std::log(longerError / error));
            candidate.choice.periodVoxel *= longer;
            if (longer > 1.0) candidate.choice.error = q.tolerance;
            candidate.cost /= longer;
            break;
        }
        if (candidate.cost > mostCost) break;
        longerError = error;
    }
    return candidate;
}

bool isBetter(const Candidate& a, const Candidate& b)
{
    if (a.keeps != b.keeps) return a.keeps;
    return a.keeps ? a.cost < b.cost : a.choice.error < b.choice.error;
}

} // namespace

PeriodAnswer choosePeriod(const PeriodQuestion& question, const std::vector<CellRay>& rays,
                          std::size_t count)
{
    Judge judge(question, rays, count);
    if (judge.isEmpty()) {
        PeriodAnswer nothing;
        nothing.choice.periodVoxel = LONGEST;
        nothing.choice.rule = question.midpoints.empty() ? RayRule::INTEGRALS : RayRule::MIDPOINTS;
        if (question.midpoints.empty() && question.integrals.empty())
            nothing.choice = {RayRule::CELLS, PeriodChoice::ONE_PIECE};
        nothing.wantsMore = judge.doubts();
        return nothing;
    }
    Candidate best;
    best.choice.error = std::numeric_limits<double>::infinity();
    if (question.cells) best = cellsFor(question, judge);
    const auto consider = [&](RayRule rule, const ExtinctionTable& table) {
        if (table.empty()) return;
        const double mostCost = best.keeps ? best.cost : std::numeric_limits<double>::infinity();
        const Candidate steps = stepsFor(question, judge, rule, mostCost);
        if (isBetter(steps, best)) best = steps;
    };
    consider(RayRule::MIDPOINTS, question.midpoints);
    consider(RayRule::ADAPTIVE, question.integrals);
    consider(RayRule::INTEGRALS, question.integrals);
    return {best.choice, judge.doubts()};
}

PeriodChoice choosePeriod(const PeriodQuestion& question, const FractionField& field,
                          const Box3d& box, const glm::dmat3& voxelToUnits, bool nearest)
{
    if (box.empty()) return choosePeriod(question, {}, 0).choice;
    RandomRays random(box, voxelToUnits, nearest, question.shading != nullptr);
    std::vector<CellRay> rays;
    std::size_t cells = 0;
    PeriodAnswer answer;
    for (std::size_t count = FIRST_RAYS; count <= MOST_RAYS; count *= 2) {
        while (rays.size() < count && cells < MOST_RAY_CELLS) {
            rays.push_back(random.next(field));
            cells += rays.back().cellCount();
        }
        answer = choosePeriod(question, rays, count);
        if (!answer.wantsMore || cells >= MOST_RAY_CELLS) break;
    }
    answer.choice.filterError =
        core::filterError(field, box, voxelToUnits, *question.table, PeriodChoice::FILTER_WEIGHT);
    return answer.choice;
}

bool PeriodChoice::permits(double filterWeight, double tolerance) const
{
    return filterError * filterWeight <= FILTER_SHARE * tolerance * FILTER_WEIGHT;
}

} // namespace core
} // namespace osgVolumizer
