#include "PyramidSource.h"

#include "../core/RegularFile.h"
#include "../core/voxels/VoxelData.h"
#include "OiioTypes.h"
#include "VoxelFiles.h"

#include <algorithm>
#include <cstring>
#include <exception>

namespace osgVolumizer {
namespace io {

namespace {

constexpr int STEP = PyramidFormat::STEP, TILE = PyramidFormat::TILE,
              TILE_PIXELS = PyramidFormat::TILE_PIXELS;

std::unique_ptr<OIIO::ImageInput> openInput(const std::string& path)
{
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1); // keeps straight alpha
    return OIIO::ImageInput::open(path, &config);
}

// The samples that a brick of the file has, some of which there are none of.
core::Box3i samplesOf(const glm::ivec3& brick)
{
    return {brick * STEP - PyramidFormat::BORDER, brick * STEP - PyramidFormat::BORDER + TILE};
}

bool holds(const core::Box3i& outer, const core::Box3i& inner)
{
    for (int axis = 0; axis < 3; ++axis)
        if (inner.min[axis] < outer.min[axis] || inner.max[axis] > outer.max[axis]) return false;
    return true;
}

// Writes the part of a region that a brick of the file has.
void copyPart(const std::vector<unsigned char>& tile, const core::Box3i& tileBox,
              const core::Box3i& part, const core::Box3i& region, std::size_t voxel,
              unsigned char* destination)
{
    const glm::ivec3 size = region.size();
    const auto bytes = std::size_t(part.size().x) * voxel;
    for (int z = part.min.z; z < part.max.z; ++z)
        for (int y = part.min.y; y < part.max.y; ++y) {
            const glm::ivec3 from = glm::ivec3(part.min.x, y, z) - tileBox.min;
            const glm::ivec3 to = glm::ivec3(part.min.x, y, z) - region.min;
            std::memcpy(destination +
                            ((std::size_t(to.z) * size.y + to.y) * size.x + std::size_t(to.x)) *
                                voxel,
                        tile.data() + ((std::size_t(from.z) * TILE + std::size_t(from.y)) * TILE +
                                       std::size_t(from.x)) *
                                          voxel,
                        bytes);
        }
}

// The bricks of a level that hold the samples of a region as their own.
core::Box3i bricksOf(const core::BrickTree& tree, int level, const core::Box3i& region)
{
    core::Box3i bricks;
    for (int axis = 0; axis < 3; ++axis) {
        const int last = tree.count(level)[axis] - 1;
        bricks.min[axis] = std::clamp(region.min[axis] / STEP, 0, last);
        bricks.max[axis] = std::clamp((region.max[axis] - 1) / STEP, 0, last) + 1;
    }
    return bricks;
}

// The bricks that a region is read from: one where that has all of it, as of what a renderer asks
// for.
core::Box3i bricksToRead(const core::BrickTree& tree, int level, const core::Box3i& region)
{
    const glm::ivec3 middle = (region.min + region.max) / 2;
    const core::Box3i one = bricksOf(tree, level, {middle, middle + 1});
    return holds(samplesOf(one.min), region) ? one : bricksOf(tree, level, region);
}

} // namespace

/// Open inputs of a file: one for each thread that reads at a time.
class PyramidSource::Files
{
public:
    explicit Files(std::string path) : _path(std::move(path)) {}

