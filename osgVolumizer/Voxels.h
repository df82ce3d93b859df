#pragma once

#include "BlockCache.h"
#include "RenderData.h"
#include "VoxelSource.h"
#include "core/voxels/BrickLayout.h"
#include "core/voxels/BrickTree.h"
#include "core/voxels/ChangeLog.h"

#include <osg/Vec2d>
#include <osg/Vec3d>
#include <osg/Vec3i>

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgVolumizer {

namespace core {
struct ValueRange;
}

/// The voxels of one volume, cut into bricks: shared by any number of appearances, views and
/// contexts. Bricks are read from the source when they are needed; those used last are kept.
///
/// Frames: voxel frame as in core/voxels/BrickLayout.h; object = origin + spacing * voxel.
class OSGVOLUMIZER_EXPORT Voxels : public osg::Object
{
public:
    META_Object(osgVolumizer, Voxels);

    Voxels();
    explicit Voxels(VoxelSource* source);
    /// Shares the source with `o`; a copy of its own with CopyOp::DEEP_COPY_OBJECTS. Bricks that
    /// are resident, and textures, are never shared.
    Voxels(const Voxels& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// Replaces the source, and takes size, type, spacing, origin and range from it.
    ReportedStatus setSource(VoxelSource* source);
    VoxelSource* getSource() const { return _source.get(); }
    /// Another source of the very same values in place of the present one: nothing is forgotten,
    /// neither range, spacing and origin nor what is resident. Refuses (SIZE_MISMATCH) one of
    /// another size, type, or number of components, levels, steps, or samples of a page. Of paged
    /// voxels reads may be under way: the new source is to keep the old one, or not to be read.
    ReportedStatus exchangeSource(VoxelSource* source);
    /// False until a source with voxels is set: such voxels draw nothing.
    bool valid() const;

    osg::Vec3i getSize() const;
    VoxelType getType() const { return _description.type; }
    int getComponents() const { return _description.components; }

    /// Object units between samples, each from 1e-18 to 1e18, which floats can still square.
    ReportedStatus setSpacing(const osg::Vec3d& spacing);
    osg::Vec3d getSpacing() const;
    /// Object position of sample (0,0,0), each within 1e18.
    ReportedStatus setOrigin(const osg::Vec3d& origin);
    osg::Vec3d getOrigin() const;
    /// Mean of the three spacings: the default opacity unit.
    double getMeanSpacing() const;

    /// Data values at the two ends of a lookup table's domain, at least 1e-30 apart, which floats
    /// can still divide by. Default: the type's
    /// range for 8 bit and RGBA, else the lowest and highest value found in the data, once, on the
    /// first call of getRange(); that reads all bricks where the source does not know it. Of paged
    /// voxels setSource() reads the coarsest level for it, of at most five time steps.
    ReportedStatus setRange(const osg::Vec2d& range);
    osg::Vec2d getRange() const;
    bool hasExplicitRange() const;

    /// Largest brick, in samples per axis, each above the overlap; default 256^3. Refused (as by
    /// setOverlap() and setSource()) where core::BrickLayout is: too many bricks, or too many
    /// samples held twice. Drops resident bricks. To be called, as every setter here, between
    /// frames.
    ReportedStatus setBrickSize(const osg::Vec3i& samples);
    osg::Vec3i getBrickSize() const;
    /// What is done where the volume's size is no multiple of the bricks': by default the last
    /// brick of an axis is smaller. With TRUNCATE less than all of the volume is drawn. Of no
    /// effect on paged voxels. Refused and to be called as setBrickSize().
    ReportedStatus setPartialBricks(core::PartialBricks partial);
    core::PartialBricks getPartialBricks() const { return _partialBricks; }
    /// Samples shared by neighbours: 1 for linear filtering, 3 for cubic.
    ReportedStatus setOverlap(int samples);
    int getOverlap() const { return _overlap; }
    /// Raises the overlap to at least so many, as each appearance that has these voxels does to
    /// what it needs: see VolumeAppearance::getRequiredOverlap(). Refused as by setOverlap(), but
    /// without a report.
    Status requireOverlap(int samples);
    const core::BrickLayout& getLayout() const { return _layout; }

    /// Whether the voxels are drawn from bricks of several levels, read in the background and kept
    /// within the budgets of Paging.h: so are those whose source has more than one level or time
    /// step. Nothing of them is read while a scene is traversed or drawn.
    bool isPaged() const { return _tree.levelCount() > 0; }
    /// The bricks of all levels, "pages": none where the voxels are not paged.
    const core::BrickTree& getTree() const { return _tree; }
    /// Bound on the textures of these voxels in each context where they are paged, besides that of
    /// all of them (see Paging.h): for a region of interest that moves through a large volume. Of
    /// less a coarser level is drawn. Bytes, a megabyte or more; 0 (default): none of its own.
    ReportedStatus setTextureBudget(std::int64_t bytes);
    std::int64_t getTextureBudget() const { return _textureBudget; }
    /// Time steps of the source; 1 where there is none.
    int getStepCount() const { return _stepCount; }
    /// Reads a page, each time anew; an error is not reported. Thread safe.
    Result<VoxelBlock> readPage(std::int64_t page, int step = 0) const;
    /// Lowest and highest value of all that a page stands for, where the source knows them. Thread
    /// safe.
    std::optional<std::pair<double, double>> getPageRange(std::int64_t page, int step = 0) const;
    std::optional<std::pair<double, double>> getPageRange(const core::TreeBrick& page,
                                                          int step = 0) const;

    /// Bound on the bricks that are kept: 32 MiB.
    static constexpr std::size_t CACHE_BYTES = std::size_t(32) << 20;
    /// The samples of a brick, read on the first call, once however many threads ask; without a
    /// copy where the source shares its memory. Copies are kept while they are among the last
    /// CACHE_BYTES that were asked for, and read again after that. Empty (after an error, reported
    /// once) if the source fails, until dirty(). Thread safe. dirty() makes a new block; one that
    /// is held stays as it is.
    using Block = VoxelBlock;
    Block getBrick(std::int64_t brick) const;
    /// Forgets the samples of a brick (held blocks stay), keeps its range; read again when next
    /// asked for.
    void releaseBrick(std::int64_t brick) const;
    /// Lowest and highest finite value of a brick (of alpha, for RGBA): from the source's own
    /// knowledge, else from its data, which is then read. Low > high where there is none, or the
    /// source fails: nothing to draw. Thread safe.
    std::pair<double, double> getBrickRange(std::int64_t brick) const;

    /// The data of a brick, or of all (-1), has changed: it is read and uploaded again.
    void dirty(std::int64_t brick = -1);
    /// Samples of the volume have changed, those of a box, half-open, or of several: of the bricks
    /// that have them only these are read and uploaded again, of paged voxels the pages. The range
    /// of the voxels stays as it is, also one that was found in the data: a table keeps its
    /// meaning. getBrickRange() may then be wider than the data. Parts outside the volume do not
    /// count. To be called between frames, as dirty().
    void dirtyRegion(const core::Box3i& samples) { dirtyRegions({samples}); }
    void dirtyRegions(const std::vector<core::Box3i>& samples);
    /// Boxes that cover the samples within a box that have changed since getChangeCount(), or the
    /// getModifiedCount() of a brick, was `count`; nothing where that is too long ago, or more may
    /// have. Thread safe.
    std::optional<std::vector<core::Box3i>> getChanges(unsigned count,
                                                       const core::Box3i& within) const;
    /// Grows with every change to the data. Thread safe.
    unsigned getChangeCount() const;
    /// The samples of a box inside the volume, read anew, or shared with the source; of time steps
    /// those of the first. An error is not reported. Thread safe.
    Result<VoxelBlock> readSamples(const core::Box3i& samples) const;
    /// Grows with every change to a brick's data; compared by texture caches. Thread safe.
    unsigned getModifiedCount(std::int64_t brick) const;
    /// Changes whenever layout, type, range, spacing or origin do, to a number that no other voxels
    /// have had. Thread safe.
    unsigned getLayoutCount() const { return _layoutCount; }

    /// The name by which a scene file refers to the voxels, for readVoxels(), and its options.
    /// Where it is empty, the scene file holds the voxels.
    void setFileName(const std::string& name) { _fileName = name; }
    const std::string& getFileName() const { return _fileName; }
    /// Where the file of that name was found, as an absolute name of the same form; empty where
    /// that is not known. readVoxels() sets it; a scene file in another folder refers to it.
    void setFilePath(const std::string& path) { _filePath = path; }
    const std::string& getFilePath() const { return _filePath; }
    void setFileOptions(const std::string& options) { _fileOptions = options; }
    const std::string& getFileOptions() const { return _fileOptions; }

    /// Bricks read from the source (copied or shared) since construction.
    std::uint64_t getReadCount() const { return _readCount; }

    /// Bytes of the bricks that are kept, but for those that share the source's memory.
    std::size_t getCachedBytes() const { return _cache.bytes(); }

    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state = nullptr) const override;

protected:
    ~Voxels() override;

private:
    friend struct RenderDataAccess;
    friend struct PickDataAccess;
    struct Brick; // range and modified count of one brick
    using BrickPtr = std::shared_ptr<Brick>;

    ReportedStatus rebuildLayout(const glm::ivec3& brickSize, int overlap,
                                 core::PartialBricks partial);
    void forgetBricks();
    BrickPtr findBrick(std::int64_t brick) const;
    Status makeTree(const VoxelSource* source, int overlap, core::BrickTree& tree) const;
    Block readBrick(int step, int level, const core::Box3i& samples, bool& shared,
                    Status& status) const;
    Block loadBrick(std::int64_t index, Brick& brick) const;
    std::optional<std::pair<double, double>> knownRange(int step, int level,
                                                        const core::Box3i& samples) const;
    core::ValueRange findStepRange(int step) const;
    void findRange() const;
    void widenRange(Brick& brick) const;
    std::vector<std::int64_t> bricksWith(const std::vector<core::Box3i>& samples) const;

    osg::ref_ptr<VoxelSource> _source;
    VoxelSource::Description _description;
    glm::ivec3 _brickSize{256};
    core::PartialBricks _partialBricks = core::PartialBricks::SHRINK_TO_FIT;
    int _overlap = 1;
    core::BrickLayout _layout;
    core::BrickTree _tree;
    int _stepCount = 1;
    std::int64_t _textureBudget = 0;
    std::string _fileName, _filePath, _fileOptions;
    bool _explicitRange = false;
    mutable bool _rangeKnown = true;
    mutable osg::Vec2d _range{0.0, 1.0};
    mutable std::mutex _rangeMutex; // of the three above; taken before _mutex

    mutable std::mutex _mutex;                                  // of what follows
    mutable std::unordered_map<std::int64_t, BrickPtr> _bricks; // those asked for
    unsigned _allModified = 0; // modified count of bricks not dirtied since
    unsigned _lastModified = 0;
    core::ChangeLog _changes;

    mutable BlockCache _cache{CACHE_BYTES};
    mutable RenderDataSlot _renderData; // textures per context
    mutable RenderDataSlot _pickData;   // samples and their ranges, for picking
    mutable std::atomic<std::uint64_t> _readCount{0};
    std::atomic<unsigned> _layoutCount;
};

} // namespace osgVolumizer
