#include "SamplingChoice.h"

#include "../textures/BrickResidency.h"

#include "../../core/voxels/VoxelData.h"
#include "../../core/voxels/VoxelDispatch.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <type_traits>

namespace osgVolumizer {
namespace render {

namespace {

// Rays that show something; where they disagree about the error by more than this (standard
// deviation of the mean square, relative), up to so many, in so much memory.
constexpr std::size_t RAYS = 1500, MOST_RAYS = 12000, MOST_SAMPLES = 8000000;
constexpr double DOUBT = 0.15;
// So many are tried for each that shows something.
constexpr std::size_t TRIALS = 6;
// What is taken for the truth has so many samples a voxel; that is enough for periods down to
// COARSE_TRUTH voxels, and four times as many for all.
constexpr double SAMPLES_PER_VOXEL = 8.0, COARSE_TRUTH = 0.5;
constexpr double LONGEST = 16.0, SHORTEST = 0.0625; // periods, voxels
// Errors of few rays, and of steps that count along the view axis and not along the ray, are off by
// this.
constexpr double SAFETY = 1.35;
// What a step with integrals costs, in steps without.
constexpr double INTEGRAL_COST = 1.25;

using Interpolate = double (*)(const core::VoxelView& view, const glm::ivec3& corner,
                               const glm::dvec3& f);

// The trilinear interpolant in a cell; NaN where samples are no numbers.
template <class T>
double interpolate(const core::VoxelView& view, const glm::ivec3& corner, const glm::dvec3& f)
{
    using Number = std::conditional_t<std::is_same<T, core::Half>::value, float, T>;
    const glm::ivec3& n = view.size;
    const std::int64_t row = n.x, layer = row * n.y;
    const T* v = static_cast<const T*>(view.data) + corner.x + row * corner.y + layer * corner.z;
    // Beyond the last sample the weight is 0.
    const std::int64_t dx = corner.x + 1 < n.x ? 1 : 0, dy = corner.y + 1 < n.y ? row : 0,
                       dz = corner.z + 1 < n.z ? layer : 0;
    const auto edge = [&](std::int64_t i) {
        const double a = double(Number(v[i])), b = double(Number(v[i + dx]));
        return a + f.x * (b - a);
    };
    const auto face = [&](std::int64_t i) {
        const double a = edge(i), b = edge(i + dy);
        return a + f.y * (b - a);
    };
    const double a = face(0), b = face(dz), value = a + f.z * (b - a);
    return std::isfinite(value) ? value : NAN;
}

Interpolate interpolationOf(VoxelType type)
{
    return core::visitVoxelType(type,
                                [](auto tag) -> Interpolate { return interpolate<decltype(tag)>; });
}

// Values of the voxels at any place, as fractions of the range.
class ValueSampler
{
public:
    ValueSampler(const Voxels& voxels, const TableTexture& table, bool nearest)
        : _nearest(nearest), _bricks(std::size_t(voxels.getLayout().brickCount()))
    {
        const osg::Vec2d range = voxels.getRange();
        const osg::ref_ptr<BrickResidency> textures = BrickResidency::of(voxels);
        OccupancyQuery query;
        query.table = &table;
        const core::BrickLayout& layout = voxels.getLayout();
        for (std::size_t i = 0; i < _bricks.size(); ++i) {
            Brick& brick = _bricks[i];
            const auto index = static_cast<std::int64_t>(i);
            brick.place = layout.brick(index);
            const auto values = voxels.getBrickRange(index);
            const double width = range.y() - range.x();
            brick.shown = table.shows((values.first - range.x()) / width,
                                      (values.second - range.x()) / width);
            if (!brick.shown) continue;
            brick.block = BrickResidency::load(voxels, index);
            brick.view.data = brick.block.data;
            brick.view.type = voxels.getType();
            brick.view.size = brick.place.samples.size();
            brick.interpolate = interpolationOf(voxels.getType());
            brick.shown = brick.block.data != nullptr;
            if (!brick.shown) continue;
            const auto cells = textures->cells().get(voxels, index, query);
            if (!cells || cells->box.empty()) continue;
            _shownBox.expand(cells->box.min);
            _shownBox.expand(cells->box.max);
        }
        _scale = 1.0 / (range.y() - range.x());
        _offset = -range.x() * _scale;
    }

