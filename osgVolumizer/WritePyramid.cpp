#include "WritePyramid.h"

#include "core/RegularFile.h"
#include "core/voxels/VoxelData.h"
#include "io/MovedSource.h"
#include "io/OiioTypes.h"
#include "io/PartFile.h"
#include "io/PyramidSource.h"

#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <exception>
#include <fstream>
#include <limits>
#include <vector>

namespace osgVolumizer {

namespace {

using io::PyramidFormat;
constexpr int STEP = PyramidFormat::STEP, BORDER = PyramidFormat::BORDER,
              TILE = PyramidFormat::TILE, MOSAIC = PyramidFormat::MOSAIC,
              TILE_PIXELS = PyramidFormat::TILE_PIXELS;

// Of samples that are held at a time.
constexpr std::int64_t BUFFER_BYTES = 48 << 20;

// The header of an empty BigTIFF, to which pages are appended: OpenImageIO makes the other kind,
// of 4 GB at most, unless the first page alone is larger.
const unsigned char EMPTY_BIGTIFF[16] = {'I', 'I', 43, 0, 8, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0};

// The type of a pyramid's voxels. TIFF has no half; and of doubles OpenImageIO 2.4 loses those in
// tiles, and those of a single row.
VoxelType storedType(VoxelType type)
{
    return type == VoxelType::HALF || type == VoxelType::FLOAT64 ? VoxelType::FLOAT32 : type;
}

// As floats that hold all of the range.
void appendRange(const core::ValueRange& range, std::vector<float>& values)
{
    constexpr float infinity = std::numeric_limits<float>::infinity();
    float low = range.empty() ? 1.0f : static_cast<float>(range.low);
    float high = range.empty() ? 0.0f : static_cast<float>(range.high);
    if (!range.empty() && double(low) > range.low) low = std::nextafter(low, -infinity);
    if (!range.empty() && double(high) < range.high) high = std::nextafter(high, infinity);
    values.insert(values.end(), {low, high});
}

// Makes a page the last one of a BigTIFF that begin() made: where it says where the next one is, it
// says that there is none. What follows stays as bytes that nothing refers to.
bool cutAfter(const std::string& path, int pages)
{
    std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
    const auto number = [&file](std::uint64_t at) {
        unsigned char bytes[8] = {};
        file.seekg(static_cast<std::streamoff>(at));
        file.read(reinterpret_cast<char*>(bytes), 8);
        std::uint64_t value = 0;
        for (int i = 7; i >= 0; --i)
            value = value << 8 | bytes[i];
        return value;
    };
    std::uint64_t link = 8;
    for (int page = 0; page < pages && file; ++page) {
        const std::uint64_t directory = number(link);
        link = directory + 8 + 20 * number(directory);
    }
    file.seekp(static_cast<std::streamoff>(link));
    file.write("\0\0\0\0\0\0\0\0", 8);
    return bool(file.flush());
}

class PyramidWriter
{
public:
    PyramidWriter(const VoxelSource& source, const std::string& fileName,
                  const PyramidOptions& options, const Progress& progress)
        : _source(source), _fileName(fileName), _progress(progress)
    {
        _sourceType = source.describe().type;
        _format.description = source.describe();
        _format.description.type = storedType(_sourceType);
        _format.rule = options.rule;
        _format.origin = options.origin;
    }

    Status run()
    {
        const Result<core::BrickTree> tree = _format.tree();
        if (!tree.ok()) return {tree.status.code, _fileName + ": " + tree.status.text};
        _tree = *tree;
        _voxel =
            voxelTypeSize(_format.description.type) * std::size_t(_format.description.components);
        _ranges.resize(std::size_t(_tree.brickCount()));
        io::PartFile part(_fileName, io::PartFile::STAYS);
        _part = part.name();
        if (Status status = begin(); !status.ok()) return status;
        for (int level = 0; level < _tree.levelCount(); ++level) {
            if (level > 0)
                if (Status status = reopen(); !status.ok()) return status;
            for (int layer = 0; layer < _tree.count(level).z; ++layer)
                if (Status status = writeLayer(level, layer); !status.ok()) return status;
        }
        return part.keep();
    }

private:
    using Samples = std::vector<unsigned char>;
    struct Row
    {
        int level, layer, y, firstX, lastX;
    };

