#include "SamplingChoice.h"

#include "BrickTextures.h"

#include "../core/voxels/VoxelData.h"

#include <glm/geometric.hpp>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

namespace osgVolumizer {
namespace render {

namespace {

// Rays that show something, of so many tried; samples of each per voxel.
constexpr std::size_t RAYS = 1500, TRIALS = 8000;
constexpr double SAMPLES_PER_VOXEL = 8.0;
// Errors of few rays, and of steps that count along the view axis and not along the ray, are off by
// this.
constexpr double SAFETY = 1.35;
// What a step with integrals costs, in steps without.
constexpr double INTEGRAL_COST = 1.25;

// Values of the voxels at any place, as fractions of the range.
class ValueSampler
{
public:
    ValueSampler(const Voxels& voxels, const TableTexture& table, bool nearest)
        : _voxels(voxels), _nearest(nearest), _bricks(std::size_t(voxels.getLayout().brickCount()))
    {
        const osg::Vec2d range = voxels.getRange();
        const osg::ref_ptr<BrickTextures> textures = BrickTextures::of(voxels);
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
            brick.block = voxels.getBrick(index);
            brick.view.data = brick.block.data;
            brick.view.type = voxels.getType();
            brick.view.size = brick.place.samples.size();
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
        if (_nearest) return value(brick, glm::ivec3(glm::floor(local + 0.5)));
        const glm::ivec3 i = glm::min(glm::ivec3(local), glm::max(last - 1, glm::ivec3(0)));
        const glm::dvec3 f = local - glm::dvec3(i);
        double sum = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::ivec3 d(corner & 1, corner >> 1 & 1, corner >> 2);
            double weight = 1.0;
            for (int axis = 0; axis < 3; ++axis)
                weight *= d[axis] ? f[axis] : 1.0 - f[axis];
            if (weight > 0.0) sum += weight * value(brick, i + d);
        }
        return sum;
    }

private:
    struct Brick
    {
        core::BrickPlace place;
        bool shown = false;
        Voxels::Block block;
        core::VoxelView view;
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
    double value(const Brick& brick, const glm::ivec3& i) const
    {
        const glm::ivec3& n = brick.view.size;
        const auto index = i.x + std::int64_t(n.x) * (i.y + std::int64_t(n.y) * i.z);
        const double v = core::voxelValue(brick.view, index);
        return std::isfinite(v) ? v * _scale + _offset : 0.0;
    }

    const Voxels& _voxels;
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
std::vector<Ray> makeRays(ValueSampler& sampler, const core::Box3d& box, const SamplingQuestion& q)
{
    const TableTexture& table = q.integrals.texture ? q.integrals : q.midpoints;
    std::vector<Ray> rays;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    const double radius = 0.5 * glm::length(box.size());
    for (std::size_t trial = 0; trial < TRIALS && rays.size() < RAYS; ++trial) {
        const double z = 2.0 * unit(random) - 1.0, phi = glm::two_pi<double>() * unit(random);
        const double s = std::sqrt(1.0 - z * z);
        const glm::dvec3 direction(s * std::cos(phi), s * std::sin(phi), z);
        const glm::dvec3 side = glm::normalize(
            glm::cross(direction, std::abs(z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0)));
        const double r = radius * std::sqrt(unit(random)),
                     angle = glm::two_pi<double>() * unit(random);
        const glm::dvec3 point = box.center() + r * (std::cos(angle) * side +
                                                     std::sin(angle) * glm::cross(direction, side));
        double enter = -2.0 * radius, leave = 2.0 * radius;
        for (int axis = 0; axis < 3; ++axis) {
            const double a = (box.min[axis] - point[axis]) / direction[axis];
            const double b = (box.max[axis] - point[axis]) / direction[axis];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        if (!(leave > enter)) continue;
        const int intervals = std::max(2, static_cast<int>((leave - enter) * SAMPLES_PER_VOXEL));
        Ray ray;
        const double interval = (leave - enter) / intervals;
        ray.unitsPerInterval = interval * glm::length(q.frameToUnits * direction);
        ray.values.reserve(std::size_t(intervals) + 1);
        for (int i = 0; i <= intervals; ++i)
            ray.values.push_back(
                static_cast<float>(sampler.at(point + (enter + i * interval) * direction)));
        ray.light = march(ray, table, 1.0);
        if (ray.light.a > 1e-3) rays.push_back(std::move(ray));
    }
    return rays;
}

// Root mean square error, at the upper end of what so few rays leave uncertain: where a few rays
// have all the error, as with jumps in the table, that is much more than what they happen to show.
double errorOf(const std::vector<Ray>& rays, const TableTexture& table, double periodVoxel)
{
    double sum = 0.0, squares = 0.0;
    for (const Ray& ray : rays) {
        const glm::dvec4 d = march(ray, table, periodVoxel * SAMPLES_PER_VOXEL) - ray.light;
        const double square = 0.25 * glm::dot(d, d);
        sum += square;
        squares += square * square;
    }
    if (rays.empty()) return 0.0;
    const double count = static_cast<double>(rays.size()), mean = sum / count;
    const double deviation = std::sqrt(std::max(squares / count - mean * mean, 0.0) / count);
    return std::sqrt(mean + 2.0 * deviation);
}

// The longest period of a sequence, and then of what lies between, whose error is within the
// tolerance.
SamplingChoice choosePeriod(const std::vector<Ray>& rays, const TableTexture& table,
                            double tolerance)
{
    constexpr double LONGEST = 16.0, SHORTEST = 0.06, RATIO = 0.7937005259840998; // 2^(-1/3)
    SamplingChoice choice;
    choice.integrals = table.integrals;
    double longerError = 0.0;
    for (double period = LONGEST; period > SHORTEST; period *= RATIO) {
        const double error = errorOf(rays, table, period) * SAFETY;
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

SamplingChoice choose(const Voxels& voxels, const SamplingQuestion& q)
{
    ValueSampler sampler(voxels, q.integrals.texture ? q.integrals : q.midpoints, q.nearest);
    const core::Box3d box = intersection(sampler.shownBox(), q.box);
    if (box.empty()) return {};
    const std::vector<Ray> rays = makeRays(sampler, box, q);
    if (!q.integrals.texture) return choosePeriod(rays, q.midpoints, q.tolerance);
    const SamplingChoice runs = choosePeriod(rays, q.integrals, q.tolerance);
    if (!q.midpoints.texture) return runs;
    const SamplingChoice points = choosePeriod(rays, q.midpoints, q.tolerance);
    if (points.error > q.tolerance || runs.error > q.tolerance)
        return runs.error < points.error ? runs : points;
    return runs.periodVoxel > INTEGRAL_COST * points.periodVoxel ? runs : points;
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
