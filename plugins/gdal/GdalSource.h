#pragma once

#include "File.h"
#include "Layout.h"

#include <osgVolumizer/VoxelSource.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace gdal {

/// The voxels of a variable, read as they are asked for, one region after another. Nothing is kept
/// but what GDAL itself keeps. The file stays open.
///
/// It has coarser levels, and so is paged, where there are several time steps, or it is more than
/// half of what paged voxels may take in memory (see Paging.h): every second, fourth, ... sample.
class GdalSource : public VoxelSource
{
public:
    META_Object(osgVolumizer, GdalSource);

    GdalSource() = default;
    /// Shares the file.
    GdalSource(const GdalSource& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// The text of a failure begins with the path.
    Status open(const std::string& path, const std::string& dataset, const std::string& dimensions);

    /// The same of a variable that is known, of a file that is open; nothing is told of it.
    Status open(const std::string& path, const std::shared_ptr<const File>& file,
                std::size_t variable, const std::string& dimensions);

    Description describe() const override { return _layout.description; }
    Status read(const core::Box3i& region, void* destination) const override
    {
        return readStep(0, 0, region, destination);
    }
    int levelCount() const override { return _levelCount; }
    Status readLevel(int level, const core::Box3i& region, void* destination) const override
    {
        return readStep(0, level, region, destination);
    }
    int stepCount() const override { return _layout.steps; }
    Status readStep(int step, int level, const core::Box3i& region,
                    void* destination) const override;

protected:
    ~GdalSource() override = default;

private:
    /// Gives 64-bit integers the narrowest type that holds them, and values with what NetCDF fills
    /// them one with holes, where all steps together have no more than `mostBytes`: reads all.
    void settleType(std::int64_t mostBytes);
    /// Calls `visit` for one after another, until it is false; true where it never was.
    bool readSlices(const std::function<bool(const std::vector<double>&)>& visit) const;
    Status readFrom(int step, int level, const core::Box3i& region, void* destination) const;
    Status readNumbers(int step, const Fetch (&fetch)[3], VoxelType type, void* destination) const;

    std::string _path;
    Layout _layout;
    int _levelCount = 1;
    std::shared_ptr<const File> _file;
    std::size_t _variable = 0;
};

} // namespace gdal
} // namespace osgVolumizer
