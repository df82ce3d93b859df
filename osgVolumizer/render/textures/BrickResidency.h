#pragma once

#include "BrickCells.h"
#include "BrickTexture.h"
#include "JoinedTexture.h"

#include "../../Voxels.h"

#include <map>
#include <mutex>
#include <utility>

namespace osgVolumizer {
namespace render {

/// What there is of a brick in a context.
enum class Residency : int
{
    NOT_YET, ///< nothing
    RESIDENT,
    NEVER ///< the source fails
};

/// What is resident of one Voxels' bricks, for all views and contexts: textures, cells, and the one
/// place where samples are asked for. Of the samples themselves it keeps nothing. Thread safe; no
/// lock is held while a brick is read or converted, but for that of the brick.
class BrickResidency : public RenderData
{
public:
    /// Of these voxels; made on the first call.
    static osg::ref_ptr<BrickResidency> of(const Voxels& voxels);

    /// A brick's samples; empty where the source fails.
    static VoxelBlock load(const Voxels& voxels, std::int64_t brick);
    /// A brick's samples as texels, likewise null.
    static osg::ref_ptr<const osg::Image> texels(const Voxels& voxels, std::int64_t brick,
                                                 bool gradients);

    /// The texture of a brick that is drawn in a frame. Null where the source fails, which is found
    /// out on the first call. `gradients`: see texelFormat().
    osg::ref_ptr<BrickTexture> get(const Voxels& voxels, std::int64_t brick, bool gradients,
                                   unsigned frame);
    /// The texture for all bricks.
    osg::ref_ptr<JoinedTexture> joined(const Voxels& voxels, bool gradients);
    /// Whether there is one already.
    bool isJoined(const Voxels& voxels, bool gradients) const;
    /// One texel that stands for all of a brick that shows nothing: its lowest value. Null where it
    /// has none.
    osg::ref_ptr<const osg::Image> texel(const Voxels& voxels, std::int64_t brick, bool gradients);

    Residency residency(const Voxels& voxels, std::int64_t brick, bool gradients,
                        unsigned contextId) const;
    /// The frame that last drew a brick; 0 where none has.
    unsigned lastUse(std::int64_t brick, bool gradients) const;
    /// Of the textures in a context, as their texels are uploaded.
    std::int64_t bytes(unsigned contextId) const;

    CellCache& cells() { return _cells; }

    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state) const override;

private:
    using Key = std::pair<std::int64_t, bool>; ///< brick, with gradients
    struct Entry
    {
        osg::ref_ptr<BrickTexture> texture; ///< null: the source fails
        unsigned modifiedCount = 0, layoutCount = 0, lastFrame = 0;
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

    CellCache _cells;
    mutable std::mutex _mutex;
    std::map<Key, Entry> _entries;
    std::map<Key, TexelEntry> _texels;
    std::map<bool, JoinedEntry> _joined; ///< with and without gradients
};

} // namespace render
} // namespace osgVolumizer
