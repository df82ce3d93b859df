#pragma once

#include "../context/ContextResources.h"
#include "../context/ProgramInterface.h"
#include "ProgramFeatures.h"
#include "VolumeMesh.h"

#include "../../core/sampling/View.h"

#include <osg/RenderInfo>

namespace osgVolumizer {
namespace render {

class Uniforms;

/// What all batches of a drawable are drawn with.
struct BatchDrawing
{
    osg::RenderInfo& renderInfo;
    const ContextLimits& limits;
    const Uniforms& uniforms;
    const ProgramFeatures& features;
    const core::View& view;
    ///< That textures are applied to.
    unsigned voxelUnit = UNIT_VOXELS, cellUnit = UNIT_CELLS, nextVoxelUnit = UNIT_NEXT_VOXELS;
    /// Which pages are hidden by opaque geometry is found out; null: it is not.
    ContextResources* tests = nullptr;
};

/// The batch of a brick, without triangles.
BrickBatch batchOf(const SelectedBrick& brick);

/// Gives the program textures and values of a batch; false where the card refuses the texture.
bool setBatch(const BatchDrawing& drawing, const BrickBatch& batch);

/// Draws the triangles of a batch from a mesh that is bound. What the card refuses is drawn the
/// next best way: bricks that cannot share a texture one by one, far to near.
void drawBatch(const BatchDrawing& drawing, const BrickBatch& batch);

} // namespace render
} // namespace osgVolumizer