    const core::Box3d& shownBox() const { return _shownBox; }
    // NaN where nothing shows.
    double at(const glm::dvec3& p)
    {
        if (!holds(_last, p) && !find(p)) return NAN;
        const Brick& brick = _bricks[_last];
        if (!brick.shown) return NAN;
        const glm::ivec3 last = brick.view.size - 1;
        const glm::dvec3 local =
            glm::clamp(p - glm::dvec3(brick.place.samples.min), glm::dvec3(0.0), glm::dvec3(last));
        const glm::dvec3 whole =
            _nearest ? glm::floor(local + 0.5) : glm::min(glm::floor(local), glm::dvec3(last - 1));
        const glm::dvec3 corner = glm::max(whole, glm::dvec3(0.0));
        const glm::dvec3 f = _nearest ? glm::dvec3(0.0) : local - corner;
        const double value = brick.interpolate(brick.view, glm::ivec3(corner), f);
        return std::isnan(value) ? 0.0 : value * _scale + _offset;
    }

private:
    struct Brick
    {
        core::BrickPlace place;
        bool shown = false;
        Voxels::Block block;
        core::VoxelView view;
        Interpolate interpolate = nullptr;
    };

    bool holds(std::size_t brick, const glm::dvec3& p) const
    {
        const core::Box3d& box = _bricks[brick].place.clipBox;
        return glm::all(glm::lessThanEqual(box.min, p)) && glm::all(glm::lessThanEqual(p, box.max));
    }
    bool find(const glm::dvec3& p)
    {
        for (std::size_t i = 0; i < _bricks.size(); ++i)
            if (holds(i, p)) {
                _last = i;
                return true;
            }
        return false;
    }

    bool _nearest;
    std::vector<Brick> _bricks;
    std::size_t _last = 0;
    core::Box3d _shownBox;
    double _scale = 1.0, _offset = 0.0;
};

// One ray's values at equal distances, ends included.
struct Ray
{
    std::vector<float> values;
    double unitsPerInterval = 1.0; ///< opacity units between two of them
    glm::dvec4 light{0.0};         ///< converged