    Status begin();
    Status reopen();
    Status writeLayer(int level, int layer);
    Status writeSamples(int level, int layer, OIIO::ImageOutput& out);
    Status writeRanges(int level, int layer);
    Status readSamples(int level, const core::Box3i& region, Samples& samples) const;
    core::Box3i boxOf(const Row& row) const;
    void cutTile(const Samples& samples, const core::Box3i& box, const glm::ivec3& brick, int level,
                 Samples& tile) const;
    core::ValueRange rangeOf(const Samples& tile, int level, const glm::ivec3& brick) const;
    Status open(OIIO::ImageOutput& out, const OIIO::ImageSpec& spec) const;
    Status unwritable(OIIO::ImageOutput& out) const;
    void tellProgress(int level, int layer, double share) const;

    const VoxelSource& _source;
    const std::string _fileName;
    const Progress& _progress;
    VoxelType _sourceType = VoxelType::UINT8;
    PyramidFormat _format;
    core::BrickTree _tree;
    std::size_t _voxel = 1; ///< bytes
    std::string _part;
    int _pagesThere = 0; ///< of an earlier run
    std::vector<core::ValueRange> _ranges;
    osg::ref_ptr<io::PyramidSource> _written; ///< levels that are finished
};

// Goes on with what is there where that is the beginning of the same, else begins anew.
Status PyramidWriter::begin()
{
    _pagesThere = 0;
    const CallerReports quiet;
    osg::ref_ptr<io::PyramidSource> there = new io::PyramidSource;
    if (io::PyramidSource::isPyramid(_part) && there->open(_part, false).ok() &&
        there->format().text() == _format.text()) {
        // The last page may not be whole: a file that is closed after an error looks as if it were.
        _pagesThere = std::max(there->pageCount() - 1, 0) / 2 * 2;
        _written = there;
        if (_pagesThere > 0 && cutAfter(_part, _pagesThere)) return {};
        _pagesThere = 0;
    }
    std::ofstream file(_part, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(EMPTY_BIGTIFF), sizeof(EMPTY_BIGTIFF));
    if (file.flush()) return {};
    return {ErrorCode::FILE_UNREADABLE, _fileName + " cannot be written"};
}

Status PyramidWriter::reopen()
{
    _written = new io::PyramidSource;
    return _written->open(_part, false);
}

Status PyramidWriter::unwritable(OIIO::ImageOutput& out) const
{
    return {ErrorCode::FILE_UNREADABLE,
            _fileName + " cannot be written: " + io::oneLine(out.geterror())};
}

Status PyramidWriter::open(OIIO::ImageOutput& out, const OIIO::ImageSpec& spec) const
{
    if (out.open(_part, spec, OIIO::ImageOutput::AppendSubimage)) return {};
    return unwritable(out);
}

void PyramidWriter::tellProgress(int level, int layer, double share) const
{
    if (!_progress) return;
    double before = 0.0, all = 0.0;
    for (int l = 0; l < _tree.levelCount(); ++l) {
        const double bricks = double(_tree.brickCount(l));
        all += bricks;
        if (l < level) before += bricks;
        if (l == level) before += bricks * (layer + share) / _tree.count(l).z;
    }
    _progress(before / all);
}

Status PyramidWriter::writeLayer(int level, int layer)
{
    const int page = 2 * PyramidFormat::pairOf(_tree, level, layer);
    if (page < _pagesThere) {
        for (int y = 0; y < _tree.count(level).y; ++y)
            for (int x = 0; x < _tree.count(level).x; ++x) {
                const std::int64_t brick = _tree.index(level, {x, y, layer});
                const auto range = _written->brickRange(brick);
                _ranges[std::size_t(brick)] = {range.first, range.second};
            }
        tellProgress(level, layer, 1.0);
        return {};
    }
    const glm::ivec3 count = _tree.count(level);
    const VoxelSource::Description& d = _format.description;
    if (std::max(count.x, count.y) > std::numeric_limits<int>::max() / TILE_PIXELS)
        return {ErrorCode::TOO_LARGE, _fileName + ": an image cannot be so wide"};
    OIIO::ImageSpec spec(count.x * TILE_PIXELS, count.y * TILE_PIXELS, d.components,
                         io::typeDescOf(d.type));
    spec.tile_width = spec.tile_height = TILE_PIXELS;
    spec.attribute("compression", "zip");
    spec.attribute("tiff:zipquality", 4);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    spec.attribute("ImageDescription", page == 0 ? _format.text()
                                                 : "osgVolumizer pyramid: level " +
                                                       std::to_string(level) + ", layer " +
                                                       std::to_string(layer));
    const auto out = OIIO::ImageOutput::create("tiff");
    if (!out) return {ErrorCode::NOT_SUPPORTED, "OpenImageIO writes no TIFF here"};
    Status status = open(*out, spec);
    if (status.ok() && out->spec().format != spec.format)
        status = {ErrorCode::NOT_SUPPORTED, _fileName + ": a TIFF cannot hold voxels of type " +
                                                std::string(voxelTypeName(d.type))};
    if (status.ok()) status = writeSamples(level, layer, *out);
    if (!status.ok()) return status;
    if (!out->close()) return unwritable(*out);
    return writeRanges(level, layer);
}

// The samples of a run of bricks along x, as far as there are any.
core::Box3i PyramidWriter::boxOf(const Row& row) const
{
    const glm::ivec3 size = core::BrickTree::levelSize(_tree.size(), row.level);
    core::Box3i box;
    box.min = glm::ivec3(row.firstX, row.y, row.layer) * STEP - BORDER;
    box.max = glm::ivec3(row.lastX - 1, row.y, row.layer) * STEP - BORDER + TILE;
    for (int axis = 0; axis < 3; ++axis) {
        box.min[axis] = std::clamp(box.min[axis], 0, size[axis] - 1);
        box.max[axis] = std::clamp(box.max[axis], 1, size[axis]);
    }
    return box;
}

// Of a level: read from the source, or made from the level below.
Status PyramidWriter::readSamples(int level, const core::Box3i& region, Samples& samples) const
{
    const VoxelSource::Description& d = _format.description;
    const auto bytes = [&](const core::Box3i& box) {
        return std::size_t(core::sampleCount(box.size())) * _voxel;
    };
    samples.resize(bytes(region));
    if (level == 0) {
        if (_sourceType == d.type) return _source.read(region, samples.data());
        Samples own(std::size_t(core::voxelBytes(region.size(), _sourceType, d.components)));
        Status status = _source.read(region, own.data());
        if (status.ok())
            core::convertVoxels(own.data(), _sourceType, samples.data(), d.type,
                                own.size() / voxelTypeSize(_sourceType));
        return status;
    }
    const glm::ivec3 size = core::BrickTree::levelSize(_tree.size(), level - 1);
    core::Box3i below{2 * region.min, 2 * region.max};
    for (int axis = 0; axis < 3; ++axis)
        below.max[axis] = std::min(below.max[axis], size[axis]);
    Samples fine(bytes(below));
    Status status = _written->readLevel(level - 1, below, fine.data());
    if (status.ok())
        core::downsample(fine.data(), below.size(), d.type, d.components, _format.rule,
                         samples.data());
    return status;
}

// The mosaic of a brick; what is beyond the volume repeats its last samples.
void PyramidWriter::cutTile(const Samples& samples, const core::Box3i& box, const glm::ivec3& brick,
                            int level, Samples& tile) const
{
    const glm::ivec3 size = box.size();
    const auto inside = [&](int i, int axis) {
        return std::clamp(brick[axis] * STEP - BORDER + i, box.min[axis], box.max[axis] - 1) -
               box.min[axis];
    };
    for (int z = 0; z < TILE; ++z)
        for (int y = 0; y < TILE; ++y) {
            const std::size_t from =
                (std::size_t(inside(z, 2)) * size.y + std::size_t(inside(y, 1))) * size.x;
            const std::size_t to =
                std::size_t(z / MOSAIC * TILE + y) * TILE_PIXELS + std::size_t(z % MOSAIC) * TILE;
            for (int x = 0; x < TILE; ++x)
                std::memcpy(tile.data() + (to + x) * _voxel,
                            samples.data() + (from + std::size_t(inside(x, 0))) * _voxel, _voxel);
        }
}

// Of all samples of level 0 beneath.
core::ValueRange PyramidWriter::rangeOf(const Samples& tile, int level,
                                        const glm::ivec3& brick) const
{
    const VoxelSource::Description& d = _format.description;
    core::ValueRange range;
    if (level == 0)
        return core::scanRange({tile.data(), d.type, d.components, {TILE_PIXELS, TILE_PIXELS, 1}},
                               d.components == 4 ? 3 : 0);
    for (const std::int64_t child :
         _tree.children(_tree.index(level, brick), glm::dvec4(0.0, 0.0, 1.0, 0.0)))
        range.expand(_ranges[std::size_t(child)]);
    return range;
}

// And finds the ranges.
Status PyramidWriter::writeSamples(int level, int layer, OIIO::ImageOutput& out)
{
    const glm::ivec3 count = _tree.count(level);
    const VoxelSource::Description& d = _format.description;
    const std::int64_t brickBytes = std::int64_t(TILE) * TILE * TILE * std::int64_t(_voxel);
    const int atATime = int(std::max<std::int64_t>(BUFFER_BYTES / brickBytes / (level ? 8 : 1), 1));
    Samples samples, tile(std::size_t(TILE_PIXELS) * TILE_PIXELS * _voxel);
    for (int y = 0; y < count.y; ++y) {
        for (int first = 0; first < count.x; first += atATime) {
            const Row row{level, layer, y, first, std::min(first + atATime, count.x)};
            const core::Box3i box = boxOf(row);
            if (Status status = readSamples(level, box, samples); !status.ok()) return status;
            for (int x = row.firstX; x < row.lastX; ++x) {
                const glm::ivec3 brick(x, y, layer);
                cutTile(samples, box, brick, level, tile);
                _ranges[std::size_t(_tree.index(level, brick))] = rangeOf(tile, level, brick);
                if (!out.write_tile(x * TILE_PIXELS, y * TILE_PIXELS, 0, io::typeDescOf(d.type),
                                    tile.data()))
                    return unwritable(out);
            }
        }
        tellProgress(level, layer, double(y + 1) / count.y);
    }
    return {};
}

Status PyramidWriter::writeRanges(int level, int layer)
{
    const glm::ivec3 count = _tree.count(level);
    std::vector<float> values;
    for (int y = 0; y < count.y; ++y)
        for (int x = 0; x < count.x; ++x)
            appendRange(_ranges[std::size_t(_tree.index(level, {x, y, layer}))], values);
    OIIO::ImageSpec spec(count.x, count.y, 2, OIIO::TypeDesc::FLOAT);
    spec.attribute("compression", "zip");
    spec.attribute("ImageDescription", "osgVolumizer pyramid: ranges of level " +
                                           std::to_string(level) + ", layer " +
                                           std::to_string(layer));
    const auto out = OIIO::ImageOutput::create("tiff");
    if (!out) return {ErrorCode::NOT_SUPPORTED, "OpenImageIO writes no TIFF here"};
    if (Status status = open(*out, spec); !status.ok()) return status;
    if (!out->write_image(OIIO::TypeDesc::FLOAT, values.data()) || !out->close())
        return unwritable(*out);
    return {};
}

} // namespace

Status writePyramid(const VoxelSource& source, const std::string& fileName,
                    const PyramidOptions& options, const Progress& progress)
{
    if (Status status = source.describe().validate(); !status.ok()) return status;
    if (Status status = core::requireRegularTarget(fileName); !status.ok()) return status;
    try {
        return PyramidWriter(source, fileName, options, progress).run();
    } catch (const std::exception& e) {
        return {ErrorCode::FILE_UNREADABLE, fileName + " cannot be written: " + e.what()};
    }
}

Status writePyramid(const Voxels& voxels, const std::string& fileName,
                    const PyramidOptions& options, const Progress& progress)
{
    if (!voxels.valid()) return {ErrorCode::VALUE_INVALID, fileName + ": no voxels to write"};
    const osg::ref_ptr<io::MovedSource> moved = new io::MovedSource(voxels);
    return writePyramid(*moved, fileName, options, progress);
}

} // namespace osgVolumizer
