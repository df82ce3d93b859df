#pragma once

// Scenes of voxels that are paged, from a formula, and how to wait for their pages.

#include "Volumes.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace osgVolumizer {
namespace test {
namespace paged {

using support::FloatImage;
using support::RenderOptions;

constexpr int PAGE = 16; // edge of a page, in samples

// Samples of a function, whose levels are its values at their places: what a smooth function's
// means are, nearly.
class FormulaSource : public VoxelSource
{
public:
    using Function = std::function<double(const glm::dvec3&)>;
    using FunctionOfTime = std::function<double(const glm::dvec3&, int step)>;

    FormulaSource(int size, Function value, VoxelType type = VoxelType::FLOAT32)
        : _value(std::move(value))
    {
        _description.size = glm::ivec3(size);
        _description.type = type;
    }
    FormulaSource(int size, int steps, FunctionOfTime value, VoxelType type = VoxelType::FLOAT32)
        : FormulaSource(size, Function(), type)
    {
        _steps = steps;
        _valueOfStep = std::move(value);
    }
    META_Object(osgVolumizer, FormulaSource);
    FormulaSource() = default;
    FormulaSource(const FormulaSource& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY)
        : VoxelSource(o, op), _description(o._description), _value(o._value),
          _valueOfStep(o._valueOfStep), _steps(o._steps)
    {
    }

    Description describe() const override { return _description; }
    int levelCount() const override { return core::BrickTree::levelsFor(_description.size, page); }
    int pageSize() const override { return page; }
    Status read(const core::Box3i& region, void* destination) const override
    {
        return readLevel(0, region, destination);
    }
    Status readLevel(int level, const core::Box3i& region, void* destination) const override
    {
        return readStep(0, level, region, destination);
    }
    int stepCount() const override { return _steps; }
    Status readStep(int step, int level, const core::Box3i& region,
                    void* destination) const override
    {
        if (level < int(reads.size())) ++reads[std::size_t(level)];
        {
            std::unique_lock<std::mutex> lock(_mutex);
            ++_waiting;
            _changed.notify_all();
            _changed.wait(lock, [&] { return level >= _open && _given != 0; });
            --_waiting;
            if (_given > 0) --_given;
        }
        if (failEvery > 0 && ++_calls % failEvery == 0)
            return {ErrorCode::FILE_UNREADABLE, "the disk is dead"};
        if (level < failBelow) return {ErrorCode::FILE_UNREADABLE, "the disk is dead"};
        std::vector<double> values;
        const double spacing = 1 << level, offset = 0.5 * (spacing - 1.0);
        const double top = _description.type == VoxelType::UINT8 ? 255.0 : 1.0;
        for (int z = region.min.z; z < region.max.z; ++z)
            for (int y = region.min.y; y < region.max.y; ++y)
                for (int x = region.min.x; x < region.max.x; ++x)
                    values.push_back(top * valueAt(spacing * glm::dvec3(x, y, z) + offset, step));
        const auto bytes = oracle::fromDoubles(values, _description.type);
        std::copy(bytes.begin(), bytes.end(), static_cast<unsigned char*>(destination));
        return {};
    }
    std::optional<std::pair<double, double>> levelRange(int level,
                                                        const core::Box3i& region) const override
    {
        if (range) return range(level, region);
        return std::nullopt;
    }
    std::optional<std::pair<double, double>> valueRange(const core::Box3i& region) const override
    {
        return levelRange(0, region);
    }

    // Levels below `level` are answered only once this is called again.
    void openFrom(int level) const
    {
        std::lock_guard<std::mutex> lock(_mutex);
        _open = level;
        _changed.notify_all();
    }
    // From now on no more reads than these are answered, in addition to those given before.
    void give(int count) const
    {
        std::lock_guard<std::mutex> lock(_mutex);
        _given = std::max(_given, 0) + count;
        _changed.notify_all();
    }
    void giveAll() const
    {
        std::lock_guard<std::mutex> lock(_mutex);
        _given = -1;
        _changed.notify_all();
    }
    void waitForReader() const
    {
        std::unique_lock<std::mutex> lock(_mutex);
        _changed.wait_for(lock, std::chrono::seconds(200), [&] { return _waiting > 0; });
    }

    mutable std::array<std::atomic<int>, 8> reads{}; // by level
    int page = PAGE;                                 // to be set before voxels are made of it
    int failEvery = 0;
    std::atomic<int> failBelow{0};
    std::function<std::optional<std::pair<double, double>>(int, const core::Box3i&)> range;

private:
    double valueAt(const glm::dvec3& p, int step) const
    {
        return _valueOfStep ? _valueOfStep(p, step) : _value(p);
    }

    Description _description;
    Function _value;
    FunctionOfTime _valueOfStep;
    int _steps = 1;
    mutable std::mutex _mutex;
    mutable std::condition_variable _changed;
    mutable int _open = 0, _waiting = 0, _given = -1;
    mutable std::atomic<int> _calls{0};
};

// Of all levels.
inline int readsOf(const FormulaSource& source)
{
    int sum = 0;
    for (const auto& level : source.reads)
        sum += level;
    return sum;
}

// Smooth, and with something everywhere.
inline double waves(const glm::dvec3& p)
{
    return 0.5 + 0.2 * std::sin(0.11 * p.x) + 0.2 * std::cos(0.07 * p.y + 0.05 * p.z);
}

inline RenderOptions viewOf(double size, const osg::Vec3d& eye)
{
    const double middle = 0.5 * (size - 1.0);
    return RenderOptions().size(96, 80).perspective(40.0).lookAt(
        eye, osg::Vec3d(middle, middle, middle), {0, 0, 1});
}

inline osg::ref_ptr<VolumeAppearance> volumeOf(VoxelSource* source)
{
    const osg::ref_ptr<Voxels> voxels = new Voxels(source);
    if (voxels->getType() == VoxelType::FLOAT32) voxels->setRange(osg::Vec2d(0.0, 1.0));
    const osg::ref_ptr<VolumeAppearance> volume = makeVolume(voxels);
    volume->setLookupTable(makeTable(smoothPoints(0.05)));
    return volume;
}

inline std::size_t covered(const FloatImage& picture)
{
    return support::coveredPixels(picture).count();
}

inline double secondsSince(std::chrono::steady_clock::time_point start)
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Draws frames until a condition holds of one; the last picture. Only what never ends takes as long
// as the limit.
inline FloatImage renderUntil(support::SceneRenderer& renderer,
                              const std::function<bool(const FloatImage&)>& condition)
{
    constexpr double LIMIT = 200.0; // seconds
    const auto start = std::chrono::steady_clock::now();
    FloatImage picture = renderer.render();
    while (!condition(picture) && secondsSince(start) < LIMIT) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        picture = renderer.render();
    }
    return picture;
}

// Until nothing is missing.
inline FloatImage settle(support::SceneRenderer& renderer)
{
    return renderUntil(renderer, [&renderer](const FloatImage&) {
        return renderer.counters()["osgVolumizer pages missing"] == 0.0;
    });
}

inline double largest(const FloatImage& a, const FloatImage& b)
{
    return support::compare(a, b, support::coveredPixels(a) | support::coveredPixels(b)).maximum;
}

} // namespace paged
} // namespace test
} // namespace osgVolumizer