    std::unique_ptr<OIIO::ImageInput> take()
    {
        {
            std::lock_guard<std::mutex> lock(_mutex);
            if (!_idle.empty()) {
                std::unique_ptr<OIIO::ImageInput> input = std::move(_idle.back());
                _idle.pop_back();
                return input;
            }
        }
        return openInput(_path);
    }
    void giveBack(std::unique_ptr<OIIO::ImageInput> input)
    {
        std::lock_guard<std::mutex> lock(_mutex);
        _idle.push_back(std::move(input));
    }

private:
    const std::string _path;
    std::mutex _mutex;
    std::vector<std::unique_ptr<OIIO::ImageInput>> _idle;
};

PyramidSource::PyramidSource(const PyramidSource& o, const osg::CopyOp& op)
    : VoxelSource(o, op), _path(o._path), _format(o._format), _tree(o._tree),
      _pageCount(o._pageCount), _ranges(o._ranges), _files(o._files)
{
}

bool PyramidSource::isPyramid(const std::string& path)
{
    if (!core::requireRegularFile(path).ok()) return false;
    try {
        const auto input = openInput(path);
        OIIO::geterror();
        return input && PyramidFormat::isPyramid(
                            std::string(input->spec().get_string_attribute("ImageDescription")));
    } catch (const std::exception&) {
        return false;
    }
}

std::string PyramidSource::reason(OIIO::ImageInput& input) const
{
    const std::string text = oneLine(input.geterror());
    return text.empty() ? "" : ": " + text;
}

Status PyramidSource::open(const std::string& path, bool whole)
{
    _path = path;
    if (Status status = core::requireRegularFile(path); !status.ok()) return status;
    try {
        const auto input = openInput(path);
        if (!input)
            return {ErrorCode::FILE_UNREADABLE, path + " cannot be read: " + OIIO::geterror()};
        const Result<PyramidFormat> format = PyramidFormat::parse(
            std::string(input->spec().get_string_attribute("ImageDescription")));
        if (!format.ok()) return {format.status.code, path + ": " + format.status.text};
        _format = *format;
        const Result<core::BrickTree> tree = _format.tree();
        if (!tree.ok()) return {tree.status.code, path + ": " + tree.status.text};
        _tree = *tree;
        Status status = openPages(*input, whole);
        if (!status.ok()) return {status.code, path + ": " + status.text};
        _files = std::make_shared<Files>(path);
        return {};
    } catch (const std::exception& e) {
        return {ErrorCode::FILE_UNREADABLE, path + " cannot be read: " + e.what()};
    }
}

Status PyramidSource::openPages(OIIO::ImageInput& input, bool whole)
{
    _pageCount = 0;
    for (int level = 0; level < _tree.levelCount(); ++level)
        for (int layer = 0; layer < _tree.count(level).z; ++layer)
            for (const bool ranges : {false, true}) {
                if (!input.seek_subimage(_pageCount, 0)) {
                    OIIO::geterror();
                    if (!whole) return {};
                    return {ErrorCode::FILE_UNREADABLE,
                            "the pyramid is cut short: it has " + std::to_string(_pageCount) +
                                " pages of " +
                                std::to_string(2 * PyramidFormat::layerCount(_tree))};
                }
                const Status status =
                    ranges ? readRanges(input, level, layer) : checkPage(input, level, layer);
                if (!status.ok()) return status;
                ++_pageCount;
            }
    return {};
}

Status PyramidSource::checkPage(OIIO::ImageInput& input, int level, int layer) const
{
    const OIIO::ImageSpec& spec = input.spec();
    const glm::ivec3 count = _tree.count(level);
    if (spec.width == std::int64_t(count.x) * TILE_PIXELS &&
        spec.height == std::int64_t(count.y) * TILE_PIXELS && spec.tile_width == TILE_PIXELS &&
        spec.tile_height == TILE_PIXELS && spec.nchannels == _format.description.components &&
        spec.format == typeDescOf(_format.description.type))
        return {};
    return {ErrorCode::FILE_UNREADABLE, "the page of layer " + std::to_string(layer) +
                                            " of level " + std::to_string(level) +
                                            " is not what the header says"};
}

Status PyramidSource::readRanges(OIIO::ImageInput& input, int level, int layer)
{
    const OIIO::ImageSpec& spec = input.spec();
    const glm::ivec3 count = _tree.count(level);
    if (spec.width != count.x || spec.height != count.y || spec.nchannels != 2)
        return {ErrorCode::FILE_UNREADABLE, "the ranges of layer " + std::to_string(layer) +
                                                " of level " + std::to_string(level) +
                                                " are not what the header says"};
    std::vector<float> values(2 * std::size_t(count.x) * std::size_t(count.y));
    if (!input.read_image(_pageCount, 0, 0, 2, OIIO::TypeDesc::FLOAT, values.data()))
        return {ErrorCode::FILE_UNREADABLE, "the ranges of layer " + std::to_string(layer) +
                                                " of level " + std::to_string(level) +
                                                " cannot be read" + reason(input)};
    const std::int64_t first = _tree.index(level, {0, 0, layer});
    _ranges.resize(std::size_t(first) + values.size() / 2);
    for (std::size_t i = 0; i < values.size() / 2; ++i)
        _ranges[std::size_t(first) + i] = {values[2 * i], values[2 * i + 1]};
    return {};
}

// All of a brick's samples, x fastest.
Status PyramidSource::readBrick(int level, const glm::ivec3& brick, void* samples) const
{
    const VoxelSource::Description& d = _format.description;
    const auto voxel = voxelTypeSize(d.type) * std::size_t(d.components);
    std::vector<unsigned char> tile(std::size_t(TILE_PIXELS) * TILE_PIXELS * voxel);
    std::unique_ptr<OIIO::ImageInput> input = _files->take();
    if (!input) return {ErrorCode::FILE_UNREADABLE, _path + " cannot be read"};
    const int page = 2 * PyramidFormat::pairOf(_tree, level, brick.z);
    const int x = brick.x * TILE_PIXELS, y = brick.y * TILE_PIXELS;
    if (!input->read_tiles(page, 0, x, x + TILE_PIXELS, y, y + TILE_PIXELS, 0, 1, 0, d.components,
                           typeDescOf(d.type), tile.data()))
        return {ErrorCode::FILE_UNREADABLE, _path + " cannot be read" + reason(*input)};
    _files->giveBack(std::move(input));
    auto* out = static_cast<unsigned char*>(samples);
    for (int z = 0; z < TILE; ++z)
        for (int row = 0; row < TILE; ++row, out += TILE * voxel) {
            const int column = z % PyramidFormat::MOSAIC * TILE;
            const int line = z / PyramidFormat::MOSAIC * TILE + row;
            std::memcpy(
                out, tile.data() + (std::size_t(line) * TILE_PIXELS + std::size_t(column)) * voxel,
                TILE * voxel);
        }
    return {};
}

Status PyramidSource::readLevel(int level, const core::Box3i& region, void* destination) const
{
    if (!_files) return {ErrorCode::VALUE_INVALID, "the voxel source has no file"};
    if (region.empty()) return {};
    if (level < 0 || level >= _tree.levelCount())
        return VoxelSource::readLevel(level, region, destination);
    const glm::ivec3 size = core::BrickTree::levelSize(_tree.size(), level);
    if (Status status = checkRegion(region, size); !status.ok()) return status;
    const VoxelSource::Description& d = _format.description;
    const auto voxel = voxelTypeSize(d.type) * std::size_t(d.components);
    auto* out = static_cast<unsigned char*>(destination);
    std::vector<unsigned char> tile(std::size_t(TILE) * TILE * TILE * voxel);
    const core::Box3i bricks = bricksToRead(_tree, level, region);
    const bool one = core::sampleCount(bricks.size()) == 1;
    for (int k = bricks.min.z; k < bricks.max.z; ++k)
        for (int j = bricks.min.y; j < bricks.max.y; ++j)
            for (int i = bricks.min.x; i < bricks.max.x; ++i) {
                const glm::ivec3 brick(i, j, k);
                if (Status status = readBrick(level, brick, tile.data()); !status.ok())
                    return status;
                // Its own samples; the last brick also has the ones beyond, the first the one
                // before.
                core::Box3i part = region;
                for (int axis = 0; axis < 3 && !one; ++axis) {
                    const bool last = brick[axis] + 1 == _tree.count(level)[axis];
                    part.min[axis] = std::max(part.min[axis], brick[axis] * STEP);
                    if (!last) part.max[axis] = std::min(part.max[axis], (brick[axis] + 1) * STEP);
                }
                copyPart(tile, samplesOf(brick), part, region, voxel, out);
            }
    return {};
}

std::optional<std::pair<double, double>> PyramidSource::levelRange(int level,
                                                                   const core::Box3i& region) const
{
    if (region.empty() || level < 0 || level >= _tree.levelCount()) return std::nullopt;
    const core::Box3i bricks = bricksToRead(_tree, level, region);
    core::ValueRange range;
    for (int k = bricks.min.z; k < bricks.max.z; ++k)
        for (int j = bricks.min.y; j < bricks.max.y; ++j)
            for (int i = bricks.min.x; i < bricks.max.x; ++i) {
                const auto index = std::size_t(_tree.index(level, {i, j, k}));
                if (index >= _ranges.size()) return std::nullopt;
                if (_ranges[index].first <= _ranges[index].second)
                    range.expand({_ranges[index].first, _ranges[index].second});
            }
    return std::make_pair(range.low, range.high);
}

Result<Source> readPyramid(const std::string& path)
{
    osg::ref_ptr<PyramidSource> source = new PyramidSource;
    if (Status status = source->open(path); !status.ok()) return status;
    return Source(source.get());
}

} // namespace io
} // namespace osgVolumizer
