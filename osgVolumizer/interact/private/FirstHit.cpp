#include "FirstHit.h"

#include <limits>

namespace osgVolumizer {
namespace picking {

namespace {

using A = VolumeAppearance;

constexpr int HALVINGS = 20;

/// A step of a ray: the values, or extinctions, at its ends and in its middle.
struct RayStep
{
    double begin, end;
    double first, middle, last;
};

double stepExtinction(const PickLook& look, const RayStep& step)
{
    if (look.before) // Simpson's rule is exact for the cubic that a trilinear value is on a line
        return std::max(0.0, (step.first + 4.0 * step.middle + step.last) / 6.0);
    return look.meanExtinction(step.first, step.last);
}

// What of the step it takes to add `missing` to the optical depth.
double partOfStep(const PickLook& look, const RayStep& step, double depthPerExtinction,
                  double missing)
{
    double low = 0.0, high = 1.0;
    for (int i = 0; i < HALVINGS; ++i) {
        const double f = 0.5 * (low + high);
        const double last = step.first + f * (step.last - step.first);
        RayStep part = step;
        part.last = last;
        part.middle = 0.5 * (step.first + last);
        const double depth = f * depthPerExtinction * stepExtinction(look, part);
        (depth < missing ? low : high) = f;
    }
    return 0.5 * (low + high);
}

// Calls f(RayStep) for the steps of a cell's part until it returns false.
template <class F>
bool forSteps(const CellPart& part, bool middles, F&& f)
{
    const int count = part.steps();
    const double width = (part.end - part.begin) / count;
    double first = part.at(part.begin);
    for (int i = 0; i < count; ++i) {
        const double begin = part.begin + i * width;
        const double end = i + 1 == count ? part.end : begin + width;
        const double last = part.at(end);
        if (!f(RayStep{begin, end, first, middles ? part.at(0.5 * (begin + end)) : 0.0, last}))
            return false;
        first = last;
    }
    return true;
}

// What trilinear values of a cell are within.
core::ValueRange cornerRange(const CellValues& values)
{
    const auto ends = std::minmax_element(values.corner, values.corner + 8);
    return {*ends.first, *ends.second};
}

bool cellShows(const PickLook& look, const CellValues& values)
{
    if (look.before || values.interpolation != A::LINEAR) return true;
    const core::ValueRange range = cornerRange(values);
    return look.maximumOpacity(range.low, range.high) > 0.0;
}

SeenPlace seenAt(const Span& span, double parameter)
{
    return {true, parameter, span};
}

SeenPlace firstOpaque(ValueField* field, const PickLook& look, const std::vector<Span>& spans,
                      double units, double opacity)
{
    double missing = -std::log1p(-opacity);
    for (const Span& span : spans) {
        double reached = 0.0;
        const double depth = field ? opticalDepth(*field, look, span, units, missing, reached)
                                   : opticalDepth(look, span, units, missing, reached);
        if (depth >= missing) return seenAt(span, reached);
        missing -= depth;
    }
    return {};
}

// What the look's table is of: a fraction of the range of scalars, or the opacity of a colour.
double valueWithoutVoxels(const PickLook& look, const Span& span, double parameter)
{
    constexpr double PLAIN = 0.5;
    if (look.scalars) return look.fraction(span.scalarAt(parameter));
    return look.plain ? PLAIN : span.colorAt(parameter).a;
}

// Scalars are linear in each span, and extreme at its ends.
SeenPlace firstScalar(const PickLook& look, const std::vector<Span>& spans, double opacity)
{
    const bool extreme = look.rayFunction == A::MAXIMUM || look.rayFunction == A::MINIMUM;
    const double sign = look.rayFunction == A::MINIMUM ? -1.0 : 1.0;
    SeenPlace place;
    double best = -std::numeric_limits<double>::infinity();
    for (const Span& span : spans) {
        const double a = look.fraction(span.scalarAt(span.begin));
        const double b = look.fraction(span.scalarAt(span.end)), iso = look.isoFraction;
        if (!extreme && (a < iso) != (b < iso))
            return seenAt(span, span.begin + (iso - a) / (b - a) * (span.end - span.begin));
        for (const bool end : {false, true}) {
            const double value = end ? b : a;
            if (!extreme || !(sign * value > best)) continue;
            best = sign * value;
            place = seenAt(span, end ? span.end : span.begin);
        }
    }
    return extreme && place.found && look.opacity(sign * best) >= opacity ? place : SeenPlace();
}

// AVERAGE and SUM of scalars: the middle of what is gathered.
SeenPlace middleOfScalars(const PickLook& look, const std::vector<Span>& spans, double units,
                          double opacity)
{
    double sum = 0.0, length = 0.0;
    for (const Span& span : spans) {
        const double part = units * (span.end - span.begin);
        sum += part * look.fraction(span.scalarAt(0.5 * (span.begin + span.end)));
        length += part;
    }
    const double gathered = look.rayFunction == A::AVERAGE ? sum / length : sum;
    if (!(length > 0.0) || look.opacity(gathered) < opacity) return {};
    double half = 0.5 * length / units;
    for (const Span& span : spans) {
        if (half <= span.end - span.begin) return seenAt(span, span.begin + half);
        half -= span.end - span.begin;
    }
    return seenAt(spans.back(), spans.back().end);
}

// Of a cell in which the value crosses the iso-value between two parameters.
double rootBetween(const CellPart& part, double iso, double low, double high)
{
    const bool below = part.at(low) < iso;
    for (int i = 0; i < 40; ++i) {
        const double middle = 0.5 * (low + high);
        ((part.at(middle) < iso) == below ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

SeenPlace firstCrossing(ValueField& field, const PickLook& look, const std::vector<Span>& spans)
{
    const double iso = look.isoFraction;
    const auto holdsIso = [&](const core::ValueRange& r) { return r.low <= iso && iso <= r.high; };
    for (const Span& span : spans) {
        double lastEnd = -1.0, found = -1.0;
        bool lastBelow = false; // what it was at lastEnd
        const bool nowhere = walkCells(field, span, holdsIso, [&](const CellPart& part) {
            // What was left out between lies on one side of the iso-value throughout.
            if (lastEnd == part.begin && (part.at(part.begin) < iso) != lastBelow) {
                found = part.begin; // a jump, as between nearest samples
                return false;
            }
            const bool goesOn = forSteps(part, false, [&](const RayStep& step) {
                if ((step.first < iso) == (step.last < iso)) return true;
                found = rootBetween(part, iso, step.begin, step.end);
                return false;
            });
            lastEnd = part.end;
            lastBelow = part.at(part.end) < iso;
            return goesOn;
        });
        if (!nowhere) return seenAt(span, found);
    }
    return {};
}

// The place of the largest `sign` times value, the first one of equals.
class ExtremeSearch
{
public:
    explicit ExtremeSearch(double sign) : _sign(sign) {}

    bool canImprove(const core::ValueRange& range) const
    {
        return (_sign > 0.0 ? range.high : -range.low) > _best;
    }
    void look(const CellPart& part, const Span& span)
    {
        if (part.values.interpolation == A::LINEAR && !canImprove(cornerRange(part.values))) return;
        const double before = _best;
        double at = 0.0, width = 0.0;
        const auto take = [&](double t, double value, double step) {
            if (!(_sign * value > _best)) return;
            _best = _sign * value;
            at = t;
            width = step;
        };
        forSteps(part, false, [&](const RayStep& step) {
            take(step.begin, step.first, step.end - step.begin);
            take(step.end, step.last, step.end - step.begin);
            return true;
        });
        if (_best == before) return;
        // Between samples the extreme is looked for about the best one, by halving.
        for (int i = 0; i < HALVINGS; ++i) {
            width *= 0.5;
            for (const double t : {at - width, at + width})
                if (t >= part.begin && t <= part.end) take(t, part.at(t), width);
        }
        _place = seenAt(span, at);
    }
    const SeenPlace& place() const { return _place; }
    double value() const { return _sign * _best; }

private:
    double _sign, _best = -std::numeric_limits<double>::infinity();
    SeenPlace _place;
};

SeenPlace extreme(ValueField& field, const PickLook& look, const std::vector<Span>& spans,
                  double sign, double opacity)
{
    ExtremeSearch search(sign);
    for (const Span& span : spans)
        walkCells(
            field, span, [&](const core::ValueRange& r) { return search.canImprove(r); },
            [&](const CellPart& part) {
                search.look(part, span);
                return true;
            });
    const bool seen = search.place().found && look.opacity(search.value()) >= opacity;
    return seen ? search.place() : SeenPlace();
}

// AVERAGE and SUM: the middle of what is gathered.
SeenPlace middle(ValueField& field, const PickLook& look, const std::vector<Span>& spans,
                 double units, double opacity)
{
    double sum = 0.0, length = 0.0;
    const auto everything = [](const core::ValueRange&) { return true; };
    for (const Span& span : spans) {
        walkCells(field, span, everything, [&](const CellPart& part) {
            return forSteps(part, true, [&](const RayStep& s) {
                sum += units * (s.end - s.begin) * (s.first + 4.0 * s.middle + s.last) / 6.0;
                return true;
            });
        });
        length += units * (span.end - span.begin);
    }
    if (!(length > 0.0)) return {};
    const double gathered = look.rayFunction == A::AVERAGE ? sum / length : sum;
    if (look.opacity(gathered) < opacity) return {};
    double half = 0.5 * length / units;
    for (const Span& span : spans) {
        if (half <= span.end - span.begin) return seenAt(span, span.begin + half);
        half -= span.end - span.begin;
    }
    return seenAt(spans.back(), spans.back().end);
}

} // namespace

double unitsPerParameter(const Segment& segment, const PickLook& look)
{
    return segment.length() / look.opacityUnit;
}

double opticalDepth(ValueField& field, const PickLook& look, const Span& span, double units,
                    double enough, double& reached)
{
    double depth = 0.0;
    reached = span.end;
    const auto shows = [&](const core::ValueRange& r) {
        return look.maximumOpacity(r.low, r.high) > 0.0;
    };
    walkCells(field, span, shows, [&](const CellPart& part) {
        if (!cellShows(look, part.values)) return true;
        return forSteps(part, look.before, [&](const RayStep& step) {
            const double alpha = span.colorAt(0.5 * (step.begin + step.end)).a;
            const double perExtinction = units * (step.end - step.begin) * std::max(alpha, 0.0);
            const double added = perExtinction * stepExtinction(look, step);
            if (depth + added >= enough) {
                const double f = partOfStep(look, step, perExtinction, enough - depth);
                reached = step.begin + f * (step.end - step.begin);
                depth = enough;
                return false;
            }
            depth += added;
            return true;
        });
    });
    return depth;
}

double opticalDepth(const PickLook& look, const Span& span, double units, double enough,
                    double& reached)
{
    const RayStep step{span.begin, span.end, valueWithoutVoxels(look, span, span.begin), 0.0,
                       valueWithoutVoxels(look, span, span.end)};
    const double perExtinction = units * (span.end - span.begin);
    const double depth = perExtinction * stepExtinction(look, step);
    reached = span.end;
    if (depth < enough) return depth;
    reached = span.begin + partOfStep(look, step, perExtinction, enough) * (span.end - span.begin);
    return enough;
}

SeenPlace findSeenPlace(ValueField* field, const PickLook& look, const std::vector<Span>& spans,
                        double units, double opacity)
{
    if (look.paints) return {};
    const bool gathered = look.rayFunction == A::AVERAGE || look.rayFunction == A::SUM;
    if (!field && look.scalars && gathered) return middleOfScalars(look, spans, units, opacity);
    const bool searched = look.rayFunction == A::ISOSURFACE || look.rayFunction == A::MAXIMUM ||
                          look.rayFunction == A::MINIMUM;
    if (!field && look.scalars && searched) return firstScalar(look, spans, opacity);
    if (!field) return firstOpaque(nullptr, look, spans, units, opacity);
    switch (look.rayFunction) {
    case A::MAXIMUM:
        return extreme(*field, look, spans, 1.0, opacity);
    case A::MINIMUM:
        return extreme(*field, look, spans, -1.0, opacity);
    case A::AVERAGE:
    case A::SUM:
        return middle(*field, look, spans, units, opacity);
    case A::ISOSURFACE:
        return firstCrossing(*field, look, spans);
    case A::COMPOSITE:
        break;
    }
    return firstOpaque(field, look, spans, units, opacity);
}

} // namespace picking
} // namespace osgVolumizer
