#include "BrickJoining.h"

#include "../textures/BrickResidency.h"
#include "../textures/JoinedBricks.h"
#include "BrickSelection.h"

#include "../../core/voxels/VoxelData.h"

#include <osgUtil/CullVisitor>

#include <algorithm>

namespace osgVolumizer {
namespace render {

namespace {

// A texture for each brick lets a driver move those it does not need out of the graphics card's
// memory; one for all does not.
constexpr double MAXIMUM_BYTES = 1024.0 * 1024.0 * 1024.0;

// What drawing a volume in many bricks costs, compared with one: measured on llvmpipe with 64.
// Twice that before those are taken apart that have been joined, so that views do not go back and
// forth.
constexpr double BRICKS_COST = 1.4, RELUCTANCE = 2.0;

core::Box3d unionOf(const std::vector<SelectedBrick>& bricks)
{
    core::Box3d box;
    for (const SelectedBrick& brick : bricks) {
        box.expand(brick.box.min);
        box.expand(brick.box.max);
    }
    return box;
}

// As they will be in the context. Only volumes much smaller than the bound are stored in a wider
// format there: see makeVoxelTexture().
double joinedBytes(const Voxels& voxels, bool gradients)
{
    return double(core::sampleCount(voxels.getLayout().size())) *
           double(texelFormat(voxels, gradients).texelBytes());
}

bool canBeJoined(const VolumeInstance& volume, const Voxels& voxels, const BrickResidency& textures,
                 osgUtil::CullVisitor& visitor)
{
    const ProgramFeatures& features = volume.look->features;
    const core::BrickLayout& layout = voxels.getLayout();
    if (layout.brickCount() < 2 || volume.bricks.empty() || !(features.slab || volume.section) ||
        !(volume.prepared->voxelFrame || features.tetrahedra) ||
        volume.appearance->getCombineRule() == VolumeAppearance::PAINT)
        return false;
    // Filters must find in a brick all that they need, since its neighbours may not be there.
    if (layout.overlap() < (features.cubic ? 3 : 1)) return false;
    const osg::State* state = visitor.getState();
    const glm::ivec3 size = voxels.getLayout().size();
    return state && std::max({size.x, size.y, size.z}) <= texture3DSizeOf(*state) &&
           joinedBytes(voxels, features.gradientTexture) <=
               std::min(MAXIMUM_BYTES, double(textures.budget()));
}

// By all bricks that were ever needed, so that it does not depend on the view. Where nothing is
// left out, joining always pays.
bool isWorthJoining(const VolumeInstance& volume, const SelectedBrick& joined, bool isJoined)
{
    if (!volume.prepared->voxelFrame) return true; // they have no order
    if (volume.section) return isJoined || volume.joinsSection;
    if (volume.bricks.size() == 1) return isJoined;
    if (!joined.cells) return true;
    const double cost = (isJoined ? RELUCTANCE : 1.0) * BRICKS_COST;
    return joined.cells->marchedVolume <= cost * joined.cells->apartMarchedVolume;
}

JoinedPiece pieceOf(const Voxels& voxels, std::int64_t brick)
{
    JoinedPiece piece;
    piece.brick = brick;
    piece.modifiedCount = voxels.getModifiedCount(brick);
    piece.samples = voxels.getLayout().brick(brick).samples;
    piece.texelsOrigin = piece.samples.min;
    return piece;
}

JoinedPiece pieceOf(const Voxels& voxels, std::int64_t brick, bool gradients)
{
    JoinedPiece piece = pieceOf(voxels, brick);
    if (!gradients || voxels.getLayout().overlap() < 3) return piece;
    // Gradients of a brick's outermost samples have only one side; the neighbour has both.
    const glm::ivec3 size = voxels.getLayout().size();
    for (int axis = 0; axis < 3; ++axis) {
        if (piece.samples.min[axis] > 0) ++piece.samples.min[axis];
        if (piece.samples.max[axis] < size[axis]) --piece.samples.max[axis];
    }
    return piece;
}

// The pieces of bricks that are not drawn, but that rays pass; false where that cannot be done.
bool addLeftOut(const VolumeInstance& volume, const Voxels& voxels, BrickResidency& textures,
                const LeftOutBricks& leftOut, const core::Box3d& box,
                std::vector<JoinedPiece>& pieces)
{
    const bool gradients = volume.look->features.gradientTexture;
    const auto isPassed = [&](std::int64_t brick) {
        return !intersection(voxels.getLayout().brick(brick).clipBox, box).empty();
    };
    for (const std::int64_t brick : leftOut.empty) {
        if (!isPassed(brick)) continue;
        JoinedPiece piece = pieceOf(voxels, brick);
        piece.emptyTexel = textures.texel(voxels, brick, gradients);
        if (!piece.emptyTexel) return false;
        pieces.push_back(std::move(piece));
    }
    for (const std::int64_t brick : leftOut.cutAway) {
        if (!isPassed(brick)) continue;
        pieces.push_back(pieceOf(voxels, brick, gradients));
    }
    return true;
}

std::shared_ptr<const BrickCells> joinCells(const VolumeInstance& volume, const Voxels& voxels,
                                            BrickResidency& textures, const OccupancyQuery& query)
{
    std::vector<CellCache::Part> parts;
    for (const SelectedBrick& brick : volume.bricks) {
        if (!brick.cells) return nullptr;
        parts.emplace_back(brick.index, brick.cells);
    }
    return textures.cells().join(voxels, query, parts);
}

} // namespace

void joinBricks(VolumeInstance& volume, const Voxels& voxels, const OccupancyQuery& query,
                const LeftOutBricks& leftOut, osgUtil::CullVisitor& visitor)
{
    const osg::ref_ptr<BrickResidency> textures = BrickResidency::of(voxels);
    if (leftOut.unreadable || !canBeJoined(volume, voxels, *textures, visitor)) return;
    const bool gradients = volume.look->features.gradientTexture;
    SelectedBrick all;
    all.box = unionOf(volume.bricks);
    all.cells = joinCells(volume, voxels, *textures, query);
    if (!isWorthJoining(volume, all, textures->isJoined(voxels, gradients))) return;
    auto joined = std::make_shared<JoinedBricks>();
    if (!addLeftOut(volume, voxels, *textures, leftOut, all.box, joined->pieces)) return;
    joined->texture = textures->joined(voxels, gradients, frameOf(visitor));
    if (joined->texture->isRefused(visitor.getState()->getContextID())) return;
    for (const SelectedBrick& brick : volume.bricks)
        joined->pieces.push_back(pieceOf(voxels, brick.index, gradients));
    joined->voxels = &voxels;
    joined->gradients = gradients;
    const glm::vec3 size(voxels.getLayout().size());
    all.clipBox = voxels.getLayout().extent();
    all.textureScale = 1.0f / size;
    all.textureOffset = 0.5f / size;
    all.brickCount = static_cast<int>(volume.bricks.size());
    if (all.cells) {
        volume.cellSize = all.cells->cellSize;
        volume.cellCount = all.cells->cellCount;
        volume.occupiedCells = all.cells->occupiedCount;
    }
    joined->apart = std::move(volume.bricks);
    all.joined = std::move(joined);
    volume.bricks.clear();
    volume.bricks.push_back(std::move(all));
}

} // namespace render
} // namespace osgVolumizer
