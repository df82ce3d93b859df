// From frames in whatever order to evenly spaced slices.

#include "DicomSeries.h"

#include <osgVolumizer/core/Text.h>

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace osgVolumizer {
namespace medical {

namespace {

constexpr double EVEN = 0.02;       // of the spacing: what positions are rounded by
constexpr double MOST_FILLED = 4.0; // slices for each that there is
constexpr double MOST_FILLED_LABELS = 1000.0;

using Place = std::vector<DicomFrame>; // the frames of one place, one for each time step

std::string millimetres(double v)
{
    return core::formatNumber(std::round(v * 1000.0) / 1000.0) + " mm";
}

double along(const DicomFrame& frame, const glm::dvec3& normal)
{
    return glm::dot(frame.position, normal);
}

// Of one place, the first in time first.
bool isEarlier(const DicomFrame& a, const DicomFrame& b)
{
    return std::tie(a.order, a.file, a.frame) < std::tie(b.order, b.file, b.frame);
}

std::vector<Place> placesOf(const std::vector<DicomFrame>& frames)
{
    std::vector<Place> places = placesAlong(frames);
    for (Place& place : places)
        std::stable_sort(place.begin(), place.end(), isEarlier);
    return places;
}

// Frames that say nothing of a place follow each other by instance and frame.
std::vector<Place> unplaced(std::vector<DicomFrame> frames, bool framesAreTime)
{
    std::stable_sort(frames.begin(), frames.end(), [](const DicomFrame& a, const DicomFrame& b) {
        return std::tie(a.order[5], a.file, a.frame) < std::tie(b.order[5], b.file, b.frame);
    });
    if (framesAreTime) return {frames};
    std::vector<Place> places;
    for (const DicomFrame& frame : frames)
        places.push_back({frame});
    return places;
}

void splitIntoSteps(const std::vector<Place>& places, DicomGrid& grid)
{
    const std::size_t count = places.front().size();
    const bool each = std::all_of(places.begin(), places.end(),
                                  [count](const Place& p) { return p.size() == count; });
    std::size_t all = 0;
    if (!each) grid.steps = wholeSteps(places, all);
    if (!grid.steps.empty()) {
        grid.notices.push_back(std::to_string(all - grid.steps.size()) + " of " +
                               std::to_string(all) +
                               " time steps lack slices that others have, and are left out");
        return;
    }
    grid.steps.resize(each ? count : 1);
    std::size_t left = 0;
    for (const Place& place : places) {
        for (std::size_t s = 0; s < grid.steps.size(); ++s)
            grid.steps[s].push_back(place[s]);
        left += place.size() - grid.steps.size();
    }
    if (left > 0)
        grid.notices.push_back("of several slices at one place the first is taken; " +
                               std::to_string(left) + " are left out");
}

// All in one step, segments on each other.
void mergeSegments(const std::vector<Place>& places, DicomGrid& grid)
{
    grid.steps.resize(1);
    for (std::size_t k = 0; k < places.size(); ++k) {
        grid.steps[0].push_back(places[k].front());
        for (std::size_t i = 1; i < places[k].size(); ++i)
            grid.over.push_back({k, places[k][i]});
    }
}

double medianOf(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

// A slice far from all others, as of a scout, at either end.
void setOutlierAside(std::vector<double>& at, DicomGrid& grid)
{
    constexpr double FAR = 10.0; // gaps
    if (at.size() < 4) return;
    std::vector<double> gaps;
    for (std::size_t i = 0; i + 1 < at.size(); ++i)
        gaps.push_back(at[i + 1] - at[i]);
    const double most = FAR * medianOf(gaps);
    const bool last = gaps.back() > most;
    if (!last && !(gaps.front() > most)) return;
    grid.notices.push_back("the slice at " + millimetres(last ? at.back() : at.front()) +
                           " is set aside: it is " + millimetres(last ? gaps.back() : gaps[0]) +
                           " from the others");
    const auto drop = [last](auto& of) { of.erase(last ? of.end() - 1 : of.begin()); };
    drop(at);
    for (auto& step : grid.steps)
        drop(step);
}

/// The distance that divides all gaps; none where there is no such one.
double commonSpacing(const std::vector<double>& gaps, double mostFilled)
{
    const double least = *std::min_element(gaps.begin(), gaps.end());
    double total = 0.0, count = 0.0;
    for (const double gap : gaps) {
        const double times = std::round(gap / least);
        if (std::abs(gap - times * least) > EVEN * least) return 0.0;
        total += gap;
        count += times;
    }
    if (count + 1.0 > mostFilled * double(gaps.size() + 1)) return 0.0;
    return total / count;
}

void tellGaps(const std::vector<double>& at, double spacing, std::size_t count, DicomGrid& grid)
{
    constexpr int MOST_TOLD = 3;
    std::string text;
    int wide = 0;
    for (std::size_t i = 0; i + 1 < at.size(); ++i) {
        const double gap = at[i + 1] - at[i];
        if (gap < spacing * 1.5 || ++wide > MOST_TOLD) continue;
        text += (text.empty() ? "" : ", ") + millimetres(gap) + " between the slices at " +
                millimetres(at[i]) + " and " + millimetres(at[i + 1]);
    }
    grid.notices.push_back((wide ? "slices are missing: " + text + (wide > MOST_TOLD ? ", ..." : "")
                                 : std::string("slices are not evenly spaced")) +
                           "; resampled linearly, " + std::to_string(at.size()) + " slices to " +
                           std::to_string(count) + " of " + millimetres(spacing));
}

// Whether slices lie where a grid has them: small differences add up.
bool drifts(const std::vector<double>& at, double spacing)
{
    constexpr double MOST = 0.1; // of the spacing
    for (std::size_t k = 0; k < at.size(); ++k)
        if (!(std::abs(at[k] - (at[0] + double(k) * spacing)) < MOST * spacing)) return true;
    return false;
}

// Between two slices of labels there are none: the nearer one, or nothing.
DicomGrid::Slice labelSlice(std::size_t lower, double weight, double gap, double spacing)
{
    const bool upper = weight >= 0.5;
    const double distance = (upper ? 1.0 - weight : weight) * gap;
    return {upper ? lower + 1 : lower, 0.0, distance > 0.5 * spacing};
}

// Expects at least two places, in order. Returns the spacing.
double spaceEvenly(const std::vector<double>& at, bool labels, DicomGrid& grid)
{
    const double mostFilled = labels ? MOST_FILLED_LABELS : MOST_FILLED;
    std::vector<double> gaps;
    for (std::size_t i = 0; i + 1 < at.size(); ++i)
        gaps.push_back(at[i + 1] - at[i]);
    const double length = at.back() - at.front();
    const double common = commonSpacing(gaps, mostFilled);
    double spacing = common;
    if (!(spacing > 0.0)) {
        const double intervals =
            std::clamp(std::round(length / medianOf(gaps)), 1.0, mostFilled * double(at.size()));
        spacing = length / intervals;
    }
    const auto count = static_cast<std::size_t>(std::round(length / spacing)) + 1;
    const bool even = count == at.size() && common > 0.0 && !drifts(at, spacing);
    std::size_t lower = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double place = at.front() + spacing * double(k);
        while (lower + 2 < at.size() && at[lower + 1] <= place)
            ++lower;
        double weight = (place - at[lower]) / gaps[lower];
        if (even) weight = k > lower ? 1.0 : 0.0;
        // Where a slice lies, but for rounding.
        if (std::abs(weight - std::round(weight)) * gaps[lower] < EVEN * spacing)
            weight = std::round(weight);
        weight = std::clamp(weight, 0.0, 1.0);
        if (labels)
            grid.slices.push_back(labelSlice(lower, weight, gaps[lower], spacing));
        else
            grid.slices.push_back(weight < 1.0 ? DicomGrid::Slice{lower, weight}
                                               : DicomGrid::Slice{lower + 1, 0.0});
    }
    if (even)
        for (std::size_t k = 0; k < count; ++k)
            grid.slices[k] = {k, 0.0};
    else if (!labels || !(common > 0.0))
        tellGaps(at, spacing, count, grid);
    return spacing;
}

// How far the places are from a straight line, across it, in mm.
double bend(const std::vector<DicomFrame>& slices, const std::vector<double>& at,
            const glm::dvec3& perMillimetre)
{
    double most = 0.0;
    for (std::size_t i = 0; i < slices.size(); ++i)
        most = std::max(
            most, glm::distance(slices[i].position,
                                slices.front().position + (at[i] - at.front()) * perMillimetre));
    return most;
}

} // namespace

DicomGrid layOut(const DicomSeries& series, const DicomFile& file)
{
    DicomGrid grid;
    const DicomFrame& like = series.frames.front();
    const glm::dvec3 normal = like.normal();
    grid.placed = like.placed;
    const std::vector<Place> places =
        like.placed ? placesOf(series.frames) : unplaced(series.frames, file.framesAreTime);
    if (file.isSegments)
        mergeSegments(places, grid);
    else
        splitIntoSteps(places, grid);
    std::vector<double> at;
    for (const DicomFrame& frame : grid.steps.front())
        at.push_back(along(frame, normal));
    if (like.placed && !file.isSegments) setOutlierAside(at, grid);
    const std::vector<DicomFrame>& slices = grid.steps.front();
    const double thickness = like.thickness > 0.0 ? like.thickness : 1.0;
    grid.position = slices.front().position;
    grid.axes[0] = like.columnStep * like.row;
    grid.axes[1] = like.rowStep * like.column;
    grid.axes[2] = thickness * normal;
    if (!like.placed || slices.size() < 2) {
        for (std::size_t k = 0; k < slices.size(); ++k)
            grid.slices.push_back({k, 0.0});
        return grid;
    }
    const double spacing = spaceEvenly(at, file.isSegments, grid);
    const glm::dvec3 perMillimetre =
        (slices.back().position - slices.front().position) / (at.back() - at.front());
    grid.axes[2] = spacing * perMillimetre;
    const double off = bend(slices, at, perMillimetre);
    if (off > 0.1 * std::min(like.columnStep, like.rowStep) && off > 0.01 &&
        grid.slices.size() == slices.size())
        grid.notices.push_back("slices are up to " + millimetres(off) +
                               " off the straight line that they are drawn on");
    return grid;
}

} // namespace medical
} // namespace osgVolumizer
