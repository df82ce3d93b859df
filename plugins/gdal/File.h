#pragma once

#include "Variables.h"

#include <osgVolumizer/core/Status.h>

#include <memory>
#include <string>
#include <vector>

class GDALDataset;

namespace osgVolumizer {
namespace gdal {

/// A file, or a folder of Zarr, that is open for reading: nothing but that path, by the drivers for
/// NetCDF, HDF5 and Zarr alone.
class File
{
public:
    /// FILE_UNREADABLE; NOT_SUPPORTED where this GDAL lacks the driver. Texts begin with the path.
    static Result<std::shared_ptr<const File>> open(const std::string& path);
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File();

    const std::string& driver() const { return _driver; } ///< "netCDF"
    const std::vector<Variable>& variables() const { return _variables; }
    /// "/a", "/b": ten of them.
    std::string names() const;
    /// The variable of a path, or of the last part of one if no other ends so; of an empty one the
    /// largest with three axes, else with two. VALUE_INVALID where it is not there.
    Result<std::size_t> choose(const std::string& name) const;

private:
    File() = default;

    std::string _path, _driver;
    GDALDataset* _dataset = nullptr;
    std::vector<Variable> _variables; ///< at least one
};

} // namespace gdal
} // namespace osgVolumizer
