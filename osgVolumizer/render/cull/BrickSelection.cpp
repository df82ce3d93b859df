#include "BrickSelection.h"

#include "../draw/RayFunctions.h"
#include "../textures/BrickResidency.h"
#include "BrickJoining.h"
#include "SelectPages.h"

#include <osgUtil/CullVisitor>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

// Cuts a brick down to where it shows something; false where that is nowhere.
bool cutToOccupied(VolumeInstance& volume, const Voxels& voxels, BrickResidency& textures,
                   const OccupancyQuery& query, bool skipping, SelectedBrick& brick,
                   LeftOutBricks& leftOut)
{
    if (voxels.getComponents() == 1) {
        const auto values = voxels.getBrickRange(brick.index);
        if (!(values.first <= values.second) ||
            !showsValues(voxels, query, values.first, values.second)) {
            ++volume.emptyBricks;
            leftOut.empty.push_back(brick.index);
            return false;
        }
    }
    if (!(volume.prepared->voxelFrame || volume.look->features.tetrahedra) || !skipping)
        return true;
    brick.cells = textures.cells().get(voxels, brick.index, query);
    if (!brick.cells) {
        leftOut.unreadable = true;
        return false;
    }
    volume.cellSize = brick.cells->cellSize;
    volume.cellCount += brick.cells->cellCount;
    volume.occupiedCells += brick.cells->occupiedCount;
    // A layer that reaches into the box from a slice outside would be lost.
    const ProgramFeatures& features = volume.look->features;
    if (features.slab || !features.preIntegrated)
        brick.box = intersection(brick.box, brick.cells->box);
    if (brick.box.empty()) {
        ++volume.emptyBricks;
        leftOut.cutAway.push_back(brick.index);
        return false;
    }
    volume.homogeneousBricks += brick.cells->homogeneous;
    return true;
}

// Nearer bricks are more important.
float priorityOf(const core::Box3d& box, const VolumeInstance& volume)
{
    if (!volume.prepared->voxelFrame) return 0.0f;
    const glm::dvec3 center = box.center();
    const osg::Vec3d centerEye = osg::Vec3d(center.x, center.y, center.z) * *volume.frameToEye;
    return -static_cast<float>(centerEye.length());
}

} // namespace

osg::BoundingBox objectBounds(const core::Box3d& box, const glm::dmat4& frameToObject)
{
    const glm::dvec3 center(frameToObject * glm::dvec4(box.center(), 1.0));
    const glm::dvec3 half = 0.5 * box.size();
    const glm::dvec3 reach = half.x * glm::abs(glm::dvec3(frameToObject[0])) +
                             half.y * glm::abs(glm::dvec3(frameToObject[1])) +
                             half.z * glm::abs(glm::dvec3(frameToObject[2]));
    const glm::dvec3 low = center - reach, high = center + reach;
    return {osg::Vec3(osg::Vec3d(low.x, low.y, low.z)),
            osg::Vec3(osg::Vec3d(high.x, high.y, high.z))};
}

OccupancyQuery occupancyQuery(const VolumeInstance& volume, const Voxels& voxels)
{
    const osg::Vec2d range = voxels.getRange();
    OccupancyQuery query;
    query.table = &volume.look->table;
    query.cubic = volume.look->features.cubic;
    query.isosurface = rowOf(volume.look->features.rayFunction).showsIsoValueOnly;
    query.cut = volume.cut;
    query.isoFraction = (volume.appearance->getIsoValue() - range.x()) / (range.y() - range.x());
    return query;
}

bool isClipped(const VolumeInstance& volume, const core::Box3d& box)
{
    if (volume.cut && volume.cut->keepsNothingOf(boxToCut(*volume.appearance->getVoxels(), box)))
        return true;
    return std::any_of(
        volume.clipPlanes.begin(), volume.clipPlanes.end(), [&box](const core::Plane& plane) {
            return plane.distance(glm::mix(box.min, box.max,
                                           glm::greaterThan(plane.normal, glm::dvec3(0.0)))) < 0.0;
        });
}

unsigned frameOf(const osgUtil::CullVisitor& visitor)
{
    const osg::FrameStamp* stamp = visitor.getFrameStamp();
    return stamp ? stamp->getFrameNumber() : 0;
}

bool isWorthSkipping(const VolumeInstance& volume)
{
    // What it costs to look for the ends of a ray's occupied part, in samples.
    constexpr double COST = 15.0;
    if (!volume.look->features.slab || volume.cellCount == 0) return false;
    const bool deformed = !volume.prepared->voxelFrame;
    const double emptyShare = 1.0 - double(volume.occupiedCells) / double(volume.cellCount);
    double boxEdge =
        volume.cellSize * std::cbrt(double(volume.cellCount) / double(volume.bricks.size()));
    // There the ends are looked for in each tetrahedron.
    if (deformed)
        boxEdge = std::min(boxEdge, volume.prepared->meanEdge / volume.look->step *
                                        volume.look->voxelsPerSample);
    return emptyShare * boxEdge > COST * volume.look->voxelsPerSample;
}

void selectBricks(VolumeInstance& volume, const Voxels& voxels, const ViewHooks& hooks,
                  osgUtil::CullVisitor& visitor)
{
    if (voxels.isPaged()) return selectPages(volume, voxels, hooks, visitor);
    const core::BrickLayout& layout = voxels.getLayout();
    const osg::ref_ptr<BrickResidency> textures = BrickResidency::of(voxels);
    const PreparedGeometry& prepared = *volume.prepared;
    const ProgramFeatures& features = volume.look->features;
    const OccupancyQuery query = occupancyQuery(volume, voxels);
    const unsigned frame = frameOf(visitor);
    LeftOutBricks leftOut;
    for (std::int64_t i = 0; i < layout.brickCount(); ++i) {
        const core::BrickPlace place = layout.brick(i);
        const glm::vec3 size(place.samples.size());
        SelectedBrick brick;
        brick.index = i;
        brick.box = brick.clipBox = place.clipBox;
        brick.textureScale = 1.0f / size;
        brick.textureOffset = (0.5f - glm::vec3(place.samples.min)) / size;
        if (volume.section) {
            if (!volume.section->touches(brick.box)) continue;
        } else if (prepared.voxelFrame) {
            brick.box = intersection(brick.box, prepared.regionBox);
            if (brick.box.empty()) continue;
            if (visitor.isCulled(objectBounds(brick.box, prepared.frameToObject))) continue;
            if (isClipped(volume, brick.box)) continue;
        }
        // Gathered rays count every value, shown or not.
        if (!features.gathers() &&
            !cutToOccupied(volume, voxels, *textures, query, hooks.skipping, brick, leftOut))
            continue;
        brick.texels.texture = textures->ask(
            voxels, {i, features.gradientTexture, frame, priorityOf(brick.box, volume)});
        brick.texels.voxels = &voxels;
        brick.texels.index = i;
        brick.texels.gradients = features.gradientTexture;
        if (brick.texels.texture)
            volume.bricks.push_back(std::move(brick));
        else
            leftOut.unreadable = true;
    }
    if (hooks.joining) joinBricks(volume, voxels, query, leftOut, visitor);
}

} // namespace render
} // namespace osgVolumizer
