#include "SampleChunk.h"

#include "../../core/voxels/VoxelDispatch.h"

#include <glm/common.hpp>

#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

namespace osgVolumizer {
namespace picking {

namespace {

template <class T>
void fetchAs(const void* data, const std::int64_t* indices, int count, int stride, int component,
             double* values)
{
    using Number = std::conditional_t<std::is_same<T, core::Half>::value, float, T>;
    const T* samples = static_cast<const T*>(data) + component;
    for (int i = 0; i < count; ++i)
        values[i] = static_cast<double>(Number(samples[indices[i] * stride]));
}

bool canHaveHoles(VoxelType type)
{
    return type == VoxelType::HALF || type == VoxelType::FLOAT32 || type == VoxelType::FLOAT64;
}

/// Cells without a finite value show nothing, though they are filled.
void keepEmptyCells(const core::CellGrid& raw, core::CellGrid& filled)
{
    for (std::size_t i = 0; i < raw.cellCount(); ++i)
        if (!(raw.low[i] <= raw.high[i])) {
            filled.low[i] = raw.low[i];
            filled.high[i] = raw.high[i];
        }
}

} // namespace

SampleChunk::SampleChunk(VoxelBlock block, const core::VoxelView& view, const core::Box3i& samples,
                         int component, double lowest, std::size_t ownBytes)
    : _block(std::move(block)), _raw(view), _view(view), _samples(samples), _component(component),
      _ownBytes(ownBytes)
{
    _fetch =
        core::visitVoxelType(view.type, [](auto tag) -> Fetch { return fetchAs<decltype(tag)>; });
    if (view.data && canHaveHoles(view.type)) fillHoles(lowest);
}

void SampleChunk::fillHoles(double lowest)
{
    const std::int64_t voxels = core::sampleCount(_raw.size);
    const std::size_t value = voxelTypeSize(_raw.type);
    unsigned char fill[8];
    core::convertVoxels(&lowest, VoxelType::FLOAT64, fill, _raw.type, 1);
    unsigned char* filled = nullptr;
    bool any = false;
    for (std::int64_t i = 0; i < voxels; ++i)
        for (int c = 0; c < _raw.components; ++c) {
            double v;
            _fetch(_raw.data, &i, 1, _raw.components, c, &v);
            if (std::isfinite(v)) {
                any = any || c == _component;
                continue;
            }
            if (!filled) {
                std::shared_ptr<unsigned char> copy(new unsigned char[_block.bytes],
                                                    std::default_delete<unsigned char[]>());
                std::memcpy(copy.get(), _block.data, _block.bytes);
                filled = copy.get();
                _filled = {copy, filled, _block.bytes};
                _view.data = filled;
                _ownBytes += _block.bytes;
            }
            std::memcpy(filled + static_cast<std::size_t>(i * _raw.components + c) * value, fill,
                        value);
        }
    if (!any) _view.data = nullptr;
}

void SampleChunk::fetch(const std::int64_t* indices, int count, int component, double* values) const
{
    _fetch(_view.data, indices, count, _view.components, component, values);
}

bool SampleChunk::update(const std::vector<core::Box3i>& changed, bool shared, const Read& read)
{
    if (!_raw.data || _filled) return false;
    if (!shared) makeOwn();
    for (const core::Box3i& box : changed) {
        const VoxelBlock samples = read(box);
        if (!samples || !replace(box, samples)) return false;
    }
    updateCells(changed);
    return true;
}

// A block that nobody else has.
void SampleChunk::makeOwn()
{
    if (_ownBytes > 0 && _block.owner.use_count() == 1) return;
    std::shared_ptr<unsigned char> copy(new unsigned char[_block.bytes],
                                        std::default_delete<unsigned char[]>());
    std::memcpy(copy.get(), _block.data, _block.bytes);
    _block = {copy, copy.get(), _block.bytes};
    _raw.data = _view.data = copy.get();
    _ownBytes = _block.bytes;
}

// False where there are holes among new samples. The source's own memory has these already.
bool SampleChunk::replace(const core::Box3i& box, const VoxelBlock& samples)
{
    const core::Box3i inside{box.min - _samples.min, box.max - _samples.min};
    const std::int64_t count = core::sampleCount(box.size());
    double v;
    if (canHaveHoles(_raw.type))
        for (std::int64_t i = 0; i < count; ++i)
            for (int c = 0; c < _raw.components; ++c) {
                _fetch(samples.data, &i, 1, _raw.components, c, &v);
                if (!std::isfinite(v)) return false;
            }
    if (_ownBytes > 0)
        core::pasteRegion(samples.data, inside, _raw.type, _raw.components, _raw.size,
                          const_cast<unsigned char*>(_block.data));
    return true;
}

void SampleChunk::updateCells(const std::vector<core::Box3i>& changed)
{
    std::lock_guard<std::mutex> lock(_mutex);
    const core::Box3i all{glm::ivec3(0), _raw.size};
    std::vector<core::Box3i> inside = changed;
    for (core::Box3i& box : inside)
        box = {box.min - _samples.min, box.max - _samples.min};
    for (const auto support : {core::FilterSupport::LINEAR, core::FilterSupport::CUBIC}) {
        core::CellGrid& grid = _cells[static_cast<int>(support)];
        if (grid.cellCount() == 0) continue;
        for (const std::size_t cell : core::cellsTouching(grid, support, inside))
            core::setCellRange(
                grid, cell,
                core::scanRange(_view, core::cellSamples(grid, cell, support, all), _component));
    }
}

double SampleChunk::rawSample(const glm::ivec3& place, int component) const
{
    if (!_raw.data) return std::numeric_limits<double>::quiet_NaN();
    const glm::ivec3 p = glm::clamp(place - _samples.min, glm::ivec3(0), _raw.size - 1);
    const std::int64_t index =
        p.x + std::int64_t(_raw.size.x) * (p.y + std::int64_t(_raw.size.y) * p.z);
    double value;
    _fetch(_raw.data, &index, 1, _raw.components, component, &value);
    return value;
}

const core::CellGrid& SampleChunk::cells(bool wide) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    core::CellGrid& grid = _cells[wide ? 1 : 0];
    if (grid.cellCount() > 0) return grid;
    const auto support = wide ? core::FilterSupport::CUBIC : core::FilterSupport::LINEAR;
    grid = core::scanCells(_view, CELL, glm::dvec3(0.0), support, _component);
    if (_filled)
        keepEmptyCells(core::scanCells(_raw, CELL, glm::dvec3(0.0), support, _component), grid);
    return grid;
}

} // namespace picking
} // namespace osgVolumizer
