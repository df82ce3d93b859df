#pragma once

#include "VoxelSource.h"
#include "core/voxels/BrickLayout.h"

#include <osg/Vec3d>
#include <osg/Vec2d>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace osgVolumizer {

/// The voxels of one volume, cut into bricks: shared by any number of appearances, views and
/// contexts. Bricks are read from the source when first drawn, and kept.
///
/// Frames: voxel frame as in core/voxels/BrickLayout.h; object = origin + spacing * voxel.
class OSGVOLUMIZER_EXPORT Voxels : public osg::Object
{
public:
    META_Object(osgVolumizer, Voxels)

    Voxels();
    explicit Voxels(VoxelSource* source);
    Voxels(const Voxels& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// Replaces the source, and takes size, type, spacing, origin and range from it.
    Status setSource(VoxelSource* source);
    VoxelSource* getSource() const { return _source.get(); }
    /// False until a source with voxels is set: such voxels draw nothing.
    bool valid() const;

    glm::ivec3 getSize() const { return _description.size; }
    VoxelType getType() const { return _description.type; }
    int getComponents() const { return _description.components; }

    /// Object units between samples, each > 0.
    Status setSpacing(const osg::Vec3d& spacing);
    osg::Vec3d getSpacing() const;
    /// Object position of sample (0,0,0).
    Status setOrigin(const osg::Vec3d& origin);
    osg::Vec3d getOrigin() const;
    /// Mean of the three spacings: the default opacity unit.
    double getMeanSpacing() const;

    /// Data values at the two ends of a lookup table's domain; low < high. Default: the type's range for
    /// 8 bit, else the lowest and highest value found in the data.
    Status setRange(const osg::Vec2d& range);
    osg::Vec2d getRange() const;
    bool hasExplicitRange() const { return _explicitRange; }

    /// Largest brick, in samples per axis; default 256^3. Drops resident bricks.
    Status setBrickSize(const glm::ivec3& samples);
    glm::ivec3 getBrickSize() const { return _brickSize; }
    /// Samples shared by neighbours: 1 for linear filtering, 3 for cubic.
    Status setOverlap(int samples);
    int getOverlap() const { return _overlap; }
    const core::BrickLayout& getLayout() const { return _layout; }

    /// The samples of a brick, read on the first call; null (and an error) if the source fails.
    /// Thread safe. The data is immutable: dirty() makes a new block.
    using Block = std::shared_ptr<const std::vector<unsigned char>>;
    Block getBrick(std::int64_t brick) const;
    /// Lowest and highest finite value of a brick: from the source's own knowledge, else from its
    /// data, which is then read. Thread safe.
    std::pair<double, double> getBrickRange(std::int64_t brick) const;

    /// The data of a brick, or of all (-1), has changed: it is read and uploaded again.
    void dirty(std::int64_t brick = -1);
    /// Grows with every change to a brick's data; compared by texture caches. Thread safe.
    unsigned getModifiedCount(std::int64_t brick) const;
    /// Changes whenever layout, type, range, spacing or origin do. Thread safe.
    unsigned getLayoutCount() const { return _layoutCount; }

    /// How a scene file refers to the voxels: a name for readVoxels(), with its options. Empty: inline.
    void setFileName(const std::string& name) { _fileName = name; }
    const std::string& getFileName() const { return _fileName; }
    void setFileOptions(const std::string& options) { _fileOptions = options; }
    const std::string& getFileOptions() const { return _fileOptions; }

    /// Counters since construction: bricks read from the source.
    std::uint64_t getReadCount() const { return _readCount; }

    /// Per-context textures, owned by the renderer; opaque here.
    osg::Referenced* getRenderData() const;
    void setRenderData(osg::Referenced* data) const;
    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

protected:
    ~Voxels() override;

private:
    struct Brick; // data, range and modified count of one brick

    Status rebuildLayout();

    osg::ref_ptr<VoxelSource> _source;
    VoxelSource::Description _description;
    bool _explicitRange = false;
    osg::Vec2d _range{0.0, 1.0};
    glm::ivec3 _brickSize{256};
    int _overlap = 1;
    core::BrickLayout _layout;
    std::string _fileName, _fileOptions;
    mutable std::mutex _mutex;
    mutable std::vector<Brick> _bricks;
    mutable std::atomic<std::uint64_t> _readCount{0};
    std::atomic<unsigned> _layoutCount{0};
    mutable osg::ref_ptr<osg::Referenced> _renderData;
};

} // namespace osgVolumizer
