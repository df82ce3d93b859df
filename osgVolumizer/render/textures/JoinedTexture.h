#pragma once

#include "../context/ContextLimits.h"
#include "ResidentTexture.h"
#include "TexelFormat.h"
#include "Texels.h"

#include "../../core/geometry/Box.h"

#include <osg/Image>
#include <osg/RenderInfo>
#include <osg/Texture3D>

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace render {

/// What a brick has in a joined texture.
struct JoinedPiece
{
    std::int64_t brick = 0;
    unsigned modifiedCount = 0;
    /// One texel that stands for all of a brick that shows nothing; null where all are needed.
    osg::ref_ptr<const osg::Image> emptyTexel;
    core::Box3i samples; ///< voxel frame, half-open; that are written
    /// Of the first of the brick's texels, voxel frame.
    glm::ivec3 texelsOrigin{0};
};

/// One 3D texture for all bricks of a volume: drawn as one brick, but read, uploaded and changed
/// brick by brick. Per context it has those bricks that its views have needed. Keeps no texels:
/// they are asked for when a context lacks them. Thread safe.
class JoinedTexture : public ResidentTexture
{
public:
    /// A brick's texels; null where the source fails.
    using Load = std::function<osg::ref_ptr<const osg::Image>(std::int64_t brick)>;
    /// Where those come from of which only some have changed, as BrickChanges.
    struct Changes
    {
        std::function<std::optional<std::vector<core::Box3i>>(std::int64_t brick,
                                                              unsigned modifiedCount)>
            since;
        std::function<TexelBox(std::int64_t brick, const core::Box3i&)> load;
    };

    /// \param size of the volume, samples
    JoinedTexture(const TexelFormat& format, const glm::ivec3& size) : _format(format), _size(size)
    {
    }

    /// Applies the texture to a unit, after writing those of the pieces that the context lacks, or
    /// what of them has changed; counts what is uploaded. False where the card refuses the texture.
    /// Call in the draw thread.
    bool apply(osg::RenderInfo& renderInfo, const ContextLimits& limits,
               const std::vector<JoinedPiece>& pieces, const Load& load, const Changes& changes,
               unsigned unit);
    /// Whether the context has refused the texture.
    bool isRefused(unsigned contextId) const;
    /// Whether the context has the texels of a brick in one state of its data, or what stands for
    /// them.
    bool has(unsigned contextId, std::int64_t brick, unsigned modifiedCount) const;
    bool isIn(unsigned contextId) const override;
    std::int64_t bytes() const override;

    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state) override;

private:
    struct Written
    {
        unsigned modifiedCount;
        bool empty;
        core::Box3i samples;
    };
    struct Contents
    {
        std::mutex mutex; ///< of what follows; not held while texels are loaded
        osg::ref_ptr<osg::Texture3D> texture;
        std::map<std::int64_t, Written> bricks;
        std::atomic<bool> refused{false};

        bool lacks(const JoinedPiece& piece) const;
        /// The count of the texels of all of a piece that are there; nothing where they are not.
        std::optional<unsigned> written(const JoinedPiece& piece) const;
    };

    std::shared_ptr<Contents> find(unsigned contextId) const;
    std::shared_ptr<Contents> contentsIn(unsigned contextId);
    std::vector<std::pair<unsigned, std::shared_ptr<Contents>>> allContents() const;
    bool make(osg::State& state, const ContextLimits& limits, Contents& contents,
              unsigned unit) const;
    bool prepare(osg::State& state, const ContextLimits& limits,
                 const std::vector<JoinedPiece>& pieces, const Changes& changes, Contents& contents,
                 unsigned unit, std::vector<const JoinedPiece*>& lacking) const;
    bool update(osg::RenderInfo& renderInfo, const JoinedPiece& piece, const Changes& changes,
                Contents& contents) const;
    static void writeEmpty(osg::State& state, const JoinedPiece& piece, Contents& contents);
    static bool write(osg::State& state, const JoinedPiece& piece, const osg::Image& texels,
                      Contents& contents);

    const TexelFormat _format;
    const glm::ivec3 _size;
    mutable std::mutex _mutex;
    std::map<unsigned, std::shared_ptr<Contents>> _contents; ///< by context
};

} // namespace render
} // namespace osgVolumizer
