#pragma once

#include "VoxelSource.h"
#include "core/voxels/Downsample.h"
#include "core/voxels/VoxelData.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <shared_mutex>
#include <unordered_map>
#include <utility>
#include <vector>

namespace osgVolumizer {

class Voxels;

/// The voxels of another source, of which some have been changed: blocks of BLOCK^3 samples that
/// were written to are in memory, all others are read from the source as before. Levels follow:
/// of the coarser ones those samples are made again that stand for what has changed.
///
/// Reading is thread safe, also while another thread writes: what is read is of each block from
/// before or after. Writing is for one thread at a time, between frames, and tells nobody: see
/// Voxels::dirtyRegions(), which interact/Sculpt.h calls.
class OSGVOLUMIZER_EXPORT EditableVoxelSource : public VoxelSource
{
    struct Block;
    using BlockPtr = std::shared_ptr<Block>;

public:
    META_Object(osgVolumizer, EditableVoxelSource);

    static constexpr int BLOCK = 16; ///< edge of a block, samples
    /// Bound on the blocks in memory, unless another is set: 1 GiB.
    static constexpr std::size_t DEFAULT_MAXIMUM_BYTES = std::size_t(1) << 30;

    EditableVoxelSource() = default;
    explicit EditableVoxelSource(VoxelSource* base) : _base(base) {}
    /// Shares the source and all blocks, which are copied when one of the two is written to.
    EditableVoxelSource(const EditableVoxelSource& o,
                        const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// The source whose voxels these were.
    VoxelSource* getBase() const { return _base.get(); }
    /// Whether any sample was written to since construction, and not put back by an Edit.
    bool isChanged() const;
    /// Of the blocks in memory, all levels.
    std::size_t getBytes() const;
    void setMaximumBytes(std::size_t bytes) { _maximumBytes = bytes; }
    std::size_t getMaximumBytes() const { return _maximumBytes; }
    /// How coarser levels are made: as those of the source were. Default: MEAN.
    void setLevelRule(core::LevelRule rule) { _levelRule = rule; }
    core::LevelRule getLevelRule() const { return _levelRule; }

    /// What is or was in some blocks, for undo: without copies of what is the same.
    class Edit
    {
    public:
        /// Boxes that cover the samples of level 0 that have changed.
        const std::vector<core::Box3i>& boxes() const { return _boxes; }
        /// Of the blocks before and after; some may be shared with other edits and the source.
        std::size_t bytes() const { return _bytes; }

    private:
        friend class EditableVoxelSource;
        struct Change
        {
            int level;
            glm::ivec3 block;
            BlockPtr before, after; ///< null: the base's samples
        };
        std::vector<Change> _changes;
        std::vector<core::Box3i> _boxes;
        std::size_t _bytes = 0;
    };

    /// Reads the blocks of a box of level 0, and what coarser levels need for it, so that write()
    /// cannot fail there. Refused with what the source says, and TOO_LARGE beyond
    /// getMaximumBytes(): nothing changes.
    Status hold(const core::Box3i& region);
    /// Replaces the samples of a box of level 0 that is held: tightly packed. VALUE_INVALID where
    /// it is not, INDEX_OUT_OF_RANGE beyond the volume: nothing changes.
    Status write(const core::Box3i& region, const void* samples);
    /// Makes the coarser levels again, where samples of level 0 have changed.
    void updateLevels(const std::vector<core::Box3i>& changed);

    /// From now on what is written is noted.
    void beginEdit();
    /// Until now. \param boxes for Edit::boxes()
    Edit endEdit(std::vector<core::Box3i> boxes);
    /// Puts the blocks of an edit back as they were before it, or after it, to the bit. Expects
    /// them to be as they were after it, or before.
    void undo(const Edit& edit);
    void redo(const Edit& edit);

    Description describe() const override;
    Status read(const core::Box3i& region, void* destination) const override;
    /// May be wider than the data where only a part of the region has been changed.
    std::optional<std::pair<double, double>> valueRange(const core::Box3i& region) const override;
    VoxelBlock share(const core::Box3i& region) const override;
    int levelCount() const override;
    Status readLevel(int level, const core::Box3i& region, void* destination) const override;
    std::optional<std::pair<double, double>> levelRange(int level,
                                                        const core::Box3i& region) const override;
    int pageSize() const override;

protected:
    ~EditableVoxelSource() override = default;

private:
    struct Key
    {
        int level = 0;
        glm::ivec3 block{0};
        bool operator==(const Key& o) const { return level == o.level && block == o.block; }
    };
    struct KeyHash
    {
        std::size_t operator()(const Key& key) const;
    };
    using Blocks = std::unordered_map<Key, BlockPtr, KeyHash>;

    template <class Function>
    bool forOwnBlocks(int level, const core::Box3i& region, Function&& function) const;
    core::Box3i samplesOf(const Key& key) const;
    std::vector<Key> missing(const core::Box3i& region) const;
    Status readBlock(const Key& key, BlockPtr& block) const;
    Status readBlocks(const std::vector<Key>& keys);
    void paste(int level, const core::Box3i& region, const unsigned char* samples);
    void put(const Edit& edit, bool after);

    osg::ref_ptr<VoxelSource> _base;
    std::size_t _maximumBytes = DEFAULT_MAXIMUM_BYTES;
    core::LevelRule _levelRule = core::LevelRule::MEAN;
    mutable std::shared_mutex _mutex; // of what follows
    Blocks _blocks;
    std::size_t _bytes = 0;
    bool _editing = false;
    Blocks _before; // of the blocks that were written to since beginEdit(); null: of the base
};

/// Lets voxels be written to: their source becomes an EditableVoxelSource of the present one,
/// unless it is one. Textures stay. Refused: VALUE_INVALID without voxels, NOT_SUPPORTED for
/// several time steps.
OSGVOLUMIZER_EXPORT Result<osg::ref_ptr<EditableVoxelSource>> makeEditable(Voxels& voxels);

} // namespace osgVolumizer
