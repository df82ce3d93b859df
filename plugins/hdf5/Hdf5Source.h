#pragma once

#include "Layout.h"

#include <osgVolumizer/ReadVoxels.h>
#include <osgVolumizer/VoxelSource.h>

#include <memory>
#include <string>

namespace osgVolumizer {
namespace hdf5 {

/// The voxels of an HDF5 file, read as they are asked for, one region after another: the library
/// takes one thread at a time. Nothing is kept. The file stays open, so that it may be deleted or
/// replaced; what is cut off from it cannot be read any more.
///
/// It has coarser levels, and so is paged, where the file has some that are of use, several time
/// steps, or more than half of what paged voxels may take in memory (see Paging.h). Halves,
/// quarters, ... along any of the axes are of use: a level of this source is read from the coarsest
/// of the file that is nowhere coarser, of which every second, fourth, ... sample is taken on the
/// axes where that is finer. Imaris halves the long axes first, and BigDataViewer whichever it was
/// told. Levels of other factors are left out.
class Hdf5Source : public VoxelSource
{
public:
    META_Object(osgVolumizer, Hdf5Source);

    Hdf5Source() = default;
    /// Shares the file.
    Hdf5Source(const Hdf5Source& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// The text of a failure begins with the path.
    Status open(const std::string& path, const Wanted& wanted);

    Description describe() const override { return _layout.description; }
    Status read(const core::Box3i& region, void* destination) const override
    {
        return readStep(0, 0, region, destination);
    }
    /// What else could have been chosen: the volumes in the file, this one marked. Of Imaris and
    /// BigDataViewer one, with its channels.
    Result<std::vector<VolumeEntry>> list() const;
    int levelCount() const override { return _levelCount; }
    Status readLevel(int level, const core::Box3i& region, void* destination) const override
    {
        return readStep(0, level, region, destination);
    }
    int stepCount() const override { return _layout.steps; }
    /// SIZE_MISMATCH where a time step is smaller than the first.
    Status readStep(int step, int level, const core::Box3i& region,
                    void* destination) const override;

protected:
    ~Hdf5Source() override = default;

private:
    class File;

    Status readFrom(int step, int level, const core::Box3i& region, void* destination) const;
    Status refuse(ErrorCode code, const std::string& text) const;

    std::string _path;
    Layout _layout;
    int _levelCount = 1;
    std::shared_ptr<const File> _file;
};

} // namespace hdf5
} // namespace osgVolumizer