    double at(double place) const
    {
        const auto i = std::min(static_cast<std::size_t>(place), values.size() - 2);
        const double f = place - static_cast<double>(i), a = double(values[i]),
                     b = double(values[i + 1]);
        if (std::isnan(a) || std::isnan(b)) return f < 0.5 ? a : b;
        return a + f * (b - a);
    }
    double length() const { return static_cast<double>(values.size() - 1); } ///< in intervals
};

const glm::vec4* texels(const TableTexture& table)
{
    return reinterpret_cast<const glm::vec4*>(table.texture->getImage()->data());
}

glm::dvec4 classify(const TableTexture& table, double value)
{
    if (std::isnan(value)) return glm::dvec4(0.0);
    const double last = table.count - 1.0;
    return glm::dvec4(texels(table)[static_cast<int>(std::clamp(value, 0.0, 1.0) * last + 0.5)]);
}

// Mean over a run of values.
glm::dvec4 classifyRun(const TableTexture& table, double from, double to)
{
    if (std::isnan(from) || std::isnan(to)) return classify(table, std::isnan(from) ? to : from);
    const double last = table.count - 1.0;
    const int a = static_cast<int>(std::clamp(from, 0.0, 1.0) * last + 0.5);
    const int b = static_cast<int>(std::clamp(to, 0.0, 1.0) * last + 0.5);
    if (std::abs(a - b) < 4) return classify(table, 0.5 * (from + to));
    const glm::vec4* integral = texels(table) + table.count;
    const glm::dvec4 mean = (glm::dvec4(integral[b]) - glm::dvec4(integral[a])) / double(b - a);
    return glm::dvec4(glm::dvec3(mean) / std::max(mean.a, 1e-12), mean.a);
}

glm::dvec4 march(const Ray& ray, const TableTexture& table, double periodIntervals)
{
    const int steps = std::max(1, static_cast<int>(ray.length() / periodIntervals + 0.5));
    const double h = ray.length() / steps;
    glm::dvec3 color(0.0);
    double through = 1.0, before = ray.at(0.0);
    for (int i = 0; i < steps && through > 3e-5; ++i) {
        const double after = table.integrals ? ray.at((i + 1) * h) : 0.0;
        const glm::dvec4 c = table.integrals ? classifyRun(table, before, after)
                                             : classify(table, ray.at((i + 0.5) * h));
        const double next = through * std::exp2(-c.a * h * ray.unitsPerInterval);
        color += (through - next) * glm::dvec3(c);
        through = next;
        before = after;
    }
    return glm::dvec4(color, 1.0 - through);
}

// Uniform lines through the box: as many of each direction as an orthographic view has pixels.
class RaySet
{
public:
    RaySet(ValueSampler& sampler, const core::Box3d& box, const SamplingQuestion& q,
           double samplesPerVoxel)
        : _sampler(sampler), _box(box), _q(q), _samplesPerVoxel(samplesPerVoxel)
    {
        grow(RAYS);
    }
    const std::vector<Ray>& rays() const { return _rays; }
    double samplesPerVoxel() const { return _samplesPerVoxel; }
    /// Twice as many; false where that would be too many.
    bool doubleRays()
    {
        const std::size_t count = 2 * _rays.size();
        if (_rays.empty() || count > MOST_RAYS || 2 * _samples > MOST_SAMPLES) return false;
        grow(count);
        return _rays.size() == count;
    }

private:
    void grow(std::size_t count)
    {
        const std::size_t trials = TRIALS * (count - _rays.size());
        for (std::size_t i = 0; i < trials && _rays.size() < count; ++i)
            tryRay();
    }
    void tryRay();

