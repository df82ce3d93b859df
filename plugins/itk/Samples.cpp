#include "Samples.h"

#include <osgVolumizer/VoxelSeries.h>
#include <osgVolumizer/core/voxels/VoxelData.h>
#include <osgVolumizer/io/Brightness.h>
#include <osgVolumizer/io/NarrowestType.h>
#include <osgVolumizer/io/Placement.h>

#include <osg/Notify>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <vector>

namespace osgVolumizer {
namespace medical {

namespace {

using Memory = osg::ref_ptr<MemoryVoxelSource>;

/// What becomes of a sample.
struct Plan
{
    VoxelType type = VoxelType::UINT8;
    int components = 1, first = 0;
    bool luminance = false;
    bool asItIs = false; ///< the numbers are the voxels
};

template <class Function>
auto visitNumber(Number number, Function&& function)
{
    switch (number) {
    case Number::INT8:
        return function(std::int8_t());
    case Number::INT16:
        return function(std::int16_t());
    case Number::UINT16:
        return function(std::uint16_t());
    case Number::INT32:
        return function(std::int32_t());
    case Number::UINT32:
        return function(std::uint32_t());
    case Number::INT64:
        return function(std::int64_t());
    case Number::UINT64:
        return function(std::uint64_t());
    case Number::FLOAT32:
        return function(float());
    case Number::FLOAT64:
        return function(double());
    case Number::UINT8:
        break;
    }
    return function(std::uint8_t());
}

bool isInteger(Number number)
{
    return number != Number::FLOAT32 && number != Number::FLOAT64;
}

VoxelType nativeType(Number number)
{
    constexpr VoxelType TYPES[] = {VoxelType::INT8,    VoxelType::UINT8,   VoxelType::INT16,
                                   VoxelType::UINT16,  VoxelType::INT32,   VoxelType::UINT32,
                                   VoxelType::FLOAT64, VoxelType::FLOAT64, VoxelType::FLOAT32,
                                   VoxelType::FLOAT64};
    return TYPES[static_cast<int>(number)];
}

/// Reads values of one step, calibrated.
class Values
{
public:
    Values(const Samples& samples, int step) : _s(samples), _step(step)
    {
        _count = static_cast<std::size_t>(core::sampleCount(samples.size));
    }
    std::size_t count() const { return _count; }
    template <class T>
    double at(std::size_t voxel, int channel) const
    {
        const auto step = static_cast<std::size_t>(_step), c = static_cast<std::size_t>(channel);
        const std::size_t index =
            _s.planar ? (c * static_cast<std::size_t>(_s.steps) + step) * _count + voxel
                      : (step * _count + voxel) * static_cast<std::size_t>(_s.channels) + c;
        T value;
        std::memcpy(&value, _s.data.get() + index * sizeof(T), sizeof(T));
        return _s.slope * static_cast<double>(value) + _s.intercept;
    }
    template <class T>
    double of(std::size_t voxel, const Plan& plan, int component) const
    {
        if (!plan.luminance) return at<T>(voxel, plan.first + component);
        const double rgb[3] = {at<T>(voxel, 0), at<T>(voxel, 1), at<T>(voxel, 2)};
        return io::brightness(rgb, 3);
    }

private:
    const Samples& _s;
    int _step;
    std::size_t _count;
};

core::ValueRange rangeOf(const Samples& samples, const Plan& plan)
{
    core::ValueRange range;
    for (int step = 0; step < samples.steps; ++step)
        visitNumber(samples.number, [&](auto tag) {
            const Values values(samples, step);
            for (std::size_t i = 0; i < values.count(); ++i)
                for (int c = 0; c < plan.components; ++c) {
                    const double v = values.of<decltype(tag)>(i, plan, c);
                    range.expand({v, v});
                }
        });
    return range;
}

VoxelType typeFor(const Samples& s, const Plan& plan)
{
    const bool scaled = s.slope != 1.0 || s.intercept != 0.0;
    const bool whole = s.slope == std::round(s.slope) && s.intercept == std::round(s.intercept);
    if (!isInteger(s.number)) return nativeType(s.number);
    if (scaled && !whole) return VoxelType::FLOAT32;
    if (scaled || numberSize(s.number) == 8)
        return io::narrowestInteger(rangeOf(s, plan), VoxelType::FLOAT64);
    return nativeType(s.number);
}

Result<Plan> planFor(const Samples& s, const io::VolumeRequest& request)
{
    Plan plan;
    if (request.channel && *request.channel >= s.channels)
        return Status(ErrorCode::INDEX_OUT_OF_RANGE,
                      request.path + " has no channel " + std::to_string(*request.channel) +
                          ", but " + std::to_string(s.channels) + ", from 0 on");
    plan.first = request.channel.value_or(0);
    if (!request.channel && s.colour) {
        plan.components = s.channels == 4 ? 4 : 1;
        plan.luminance = s.channels == 3;
    } else if (!request.channel && s.channels > 1) {
        OSG_NOTICE << "osgVolumizer: " << request.path << ": of " << s.channels
                   << " numbers per sample the first is taken; channel= chooses another"
                   << std::endl;
    }
    plan.type = typeFor(s, plan);
    const bool wide = s.number == Number::INT64 || s.number == Number::UINT64;
    plan.asItIs = !wide && plan.type == nativeType(s.number) && s.slope == 1.0 &&
                  s.intercept == 0.0 && !plan.luminance &&
                  (s.planar ? plan.components == 1 : s.channels == plan.components);
    return plan;
}

void convert(const Samples& s, const Plan& plan, int step, MemoryVoxelSource& to)
{
    constexpr std::size_t PIECE = 4096;
    const std::size_t bytes = voxelTypeSize(plan.type);
    const auto components = static_cast<std::size_t>(plan.components);
    std::vector<double> piece(PIECE * components);
    visitNumber(s.number, [&](auto tag) {
        const Values values(s, step);
        for (std::size_t done = 0; done < values.count(); done += PIECE) {
            const std::size_t count = std::min(PIECE, values.count() - done);
            for (std::size_t i = 0; i < count * components; ++i)
                piece[i] = values.of<decltype(tag)>(done + i / components, plan,
                                                    static_cast<int>(i % components));
            core::convertVoxels(piece.data(), VoxelType::FLOAT64,
                                static_cast<char*>(to.data()) + done * components * bytes,
                                plan.type, count * components);
        }
    });
}

Result<Memory> stepOf(const Samples& s, const Plan& plan, VoxelSource::Description d, int step)
{
    Memory source = new MemoryVoxelSource;
    const CallerReports quiet;
    if (!plan.asItIs) {
        if (Status status = source->allocate(d); !status.ok()) return status;
        convert(s, plan, step, *source);
        return source;
    }
    const auto index = static_cast<std::size_t>(s.planar ? plan.first * s.steps + step : step);
    char* data = s.data.get() + index * static_cast<std::size_t>(d.sizeInBytes());
    Status status = source->setExternal(d, data, [owner = s.data] { (void)owner; });
    if (!status.ok()) return status;
    return source;
}

} // namespace

std::size_t numberSize(Number number)
{
    return visitNumber(number, [](auto tag) { return sizeof(tag); });
}

std::int64_t Samples::bytes() const
{
    const double all =
        double(numberSize(number)) * size.x * double(size.y) * size.z * steps * double(channels);
    constexpr double MOST = 9e18;
    return all > MOST ? static_cast<std::int64_t>(MOST)
                      : core::voxelBytes(size, VoxelType::UINT8, 1) * steps * channels *
                            static_cast<std::int64_t>(numberSize(number));
}

Status Samples::allocate()
{
    const std::int64_t count = bytes();
    char* memory = nullptr;
    if (count <= MemoryVoxelSource::DEFAULT_MAXIMUM_BYTES)
        memory = new (std::nothrow) char[static_cast<std::size_t>(count)];
    if (!memory)
        return {ErrorCode::TOO_LARGE,
                "needs " + std::to_string(count) + " bytes, more than there may be in memory"};
    data = std::shared_ptr<char>(memory, std::default_delete<char[]>());
    return {};
}

Result<io::Source> sourceOf(const Samples& s, const io::VolumeRequest& request)
{
    const Result<Plan> plan = planFor(s, request);
    if (!plan.ok()) return plan.status;
    VoxelSource::Description d;
    d.size = s.size;
    d.type = plan->type;
    d.components = plan->components;
    Status status = io::place(d, s.axes, s.position);
    std::vector<osg::ref_ptr<VoxelSource>> steps;
    for (int i = 0; status.ok() && i < s.steps; ++i) {
        const Result<Memory> step = stepOf(s, *plan, d, i);
        status = step.status;
        if (step.ok()) steps.push_back(step->get());
    }
    if (!status.ok()) return Status(status.code, request.path + ": " + status.text);
    if (steps.size() == 1) return io::Source(steps.front());
    osg::ref_ptr<VoxelSeries> series = new VoxelSeries;
    const CallerReports quiet;
    status = series->setSteps(steps);
    if (!status.ok()) return Status(status.code, request.path + ": " + status.text);
    return io::Source(series.get());
}

} // namespace medical
} // namespace osgVolumizer
