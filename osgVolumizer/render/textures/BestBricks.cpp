#include "../../BrickParameters.h"
#include "../../Paging.h"
#include "../../core/voxels/VoxelData.h"
#include "TexelFormat.h"

#include <glm/common.hpp>

#include <algorithm>

namespace osgVolumizer {

Result<BrickParameters> bestBrickParameters(osg::State& state, const Voxels& voxels)
{
    constexpr int LARGEST = 256, SMALLEST = 16, BRICKS = 8;
    if (!voxels.valid())
        return Status(ErrorCode::VALUE_INVALID, "best bricks: the voxels have no source");
    const render::ContextLimits limits = render::queryContextLimits(state);
    if (Status status = limits.check(); !status.ok()) return status;
    const osg::Vec3i size = voxels.getSize();
    const glm::ivec3 samples(size.x(), size.y(), size.z());
    const render::TexelFormat format = render::texelFormat(voxels, false);
    const osg::ref_ptr<osg::Texture3D> texture =
        render::makeVoxelTexture(format, samples, core::sampleCount(samples), limits);
    BrickParameters best;
    best.internalFormat = static_cast<unsigned>(texture->getInternalFormat());
    best.format = texture->getSourceFormat();
    best.dataType = texture->getSourceType();
    const std::int64_t texelBytes = best.internalFormat == format.internalFormat
                                        ? format.texelBytes()
                                        : render::floatTexelBytes(format);
    const std::int64_t budget = getPagingBudget().textureBytes;
    const auto bytesOf = [&](int edge) {
        return core::sampleCount(glm::min(samples, glm::ivec3(edge))) * texelBytes;
    };
    int edge = std::min(LARGEST, limits.texture3DSize);
    while (edge / 2 >= SMALLEST && bytesOf(edge) > budget / BRICKS)
        edge /= 2;
    best.brickSize.set(edge, edge, edge);
    best.brickBytes = bytesOf(edge);
    best.brickCount = budget / best.brickBytes;
    return best;
}

} // namespace osgVolumizer
