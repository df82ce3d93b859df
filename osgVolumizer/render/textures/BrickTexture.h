#pragma once

#include "../context/ContextLimits.h"
#include "CoarseTexture.h"
#include "ResidentTexture.h"
#include "TexelFormat.h"
#include "Texels.h"

#include <osg/Image>
#include <osg/RenderInfo>
#include <osg/Texture3D>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

namespace osgVolumizer {
namespace render {

/// In which state a brick's data are, and how a texture of another state is brought up to it.
struct BrickChanges
{
    unsigned modifiedCount = 0;
    glm::ivec3 origin{0}; ///< voxel frame; of the brick's first sample
    /// Boxes of texels, voxel frame, that differ from those of a state; nothing where all may.
    std::function<std::optional<std::vector<core::Box3i>>(unsigned modifiedCount)> since;
    std::function<TexelBox(const core::Box3i&)> load;
};

/// One brick as a texture in each context that has drawn it. Keeps no texels: they are asked for
/// when a context lacks them. Thread safe.
class BrickTexture : public ResidentTexture
{
public:
    /// The brick's texels; null where the source fails.
    using Load = std::function<osg::ref_ptr<const osg::Image>()>;

    BrickTexture(const TexelFormat& format, const glm::ivec3& size, std::int64_t volumeTexels)
        : _format(format), _size(size), _volumeTexels(volumeTexels)
    {
    }

    /// Applies the texture to a unit, as large and in such a format as suits the context; coarser
    /// where the card refuses it, and none where it refuses that too (both reported once). Counts
    /// what is uploaded. With `changes` a context that has the texels of an earlier state is given
    /// those that have changed. Call in the draw thread.
    CoarseTexture apply(osg::RenderInfo& renderInfo, const ContextLimits& limits, const Load& load,
                        unsigned unit, const BrickChanges* changes = nullptr);
    bool isIn(unsigned contextId) const override;
    /// Whether any context has it.
    bool isAnywhere() const;
    std::int64_t bytes() const override;

    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state) override;

private:
    struct Copy
    {
        std::mutex mutex; ///< of what follows; not held while texels are loaded
        osg::ref_ptr<osg::Texture3D> texture;
        bool refused = false;
        unsigned modifiedCount = 0; ///< the state that the texels are of
    };

    std::shared_ptr<Copy> copyIn(unsigned contextId);
    bool update(osg::RenderInfo& renderInfo, const BrickChanges& changes, Copy& copy,
                unsigned unit) const;
    void make(osg::RenderInfo& renderInfo, const ContextLimits& limits, const osg::Image& texels,
              Copy& copy, unsigned unit) const;

    const TexelFormat _format;
    const glm::ivec3 _size;
    const std::int64_t _volumeTexels;
    mutable std::mutex _mutex;
    std::map<unsigned, std::shared_ptr<Copy>> _copies; ///< by context
};

/// Counts bricks whose texels went to GL in this frame, all of them or a part, and texels.
void countUploaded(osg::RenderInfo& renderInfo, double bricks, double texels, double bytes);

} // namespace render
} // namespace osgVolumizer
