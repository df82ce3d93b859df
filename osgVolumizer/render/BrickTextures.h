#pragma once

#include "BrickCells.h"
#include "CoarseTexture.h"
#include "ContextLimits.h"
#include "JoinedTexture.h"

#include "../Voxels.h"

#include <osg/RenderInfo>
#include <osg/Texture3D>

#include <glm/vec2.hpp>

#include <map>
#include <mutex>
#include <utility>

namespace osgVolumizer {
namespace render {

/// A brick as a texture; made when first asked for, uploaded by OSG when first drawn in a context.
struct BrickTexture
{
    osg::ref_ptr<osg::Texture3D> texture;
    std::size_t bytes = 0;
};

/// The textures of one Voxels, shared by all views and contexts, for as long as its data stays the
/// same. Thread safe.
class BrickTextures : public Voxels::RenderData
{
public:
    /// The textures of these voxels, made on the first call.
    static osg::ref_ptr<BrickTextures> of(const Voxels& voxels);

    /// Null where the source fails. Reads the brick unless it is resident. `gradients`: central
    /// differences in red, green and blue, see gradientDecode(), and the value in alpha.
    BrickTexture get(const Voxels& voxels, std::int64_t brick, bool gradients = false);

    /// The texture for all bricks, made like one brick's image on the first call.
    osg::ref_ptr<JoinedTexture> joined(const Voxels& voxels, const osg::Image& like,
                                       bool gradients);
    /// Whether there is one already.
    bool isJoined(const Voxels& voxels, bool gradients) const;
    /// One texel that stands for all of a brick that shows nothing: its lowest value. Null where it
    /// has none.
    osg::ref_ptr<const osg::Image> texel(const Voxels& voxels, std::int64_t brick, bool gradients);

    CellCache& cells() { return _cells; }

    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state) const override;

private:
    struct Entry
    {
        BrickTexture brick;
        unsigned modifiedCount = 0, layoutCount = 0;
    };

    CellCache _cells;
    mutable std::mutex _mutex;
    std::map<std::pair<std::int64_t, bool>, Entry> _entries; ///< with and without gradients
    struct TexelEntry
    {
        osg::ref_ptr<const osg::Image> image;
        unsigned modifiedCount = 0, layoutCount = 0;
    };
    std::map<std::pair<std::int64_t, bool>, TexelEntry> _texels; ///< likewise
    struct JoinedEntry
    {
        osg::ref_ptr<JoinedTexture> texture;
        unsigned layoutCount = 0;
    };
    std::map<bool, JoinedEntry> _joined; ///< likewise
};

/// Applies a brick's texture to a texture unit, as large and in such a format as suits the context;
/// counts what is uploaded. Call in the draw thread. Returns the texture applied.
CoarseTexture applyBrick(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                         const BrickTexture& brick, unsigned unit);

/// Counts bricks whose texels went to GL in this frame.
void countUploaded(osg::RenderInfo& renderInfo, double bricks, double bytes);

/// Gives a texture, before it is made in a context, the format whose filter suits that. What is
/// read stays the same.
void suitFormat(osg::Texture3D& texture, const ContextLimits& limits);

/// Scale and offset from a texel, as the shader reads it, to the fraction of the voxels' range.
glm::dvec2 texelToRangeFraction(const Voxels& voxels);
/// Scale and offset from a texel of a texture with gradients to the difference of texels per voxel.
glm::vec2 gradientDecode(const Voxels& voxels);

} // namespace render
} // namespace osgVolumizer
