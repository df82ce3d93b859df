#pragma once

#include "GridSource.h"

#include <openvdb/io/File.h>

#include <memory>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace vdb {

/// What a file says of a grid.
struct GridEntry
{
    std::string name;             ///< unique in the file: "density", "density[1]"
    std::string type, classText;  ///< "Tree_float_5_4_3", "fog volume"
    std::optional<GridKind> kind; ///< none where it cannot be read
    std::int64_t activeVoxels = 0;
    glm::ivec3 size{0}; ///< of the box of its active voxels; held within what an int can say

    /// "fog volume of Tree_float_5_4_3, 1234 active voxels"
    std::string text() const;
};

/// The grids of a file.
class GridList
{
public:
    /// FILE_UNREADABLE; texts begin with the path.
    static Result<GridList> open(const std::string& path);

    const std::vector<GridEntry>& entries() const { return _entries; }
    /// "density", "temperature": ten of them.
    std::string names() const;
    /// Which one is to be read: the one of that name, or, of an empty one, the one with the most
    /// active voxels, vectors only if there are no others. VALUE_INVALID for a name that is not
    /// there, NOT_SUPPORTED for a grid that cannot be read.
    Result<std::size_t> choose(const std::string& name) const;
    /// With its tree. Throws what the library throws.
    openvdb::GridBase::ConstPtr readGrid(std::size_t index);

private:
    void addEntry(const std::string& name);

    std::string _path;
    std::shared_ptr<openvdb::io::File> _file;
    std::vector<GridEntry> _entries;
};

} // namespace vdb
} // namespace osgVolumizer
