#include "GridList.h"

#include "FileCheck.h"

#include <algorithm>
#include <limits>

namespace osgVolumizer {
namespace vdb {

namespace {

int lengthOf(const openvdb::Vec3i& low, const openvdb::Vec3i& high, int axis)
{
    const std::int64_t length = std::int64_t(high[axis]) - std::int64_t(low[axis]) + 1;
    return int(std::clamp<std::int64_t>(length, 0, std::numeric_limits<int>::max()));
}

// What the file says that is active; counted where it does not.
void findActive(openvdb::io::File& file, openvdb::GridBase::ConstPtr grid, GridEntry& entry)
{
    using openvdb::GridBase;
    const auto low = grid->getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MIN);
    const auto high = grid->getMetadata<openvdb::Vec3IMetadata>(GridBase::META_FILE_BBOX_MAX);
    const auto count = grid->getMetadata<openvdb::Int64Metadata>(GridBase::META_FILE_VOXEL_COUNT);
    openvdb::Vec3i first, last;
    if (low && high && count) {
        first = low->value();
        last = high->value();
        entry.activeVoxels = count->value();
    } else {
        grid = file.readGrid(entry.name);
        const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
        first = box.min().asVec3i();
        last = box.max().asVec3i();
        entry.activeVoxels = std::int64_t(grid->activeVoxelCount());
    }
    if (entry.activeVoxels == 0) return;
    for (int axis = 0; axis < 3; ++axis)
        entry.size[axis] = lengthOf(first, last, axis);
}

} // namespace

std::string GridEntry::text() const
{
    return classText + " of " + type + ", " + std::to_string(activeVoxels) + " active voxels";
}

Result<GridList> GridList::open(const std::string& path)
{
    if (Status status = checkFile(path); !status.ok()) return status;
    try {
        openvdb::initialize();
        GridList list;
        list._path = path;
        list._file = std::make_shared<openvdb::io::File>(path);
        list._file->open(false); // all of a grid at once: what is damaged is found now
        for (auto name = list._file->beginName(); name != list._file->endName(); ++name)
            list.addEntry(name.gridName());
        if (list._entries.empty())
            return Status(ErrorCode::FILE_UNREADABLE, path + " has no grids");
        return list;
    } catch (const std::exception& e) {
        return Status(ErrorCode::FILE_UNREADABLE, path + " cannot be read: " + e.what());
    }
}

void GridList::addEntry(const std::string& name)
{
    GridEntry entry;
    entry.name = name;
    const openvdb::GridBase::ConstPtr grid = _file->readGridMetadata(name);
    entry.type = grid->type();
    entry.classText = openvdb::GridBase::gridClassToMenuName(grid->getGridClass());
    entry.kind = kindOf(entry.type, grid->saveFloatAsHalf());
    if (entry.kind) findActive(*_file, grid, entry);
    _entries.push_back(entry);
}

std::string GridList::names() const
{
    constexpr std::size_t MOST = 10;
    std::string text;
    for (std::size_t i = 0; i < std::min(_entries.size(), MOST); ++i)
        text += (i ? ", \"" : "\"") + _entries[i].name + "\"";
    return _entries.size() > MOST ? text + ", ..." : text;
}

Result<std::size_t> GridList::choose(const std::string& name) const
{
    if (name.empty()) {
        const auto rank = [](const GridEntry& e) {
            return std::pair(e.kind ? 3 - e.kind->channels : -1, e.activeVoxels);
        };
        const auto most = std::max_element(
            _entries.begin(), _entries.end(),
            [&](const GridEntry& a, const GridEntry& b) { return rank(a) < rank(b); });
        if (most->kind) return std::size_t(most - _entries.begin());
        return Status(ErrorCode::NOT_SUPPORTED,
                      _path + " has no grid of numbers: " + names() + " of type " + most->type);
    }
    for (std::size_t i = 0; i < _entries.size(); ++i)
        if (_entries[i].name == name) {
            if (_entries[i].kind) return i;
            return Status(ErrorCode::NOT_SUPPORTED, _path + ": grid \"" + name +
                                                        "\" has no numbers but is a " +
                                                        _entries[i].type);
        }
    return Status(ErrorCode::VALUE_INVALID,
                  _path + " has no grid \"" + name + "\": there are " + names());
}

openvdb::GridBase::ConstPtr GridList::readGrid(std::size_t index)
{
    return _file->readGrid(_entries[index].name);
}

} // namespace vdb
} // namespace osgVolumizer
