#pragma once

#include "ContextLimits.h"

#include "../core/geometry/Box.h"

#include <osg/Image>
#include <osg/RenderInfo>
#include <osg/Texture3D>
#include <osg/buffered_value>

#include <cstdint>
#include <map>
#include <mutex>
#include <vector>

namespace osgVolumizer {
namespace render {

/// What a brick has in a joined texture.
struct JoinedPiece
{
    std::int64_t brick = 0;
    unsigned modifiedCount = 0;
    /// The brick's texels; or one texel, that stands for all of a brick that shows nothing.
    osg::ref_ptr<const osg::Image> texels;
    bool empty = false;
    core::Box3i samples; ///< voxel frame, half-open; that are written
    /// Of the image's first texel, voxel frame.
    glm::ivec3 imageOrigin{0};
};

/// One 3D texture for all bricks of a volume: drawn as one brick, but read, uploaded and changed
/// brick by brick. Per context it has those bricks that its views have needed. Thread safe.
class JoinedTexture : public osg::Referenced
{
public:
    /// \param texture without an image; gets its size and format from the voxels' size and from an
    /// image of one of the bricks
    JoinedTexture(osg::Texture3D* texture, const glm::ivec3& size, const osg::Image& like);

    osg::Texture3D* texture() const { return _texture.get(); }
    /// Applies the texture to a unit, after writing those of the pieces that the context lacks;
    /// counts what is uploaded. Call in the draw thread.
    void apply(osg::RenderInfo& renderInfo, const ContextLimits& limits,
               const std::vector<JoinedPiece>& pieces, unsigned unit);

private:
    struct Written
    {
        unsigned modifiedCount;
        bool empty;
        core::Box3i samples;
    };
    using Contents = std::map<std::int64_t, Written>; ///< by brick

    static void write(osg::State& state, const JoinedPiece& piece, Contents& contents);

    osg::ref_ptr<osg::Texture3D> _texture;
    std::mutex _mutex;
    osg::buffered_object<Contents> _contents;
};

/// The bricks of a volume that a view needs, in the texture that they share.
struct JoinedBricks
{
    osg::ref_ptr<JoinedTexture> texture;
    std::vector<JoinedPiece> pieces;
};

} // namespace render
} // namespace osgVolumizer
