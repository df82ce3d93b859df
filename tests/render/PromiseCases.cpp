#include "PromiseCases.h"

#include <osgVolumizer/ReadVoxels.h>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace osgVolumizer {
namespace test {

namespace promise {
namespace {

constexpr int PICTURE = 48;

/// Numbers that are the same with every standard library, as those of its distributions are not.
class Random
{
public:
    explicit Random(int seed) : _engine(static_cast<std::mt19937::result_type>(seed)) {}

    double uniform(double low = 0.0, double high = 1.0)
    {
        return low + (high - low) * (static_cast<double>(_engine()) * 0x1p-32);
    }
    double logarithmic(double low, double high) { return low * std::pow(high / low, uniform()); }
    /// From low to high, both included.
    int integer(int low, int high)
    {
        return std::min(high, low + static_cast<int>(uniform(0.0, high - low + 1.0)));
    }
    glm::dvec3 direction()
    {
        const double z = uniform(-1.0, 1.0), angle = uniform(0.0, 6.283185307179586);
        const double s = std::sqrt(1.0 - z * z);
        return {s * std::cos(angle), s * std::sin(angle), z};
    }
    glm::dvec4 color(double opacity)
    {
        const double r = uniform(), g = uniform(), b = uniform();
        return {r, g, b, opacity};
    }

private:
    std::mt19937 _engine;
};

struct Interval
{
    double low, high;

