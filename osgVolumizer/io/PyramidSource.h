#pragma once

#include "PyramidFormat.h"

#include <OpenImageIO/imageio.h>

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace io {

/// The voxels of a pyramid, read brick by brick as they are asked for. Keeps the ranges of all
/// bricks, sixteen bytes each, and no samples.
class PyramidSource : public VoxelSource
{
public:
    META_Object(osgVolumizer, PyramidSource);

    PyramidSource() = default;
    /// Shares the file.
    PyramidSource(const PyramidSource& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// True for a file that says that it is a pyramid, whole or not.
    static bool isPyramid(const std::string& path);
    /// FILE_UNREADABLE for anything that is no pyramid, that lacks pages, or whose pages are not
    /// what its header says. `whole`: false also opens one that is being written, as far as it
    /// goes.
    Status open(const std::string& path, bool whole = true);

    const PyramidFormat& format() const { return _format; }
    /// Pages that are there: of a whole one, two for each layer of each level.
    int pageCount() const { return _pageCount; }
    /// By the tree's number.
    std::pair<double, double> brickRange(std::int64_t brick) const
    {
        return _ranges[static_cast<std::size_t>(brick)];
    }

    Description describe() const override { return _format.description; }
    Status read(const core::Box3i& region, void* destination) const override
    {
        return readLevel(0, region, destination);
    }
    std::optional<std::pair<double, double>> valueRange(const core::Box3i& region) const override
    {
        return levelRange(0, region);
    }
    int levelCount() const override { return _tree.levelCount(); }
    Status readLevel(int level, const core::Box3i& region, void* destination) const override;
    /// Of the bricks that the middle of the region, or if it is larger than one all of it, lies in.
    std::optional<std::pair<double, double>> levelRange(int level,
                                                        const core::Box3i& region) const override;
    int pageSize() const override { return PyramidFormat::STEP; }

protected:
    ~PyramidSource() override = default;

private:
    class Files;

    Status openPages(OIIO::ImageInput& input, bool whole);
    Status checkPage(OIIO::ImageInput& input, int level, int layer) const;
    Status readRanges(OIIO::ImageInput& input, int level, int layer);
    Status readBrick(int level, const glm::ivec3& brick, void* samples) const;
    std::string reason(OIIO::ImageInput& input) const;

    std::string _path;
    PyramidFormat _format;
    core::BrickTree _tree;
    int _pageCount = 0;
    std::vector<std::pair<double, double>> _ranges; ///< by the tree's numbers
    std::shared_ptr<Files> _files;
};

} // namespace io
} // namespace osgVolumizer
