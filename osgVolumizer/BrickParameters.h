#pragma once

#include "Error.h"

#include <osg/Vec3i>

#include <cstdint>

namespace osg {
class State;
}

namespace osgVolumizer {

class Voxels;

/// How voxels are best held as textures of a context; those are always three-dimensional.
struct BrickParameters
{
    /// Samples per axis, for Voxels::setBrickSize(): as large as the context and the budget allow.
    osg::Vec3i brickSize;
    /// As OpenGL numbers them: the texture's, that the context filters fast, without losing values,
    /// and those of what is uploaded.
    unsigned internalFormat = 0, format = 0, dataType = 0;
    std::int64_t brickBytes = 0; ///< of the texture of such a brick
    std::int64_t brickCount = 0; ///< of those that fit into the budget for textures: see Paging.h
};

/// The parameters that suit a context, which is to be current, for voxels of a size and type.
/// Bricks are no larger than a side of a 3D texture may be, than 256 samples, or than an eighth of
/// the budget, so that what turns up piece by piece is not uploaded all at once. VALUE_INVALID
/// where the voxels have no source; NOT_SUPPORTED where the context cannot draw volumes.
OSGVOLUMIZER_EXPORT Result<BrickParameters> bestBrickParameters(osg::State& state,
                                                                const Voxels& voxels);

} // namespace osgVolumizer
