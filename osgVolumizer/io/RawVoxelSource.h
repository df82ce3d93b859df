#pragma once

#include "RawName.h"

#include "../VoxelSource.h"

#include <string>

namespace osgVolumizer {
namespace io {

/// Voxels of a raw file, read as they are asked for. The file stays open, so that it may be deleted
/// or replaced; what is cut off from it cannot be read any more. One that takes more than half of
/// what paged voxels may take in memory (see Paging.h) has coarser levels, and so is paged: every
/// 2^l-th sample, since means would have to be made of all.
class RawVoxelSource : public VoxelSource
{
public:
    META_Object(osgVolumizer, RawVoxelSource)

        RawVoxelSource() = default;
    /// Shares the file.
    RawVoxelSource(const RawVoxelSource& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// FILE_UNREADABLE, VALUE_INVALID. Expects that the file has the bytes that `raw` says.
    Status open(const RawName& raw, const std::string& path);

    /// Where the voxels lie, as a file around them says.
    void setPlace(const glm::dvec3& spacing, const glm::dvec3& origin, const glm::dmat3& axes)
    {
        _description.spacing = spacing;
        _description.origin = origin;
        _description.axes = axes;
    }

    Description describe() const override { return _description; }
    Status read(const core::Box3i& region, void* destination) const override;
    int levelCount() const override { return _levels; }
    Status readLevel(int level, const core::Box3i& region, void* destination) const override;

protected:
    ~RawVoxelSource() override = default;

private:
    class File;

    Status readBytes(std::int64_t offset, std::int64_t bytes, void* destination) const;
    Status readLayer(const core::Box3i& region, int z, unsigned char* destination) const;

    Description _description;
    std::string _path;
    std::int64_t _headerBytes = 0, _fileBytes = 0;
    int _levels = 1, _sliceStep = 1;
    bool _swaps = false; ///< the file's byte order is not the host's
    std::shared_ptr<const File> _file;
};

} // namespace io
} // namespace osgVolumizer
