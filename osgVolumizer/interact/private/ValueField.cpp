#include "ValueField.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace picking {

namespace {

using A = VolumeAppearance;

// Keys's kernel overshoots: the weights of one sign sum up to ((5/4)^3 + 1)/2 in three dimensions.
constexpr double OVERSHOOT = 0.5 * (1.25 * 1.25 * 1.25 - 1.0);

glm::dvec4 emission(const glm::dvec4& color)
{
    const double extinction = core::extinctionFromOpacity(color.a);
    return {extinction * glm::dvec3(color), extinction};
}

int samplesPerAxis(A::Interpolation interpolation)
{
    return interpolation == A::NEAREST ? 1 : interpolation == A::LINEAR ? 2 : 4;
}

double mix(double a, double b, double t)
{
    return a + t * (b - a);
}

double linear(const double* c, const glm::dvec3& f)
{
    const double x0 = mix(c[0], c[1], f.x), x1 = mix(c[2], c[3], f.x);
    const double x2 = mix(c[4], c[5], f.x), x3 = mix(c[6], c[7], f.x);
    return mix(mix(x0, x1, f.y), mix(x2, x3, f.y), f.z);
}

// Keys's kernel with a = -1/2: weights of the samples -1, 0, 1 and 2.
void cubicWeights(double f, double* w)
{
    w[0] = 0.5 * ((2.0 - f) * f - 1.0) * f;
    w[1] = 0.5 * ((3.0 * f - 5.0) * f * f + 2.0);
    w[2] = 0.5 * ((4.0 - 3.0 * f) * f + 1.0) * f;
    w[3] = 0.5 * (f - 1.0) * f * f;
}

double cubic(const double* c, const glm::dvec3& f)
{
    double w[3][4], sum = 0.0;
    for (int a = 0; a < 3; ++a)
        cubicWeights(f[a], w[a]);
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j) {
            const double* row = c + 4 * (j + 4 * k);
            sum += w[2][k] * w[1][j] *
                   (w[0][0] * row[0] + w[0][1] * row[1] + w[0][2] * row[2] + w[0][3] * row[3]);
        }
    return sum;
}

double interpolated(A::Interpolation interpolation, const double* corners, const glm::dvec3& f)
{
    if (interpolation == A::NEAREST) return corners[0];
    return interpolation == A::LINEAR ? linear(corners, f) : cubic(corners, f);
}

} // namespace

double CellValues::at(const glm::dvec3& place) const
{
    return interpolated(interpolation, corner, place);
}

ValueField::ValueField(const Voxels& voxels, const PickLook& look, const render::TimeSteps& steps,
                       int level)
    : _look(look), _level(level),
      _first(voxels, level, steps.first, look.interpolation == A::CUBIC),
      _second(voxels, level, steps.second, look.interpolation == A::CUBIC),
      _blended(steps.blended && steps.fraction > 0.0f), _fraction(steps.fraction)
{
}

core::ValueRange ValueField::fractions(const core::ValueRange& range) const
{
    if (range.empty()) return range;
    double low = _look.fraction(range.low), high = _look.fraction(range.high);
    // Ranges are rounded to floats, outwards; what they become is rounded, too.
    const double slack = 1e-9 * (1.0 + std::fabs(low) + std::fabs(high));
    const double overshoot =
        _look.interpolation == A::CUBIC && !_look.before ? OVERSHOOT * (high - low) : 0.0;
    return {low - overshoot - slack, high + overshoot + slack};
}

GridReader::Part ValueField::partAt(const glm::ivec3& cell, const Shows& shows)
{
    if (!_blended) {
        GridReader::Part part = _first.partAt(
            cell, [&](const core::ValueRange& range) { return shows(fractions(range)); });
        part.range = fractions(part.range);
        return part;
    }
    // Of two steps each range alone tells nothing.
    const auto any = [](const core::ValueRange&) { return true; };
    const GridReader::Part a = _first.partAt(cell, any), b = _second.partAt(cell, any);
    GridReader::Part part;
    part.box = core::intersection(a.box, b.box);
    if (!a.shown || !b.shown) return part;
    part.range = fractions(
        {mix(a.range.low, b.range.low, _fraction), mix(a.range.high, b.range.high, _fraction)});
    part.shown = shows(part.range);
    return part;
}

