#pragma once

#include "core/Export.h"

#include <osg/BoundingBox>
#include <osg/Matrixd>
#include <osg/Referenced>
#include <osg/RenderInfo>

#include <cstdint>

namespace osgVolumizer {

class Voxels;

/// A brick's texture, bound for drawing. The frames are those of the VolumeSlice that has the
/// callback: object, its own; voxel, as in core/voxels/BrickLayout.h. Matrices are OSG's: a row
/// vector times the matrix.
struct BoundBrick
{
    const Voxels* voxels = nullptr;
    unsigned textureUnit = 0; ///< where the texture is bound as GL_TEXTURE_3D, filtered linearly
    unsigned textureName = 0; ///< OpenGL's
    osg::Matrixd voxelToTexture, objectToTexture;
    /// Of what is to be drawn from this texture: boxes of all bricks tile the volume. A point
    /// between two belongs to the upper one.
    osg::BoundingBoxd boxVoxel, boxObject;
    /// A texel as a shader reads it (in red, or in alpha where bricks hold gradients), times scale
    /// plus offset, is the fraction of the voxels' range.
    double fractionScale = 1.0, fractionOffset = 0.0;
    bool valueInAlpha = false;
    double samplesApart = 1.0; ///< voxels between samples: above 1 of coarse pages
};

/// Draws an application's own geometry with the textures of bricks: a VolumeSlice finds, reads and
/// uploads those that its shape touches, and calls this for each of them in place of drawing. The
/// state is that of the state sets down to the slice, an application's program among them; the
/// model-view matrix is that of the slice's object frame. What lies outside the brick's box is to
/// be left out, as by a `discard`, or neighbours draw it too.
///
/// Called in the draw threads of all contexts, so it may not change itself. The texture stays where
/// it is; all else of OpenGL's state is to be left as it was found, as osg::Geometry does.
class OSGVOLUMIZER_EXPORT BrickDrawCallback : public osg::Referenced
{
public:
    virtual void drawBrick(osg::RenderInfo& renderInfo, const BoundBrick& brick) const = 0;
    /// The texture unit that bricks are to be bound to.
    virtual unsigned textureUnit() const { return 0; }

protected:
    ~BrickDrawCallback() override = default;
};

} // namespace osgVolumizer
