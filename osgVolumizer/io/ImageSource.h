#pragma once

#include "ImageFile.h"

#include <memory>
#include <mutex>
#include <vector>

namespace osgVolumizer {
namespace io {

/// The voxels of pages (subimages) of an image file, a slice each, read as they are asked for, one
/// region after another. It has coarser levels, and so is paged: of what a sample of a level stands
/// for the one in the middle.
class ImageSource : public VoxelSource
{
public:
    META_Object(osgVolumizer, ImageSource);

    ImageSource() = default;
    /// Shares the file.
    ImageSource(const ImageSource& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY)
        : VoxelSource(o, op), _description(o._description), _format(o._format), _pages(o._pages),
          _file(o._file)
    {
    }

    /// FILE_UNREADABLE. `pages` has the subimage of each slice; all are as `description` and
    /// `format` say.
    Status open(const std::string& path, const Description& description, const PixelFormat& format,
                std::vector<int> pages);

    Description describe() const override { return _description; }
    Status read(const core::Box3i& region, void* destination) const override;
    int levelCount() const override;
    Status readLevel(int level, const core::Box3i& region, void* destination) const override;

protected:
    ~ImageSource() override = default;

private:
    struct Shared
    {
        std::mutex mutex;
        ImageFile file;
    };
    Status readRows(int z, int y, int end, std::vector<unsigned char>& rows) const;

    Description _description;
    PixelFormat _format;
    std::vector<int> _pages;
    std::shared_ptr<Shared> _file;
};

} // namespace io
} // namespace osgVolumizer
