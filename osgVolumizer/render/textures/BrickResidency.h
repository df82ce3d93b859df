#pragma once

#include "BrickTexture.h"
#include "CellCache.h"
#include "JoinedTexture.h"
#include "Pages.h"

#include "../../Voxels.h"

#include <atomic>
#include <cstdint>
#include <limits>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace render {

/// Whether a context has a brick.
enum class Residency : int
{
    NOT_YET, ///< nothing
    RESIDENT,
    NEVER ///< the source fails
};

/// A brick that a frame wants to draw.
struct BrickRequest
{
    std::int64_t brick = 0;
    bool gradients = false; ///< see texelFormat()
    unsigned frame = 0;
    /// Among those of the same frame: the larger, the sooner it is wanted, and the longer it stays.
    float priority = 0.0f;
};

/// What is resident of one Voxels' bricks, for all views and contexts: textures within a budget,
/// cells, and the one place where samples are asked for. Of the samples themselves it keeps
/// nothing. Thread safe; while a brick is read or converted no lock is held but that brick's own.
class BrickResidency : public RenderData
{
public:
    static constexpr std::int64_t UNLIMITED = std::numeric_limits<std::int64_t>::max();
    static constexpr std::int64_t ALL_BRICKS = -1; ///< in their joined texture

    /// Of these voxels; made on the first call.
    static osg::ref_ptr<BrickResidency> of(const Voxels& voxels);

    /// A brick's samples; empty where the source fails.
    static VoxelBlock load(const Voxels& voxels, std::int64_t brick);
    /// A brick's samples as texels, likewise null.
    static osg::ref_ptr<const osg::Image> texels(const Voxels& voxels, std::int64_t brick,
                                                 bool gradients);

    /// Boxes of a brick's texels, voxel frame, that have changed since its modified count was
    /// another; nothing where all may have. Gradients change next to samples that do.
    static std::optional<std::vector<core::Box3i>> changes(const Voxels& voxels, std::int64_t brick,
                                                           bool gradients, unsigned modifiedCount);
    /// The texels of a box of a brick, and perhaps more. A source that fails is reported.
    static TexelBox texels(const Voxels& voxels, std::int64_t brick, bool gradients,
                           const core::Box3i& box);

    /// The texture of a brick; it is made in a context when that first draws it. Null where the
    /// source fails, which is found out on the first call: that reads the brick at once. It stays
    /// the same where only a part of the brick has changed.
    osg::ref_ptr<BrickTexture> ask(const Voxels& voxels, const BrickRequest& request);
    /// The texture for all bricks; no brick's own is more important.
    osg::ref_ptr<JoinedTexture> joined(const Voxels& voxels, bool gradients, unsigned frame);
    /// Whether there is one already.
    bool isJoined(const Voxels& voxels, bool gradients) const;
    /// One texel that stands for all of a brick that shows nothing: its lowest value. Null where it
    /// has none.
    osg::ref_ptr<const osg::Image> texel(const Voxels& voxels, std::int64_t brick, bool gradients);

    Residency residency(const Voxels& voxels, std::int64_t brick, bool gradients,
                        unsigned contextId) const;
    /// The frame that last asked for a brick; 0 where none has.
    unsigned lastUse(std::int64_t brick, bool gradients) const;
    /// Of the textures in a context, as their texels are uploaded.
    std::int64_t bytes(unsigned contextId) const;

    /// Bound on bytes() in each context, kept whenever a texture is uploaded. One that is larger by
    /// itself is drawn all the same, and is then the only one.
    void setBudget(std::int64_t bytes) { _budget = bytes; }
    std::int64_t budget() const { return _budget; }
    /// Releases textures in the context of a state where the budget has no room for one more: those
    /// that no frame has asked for longest, and of the same frame the least important. Call in the
    /// draw thread before the texture is uploaded.
    void makeRoom(osg::State& state, std::int64_t brick, bool gradients,
                  const ResidentTexture& texture);

    CellCache& cells() { return _cells; }
    /// Those of voxels that are paged, in the present state of the data.
    std::shared_ptr<Pages> pages(const Voxels& voxels);

    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state) const override;

private:
    using Key = std::pair<std::int64_t, bool>; ///< brick, with gradients
    struct Entry
    {
        osg::ref_ptr<BrickTexture> texture; ///< null: the source fails
        unsigned modifiedCount = 0, layoutCount = 0;
    };
    struct TexelEntry
    {
        osg::ref_ptr<const osg::Image> image;
        unsigned modifiedCount = 0, layoutCount = 0;
    };
    struct JoinedEntry
    {
        osg::ref_ptr<JoinedTexture> texture;
        unsigned layoutCount = 0;
    };

    osg::ref_ptr<ResidentTexture> textureOf(const Key& key) const;

    CellCache _cells;
    std::atomic<std::int64_t> _budget{UNLIMITED};
    mutable std::mutex _mutex;     ///< of what follows
    std::shared_ptr<Pages> _pages; ///< null until asked for
    std::map<Key, Entry> _entries;
    std::map<Key, TexelEntry> _texels;
    std::map<bool, JoinedEntry> _joined;         ///< with and without gradients
    std::map<unsigned, std::set<Key>> _uploaded; ///< by context; some may be there no more
};

} // namespace render
} // namespace osgVolumizer