bool ValueField::fetch(const glm::ivec3& cell, int component, double* values)
{
    const int n = samplesPerAxis(_look.interpolation), first = n == 4 ? -1 : 0;
    if (!_first.fetch(cell, first, n, component, values)) return false;
    if (!_blended) return true;
    double later[64];
    if (!_second.fetch(cell, first, n, component, later)) return false;
    for (int i = 0; i < n * n * n; ++i)
        values[i] = mix(values[i], later[i], _fraction);
    return true;
}

CellValues ValueField::cellValues(const glm::ivec3& cell)
{
    CellValues values;
    values.interpolation = _look.interpolation;
    values.valid = fetch(cell, significantComponent(), values.corner);
    if (!values.valid) return values;
    const int count = sampleCount();
    for (int i = 0; i < count; ++i) {
        const double fraction = _look.fraction(values.corner[i]);
        values.corner[i] = _look.before ? _look.extinction(fraction) : fraction;
    }
    return values;
}

double ValueField::dataAt(const glm::dvec3& place, int component)
{
    const double shift = cellShift();
    const glm::dvec3 held = glm::clamp(place, glm::dvec3(0.0), glm::dvec3(_first.size() - 1));
    const glm::dvec3 low = glm::floor(held + shift);
    double corners[64];
    if (!fetch(glm::ivec3(low), component, corners)) return NAN;
    return interpolated(_look.interpolation, corners, held - low);
}

// Extinction times colour, and extinction, of samples that are looked up before interpolation.
glm::dvec4 ValueField::emissionAt(const glm::dvec3& place)
{
    const int components = _look.rgba ? 4 : 1, count = sampleCount();
    const glm::dvec3 held = glm::clamp(place, glm::dvec3(0.0), glm::dvec3(_first.size() - 1));
    const glm::dvec3 low = glm::floor(held + cellShift());
    double samples[4][64], parts[4][64];
    for (int c = 0; c < components; ++c)
        if (!fetch(glm::ivec3(low), c, samples[c])) return glm::dvec4(0.0);
    for (int i = 0; i < count; ++i) {
        glm::dvec4 color;
        if (_look.rgba)
            for (int c = 0; c < 4; ++c)
                color[c] = _look.fraction(samples[c][i]);
        else
            color = _look.table->function->evaluate(_look.fraction(samples[0][i]));
        const glm::dvec4 e = emission(color);
        for (int c = 0; c < 4; ++c)
            parts[c][i] = e[c];
    }
    glm::dvec4 sum;
    for (int c = 0; c < 4; ++c)
        sum[c] = std::max(0.0, interpolated(_look.interpolation, parts[c], held - low));
    return sum;
}

int ValueField::sampleCount() const
{
    const int n = samplesPerAxis(_look.interpolation);
    return n * n * n;
}

glm::dvec4 ValueField::colorAt(const glm::dvec3& place, const glm::dvec4& vertexColor)
{
    glm::dvec4 color(0.0); // with extinction as its alpha
    if (_look.before) {
        const glm::dvec4 e = emissionAt(place);
        if (e.a > 0.0) color = glm::dvec4(glm::dvec3(e) / e.a, e.a);
    } else if (_look.rgba) {
        for (int c = 0; c < 4; ++c)
            color[c] = _look.fraction(dataAt(place, c));
        color.a = core::extinctionFromOpacity(color.a);
    } else {
        color = _look.table->function->evaluate(_look.fraction(dataAt(place, 0)));
        color.a = core::extinctionFromOpacity(color.a);
    }
    color *= vertexColor;
    color.a = core::opacityFromExtinction(color.a, 1.0);
    return color;
}

glm::dvec3 ValueField::gradientAt(const glm::dvec3& place)
{
    const glm::dvec3 last(_first.size() - 1);
    const glm::dvec3 held = glm::clamp(place, glm::dvec3(0.0), last);
    glm::dvec3 gradient(0.0);
    for (int a = 0; a < 3; ++a) {
        glm::dvec3 low = held, high = held;
        low[a] = std::max(low[a] - 1.0, 0.0);
        high[a] = std::min(high[a] + 1.0, last[a]);
        if (high[a] > low[a])
            gradient[a] =
                (dataAt(high, significantComponent()) - dataAt(low, significantComponent())) /
                (high[a] - low[a]);
    }
    return gradient;
}

double ValueField::rawSample(const glm::ivec3& place, int component)
{
    const double first = _first.rawSample(place, component);
    return _blended ? mix(first, _second.rawSample(place, component), _fraction) : first;
}

} // namespace picking
} // namespace osgVolumizer