    double at(double f) const { return low + f * (high - low); }
};

// Each appends the points of a table within an interval, about as opaque as asked for at most.

void appendJumps(Random& random, const Interval& in, double opacity, Points& points)
{
    std::vector<double> places(static_cast<std::size_t>(random.integer(1, 5)));
    for (double& place : places)
        place = in.at(random.uniform());
    std::sort(places.begin(), places.end());
    places.push_back(in.high);
    // Every other level shows something, so that some do; the last one of few may.
    bool shows = random.uniform() < 0.5;
    double start = in.low;
    for (const double end : places) {
        const glm::dvec4 color = random.color(shows ? random.uniform(0.3, 1.0) * opacity : 0.0);
        points.push_back({start, color});
        points.push_back({end, random.uniform() < 0.7 ? color : random.color(color.a)});
        start = end;
        shows = !shows || random.uniform() < 0.3;
    }
}

void appendPeaks(Random& random, const Interval& in, double opacity, Points& points)
{
    const glm::dvec4 ground = random.color(random.uniform() < 0.7 ? 0.0 : 0.02 * opacity);
    points.push_back({in.low, ground});
    const int count = random.integer(1, 3);
    for (int i = 0; i < count; ++i) {
        // Each in a part of its own.
        const double width = random.uniform(0.01, 0.05);
        const Interval part{in.at((i + 0.02) / count) + 0.5 * width,
                            in.at((i + 0.98) / count) - 0.5 * width};
        const double center = part.at(random.uniform());
        if (part.low > part.high) continue;
        points.push_back({center - 0.5 * width, ground});
        points.push_back({center, random.color(random.uniform(0.5, 1.0) * opacity)});
        points.push_back({center + 0.5 * width, ground});
    }
    points.push_back({in.high, ground});
}

void appendRamps(Random& random, const Interval& in, double opacity, Points& points)
{
    const double from = random.uniform(0.0, 0.5), to = random.uniform(from + 0.1, 1.0);
    const bool falls = random.uniform() < 0.3;
    const glm::dvec4 first = random.color(falls ? opacity : 0.0);
    const glm::dvec4 last = random.color(falls ? 0.0 : opacity);
    points.push_back({in.low, first});
    points.push_back({in.at(from), first});
    points.push_back({in.at(to), last});
    points.push_back({in.high, last});
}

void appendSmooth(Random& random, const Interval& in, double opacity, Points& points)
{
    constexpr int STEPS = 40;
    const double center = random.uniform(0.2, 0.9), width = random.uniform(0.15, 0.5);
    const glm::dvec4 first = random.color(0.0), last = random.color(0.0);
    for (int i = 0; i <= STEPS; ++i) {
        const double f = i / double(STEPS), d = (f - center) / width;
        glm::dvec4 color = first + f * (last - first);
        color.a = opacity * std::exp(-0.5 * d * d);
        points.push_back({in.at(f), color});
    }
}

using Append = void (*)(Random&, const Interval&, double, Points&);
constexpr Append KINDS[] = {appendJumps, appendPeaks, appendRamps, appendSmooth};
constexpr const char* KIND_NAMES[] = {"jumps", "peaks", "ramps", "smooth", "mixture"};

Points makePoints(Random& random, int kind)
{
    const double opacity = random.logarithmic(0.003, 0.95);
    Points points;
    if (kind < 4) {
        KINDS[kind](random, {0.0, 1.0}, opacity, points);
        return points;
    }
    const int parts = random.integer(2, 4);
    double start = 0.0;
    for (int i = 1; i <= parts; ++i) {
        const double end = i == parts ? 1.0 : (i + random.uniform(-0.3, 0.3)) / parts;
        KINDS[random.integer(0, 3)](random, {start, end}, random.uniform(0.2, 1.0) * opacity,
                                    points);
        start = end;
    }
    return points;
}

std::vector<double> noise(Random& random, const glm::ivec3& size, int filters)
{
    const auto at = [&](int x, int y, int z) {
        return static_cast<std::size_t>(x + size.x * (y + size.y * z));
    };
    std::vector<double> values(at(0, 0, size.z));
    for (double& v : values)
        v = random.uniform();
    for (; filters > 0; --filters) {
        const std::vector<double> old = values;
        for (int z = 0; z < size.z; ++z)
            for (int y = 0; y < size.y; ++y)
                for (int x = 0; x < size.x; ++x) {
                    double sum = 0.0;
                    for (int c = 0; c < 27; ++c)
                        sum += old[at(std::clamp(x + c % 3 - 1, 0, size.x - 1),
                                      std::clamp(y + c / 3 % 3 - 1, 0, size.y - 1),
                                      std::clamp(z + c / 9 - 1, 0, size.z - 1))];
                    values[at(x, y, z)] = sum / 27.0;
                }
    }
    // What is filtered is still to use all of the table.
    const auto bounds = std::minmax_element(values.begin(), values.end());
    const double low = *bounds.first, high = *bounds.second;
    for (double& v : values)
        v = (v - low) / (high - low);
    return values;
}

double blob(const glm::dvec3& fromCenter)
{
    const double s = 1.0 - glm::dot(fromCenter, fromCenter);
    return s > 0.0 ? s * s : 0.0;
}

// From fractions of the range, as floats or as integers of 8 bits.
osg::ref_ptr<Voxels> voxelsOf(const glm::ivec3& size, std::vector<double> fractions, bool bytes)
{
    VoxelSource::Description description;
    description.size = size;
    description.type = bytes ? VoxelType::UINT8 : VoxelType::FLOAT32;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    source->allocate(description);
    if (bytes)
        for (double& v : fractions)
            v *= 255.0;
    const std::vector<unsigned char> values = oracle::fromDoubles(fractions, description.type);
    std::copy(values.begin(), values.end(), static_cast<unsigned char*>(source->data()));
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    voxels->setRange(osg::Vec2d(0.0, bytes ? 255.0 : 1.0));
    return voxels;
}

osg::ref_ptr<Voxels> makeField(Random& random, int kind, std::string& name)
{
    const auto edge = [&]() { return random.integer(20, 40); };
    const int x = edge(), y = edge(), z = edge();
    const glm::ivec3 size(x, y, z);
    const glm::dvec3 middle = 0.5 * glm::dvec3(size - 1);
    if (kind < 6) {
        const bool bytes = kind % 2 == 1;
        name = "noise" + std::to_string(kind / 2) + (bytes ? " bytes" : " floats");
        return voxelsOf(size, noise(random, size, kind / 2), bytes);
    }
    if (kind == 6) {
        name = "bumps";
        return makeVoxels(size, bumps);
    }
    if (kind == 7) {
        name = "blob";
        return makeVoxels(size, [&](const glm::dvec3& p) { return blob((p - middle) / middle); });
    }
    name = "waves";
    const oracle::MarschnerLobbField waves(random.uniform(1.5, 6.0));
    return makeVoxels(size,
                      [&](const glm::dvec3& p) { return waves.value((p - middle) / middle); });
}

std::vector<double> valuesOf(const Voxels& voxels)
{
    const glm::ivec3 size = voxels.getLayout().size();
    const std::size_t count = std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    const core::Box3i all{glm::ivec3(0), size};
    std::vector<unsigned char> bytes(count * (voxels.getType() == VoxelType::UINT8 ? 1 : 4));
    const Status status = voxels.getSource()->read(all, bytes.data());
    if (!status.ok()) ADD_FAILURE() << status.text;
    return oracle::toDoubles(bytes.data(), count, voxels.getType());
}

TwinVolume twinOf(Voxels* voxels, const Points& points, bool nearest)
{
    TwinVolume twin;
    twin.node = makeVolume(voxels);
    twin.node->setLookupTable(makeTable(points));
    if (nearest) twin.node->setInterpolation(VolumeAppearance::NEAREST);
    const glm::ivec3 size = voxels->getLayout().size();
    const auto grid = std::make_shared<oracle::Grid>(
        size, valuesOf(*voxels), nearest ? oracle::Grid::NEAREST : oracle::Grid::LINEAR);
    const osg::Vec2d range = voxels->getRange();
    const osg::Vec3d s = voxels->getSpacing(), o = voxels->getOrigin();
    twin.oracle = oracle::voxelVolume(grid, size, oracle::Table(points, {range.x(), range.y()}),
                                      {s.x(), s.y(), s.z()}, {o.x(), o.y(), o.z()});
    return twin;
}

// From a few radii away, so near that the volume fills most of the picture.
support::RenderOptions makeView(Random& random, const osg::BoundingSphere& bound, bool perspective)
{
    const glm::dvec3 side = random.direction(), up = random.direction();
    const double radius = bound.radius(), distance = random.uniform(1.3, 3.0) * radius;
    const osg::Vec3d center(bound.center());
    const auto options = support::RenderOptions()
                             .size(PICTURE, PICTURE)
                             .lookAt(center + osg::Vec3d(side.x, side.y, side.z) * distance, center,
                                     {up.x, up.y, up.z});
    const double seen = 0.7 * radius;
    return perspective ? support::RenderOptions(options).perspective(
                             osg::RadiansToDegrees(2.0 * std::atan(seen / distance)))
                       : support::RenderOptions(options).orthographic(seen);
}

// The part of the picture that shows something.
double coverage(const PromiseCase& c)
{
    double least = 1.0;
    for (const support::RenderOptions& options : c.views) {
        support::RenderOptions coarse = options;
        coarse.size(PICTURE / 4, PICTURE / 4);
        const support::FloatImage image = oraclePicture(oracleScene(c.twin.oracle), coarse);
        least = std::min(least, double(support::coveredPixels(image, 1e-3f).count()) /
                                    double(image.pixels.size()));
    }
    return least;
}

} // namespace
} // namespace promise

PromiseCase makePromiseCase(int number)
{
    // Remainders by numbers without common factors meet in all ways.
    promise::Random random(number + 1);
    PromiseCase c;
    c.number = number;
    osg::ref_ptr<Voxels> voxels;
    const bool head = number % 15 == 7;
    if (head) {
        c.field = "head";
        voxels = *readVoxels(OSGVOLUMIZER_SOURCE_DIR "/data/head.tif");
    } else {
        voxels = promise::makeField(random, number % 9, c.field);
    }
    const bool nearest = number % 23 == 3;
    if (nearest) c.field += ", nearest";
    if (number % 11 < 3) {
        const double x = random.logarithmic(0.4, 2.5), y = random.logarithmic(0.4, 2.5),
                     z = random.logarithmic(0.4, 2.5);
        voxels->setSpacing({x, y, z});
        c.field += ", stretched";
    }
    if (number % 7 == 2) {
        const int brick = head ? random.integer(40, 70) : random.integer(9, 20);
        voxels->setBrickSize({brick, brick, brick});
        c.field += ", bricks";
    }
    // A table that shows nothing tells nothing: another is then drawn.
    do {
        Points points;
        if (head && number % 2 == 1 && number < 100) {
            c.table = "head.lut";
            const auto table = readLookupTable(OSGVOLUMIZER_SOURCE_DIR "/data/head.lut");
            points = (*table)->getNormalizedFunction(voxels->getRange())->points();
        } else {
            const int kind = number % 5;
            c.table = promise::KIND_NAMES[kind];
            points = promise::makePoints(random, kind);
        }
        c.twin = promise::twinOf(voxels, points, nearest);
        c.views.clear();
        for (const bool perspective : {true, true, false})
            c.views.push_back(promise::makeView(random, c.twin.node->getBound(), perspective));
    } while (promise::coverage(c) < 0.1);
    return c;
}

} // namespace test
} // namespace osgVolumizer