    ValueSampler& _sampler;
    const core::Box3d _box;
    const SamplingQuestion& _q;
    const double _samplesPerVoxel;
    std::vector<Ray> _rays;
    std::size_t _samples = 0;
    std::mt19937 _random{7};
};

void RaySet::tryRay()
{
    const TableTexture& table = _q.integrals.texture ? _q.integrals : _q.midpoints;
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const auto next = [&]() { return unit(_random); };
    const double radius = 0.5 * glm::length(_box.size());
    const double z = 2.0 * next() - 1.0, phi = glm::two_pi<double>() * next();
    const double s = std::sqrt(1.0 - z * z);
    const glm::dvec3 direction(s * std::cos(phi), s * std::sin(phi), z);
    const glm::dvec3 side = glm::normalize(
        glm::cross(direction, std::abs(z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
    const double r = radius * std::sqrt(next()), angle = glm::two_pi<double>() * next();
    const glm::dvec3 point = _box.center() + r * (std::cos(angle) * side +
                                                  std::sin(angle) * glm::cross(direction, side));
    double enter = -2.0 * radius, leave = 2.0 * radius;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = (_box.min[axis] - point[axis]) / direction[axis];
        const double b = (_box.max[axis] - point[axis]) / direction[axis];
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
    }
    if (!(leave > enter)) return;
    const int intervals = std::max(2, static_cast<int>((leave - enter) * _samplesPerVoxel));
    Ray ray;
    const double interval = (leave - enter) / intervals;
    ray.unitsPerInterval = interval * glm::length(_q.frameToUnits * direction);
    ray.values.reserve(std::size_t(intervals) + 1);
    for (int i = 0; i <= intervals; ++i)
        ray.values.push_back(
            static_cast<float>(_sampler.at(point + (enter + i * interval) * direction)));
    ray.light = march(ray, table, 1.0);
    if (!(ray.light.a > 1e-3)) return;
    _samples += ray.values.size();
    _rays.push_back(std::move(ray));
}

// Mean of the rays' squared errors, and its standard deviation.
struct MeanSquare
{
    double mean = 0.0, deviation = 0.0;
};

MeanSquare errorOf(const RaySet& set, const TableTexture& table, double periodVoxel)
{
    const std::vector<Ray>& rays = set.rays();
    double sum = 0.0, squares = 0.0;
    for (const Ray& ray : rays) {
        const glm::dvec4 d = march(ray, table, periodVoxel * set.samplesPerVoxel()) - ray.light;
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
double upperError(RaySet& rays, const TableTexture& table, double periodVoxel, double tolerance)
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
SamplingChoice choosePeriod(RaySet& rays, const TableTexture& table, double tolerance,
                            const glm::dvec2& periods)
{
    constexpr double RATIO = 0.7937005259840998; // 2^(-1/3)
    SamplingChoice choice;
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
SamplingChoice choose(RaySet& rays, const SamplingQuestion& q, const glm::dvec2& periods)
{
    if (!q.integrals.texture) return choosePeriod(rays, q.midpoints, q.tolerance, periods);
    const SamplingChoice runs = choosePeriod(rays, q.integrals, q.tolerance, periods);
    if (!q.midpoints.texture) return runs;
    const SamplingChoice points = choosePeriod(rays, q.midpoints, q.tolerance, periods);
    if (points.error > q.tolerance || runs.error > q.tolerance)
        return runs.error < points.error ? runs : points;
    return runs.periodVoxel > INTEGRAL_COST * points.periodVoxel ? runs : points;
}

SamplingChoice choose(const Voxels& voxels, const SamplingQuestion& q)
{
    ValueSampler sampler(voxels, q.integrals.texture ? q.integrals : q.midpoints, q.nearest);
    const core::Box3d box = intersection(sampler.shownBox(), q.box);
    if (box.empty()) return {};
    RaySet coarse(sampler, box, q, SAMPLES_PER_VOXEL);
    const SamplingChoice choice = choose(coarse, q, {LONGEST, COARSE_TRUTH});
    if (choice.error <= q.tolerance) return choice;
    RaySet fine(sampler, box, q, 4.0 * SAMPLES_PER_VOXEL);
    return choose(fine, q, {COARSE_TRUTH, SHORTEST});
}

std::uint64_t modifiedCount(const Voxels& voxels)
{
    std::uint64_t sum = 0;
    for (std::int64_t i = 0; i < voxels.getLayout().brickCount(); ++i)
        sum += voxels.getModifiedCount(i);
    return sum;
}

} // namespace

SamplingChoice SamplingChoices::get(const Voxels& voxels, const SamplingQuestion& q)
{
    const std::uint64_t modified = modifiedCount(voxels);
    std::lock_guard<std::mutex> lock(_mutex);
    for (auto i = _entries.begin(); i != _entries.end(); ++i) {
        if (i->midpointsId != q.midpoints.id || i->integralsId != q.integrals.id ||
            i->layoutCount != voxels.getLayoutCount() || i->modified != modified ||
            i->tolerance != q.tolerance || i->frameToUnits != q.frameToUnits ||
            !(i->box == q.box) || i->nearest != q.nearest)
            continue;
        _entries.splice(_entries.begin(), _entries, i);
        return _entries.front().choice;
    }
    _entries.push_front({q.midpoints.id, q.integrals.id, voxels.getLayoutCount(), modified,
                         q.tolerance, q.frameToUnits, q.box, q.nearest, choose(voxels, q)});
    if (_entries.size() > CAPACITY) _entries.pop_back();
    return _entries.front().choice;
}

} // namespace render
} // namespace osgVolumizer
