#include "CullSection.h"

#include "../context/ClipPlanes.h"
#include "../context/Matrices.h"
#include "../context/ReportOnce.h"
#include "../context/Statistics.h"
#include "../draw/SectionDrawable.h"
#include "../volume/CutInForce.h"
#include "../volume/NearestAppearance.h"
#include "../volume/SliceCache.h"
#include "../volume/VolumeInstance.h"
#include "BrickSelection.h"
#include "Cull.h"
#include "SectionBoxes.h"

#include "../../VolumeSlice.h"
#include "../../private/OutwardBox.h"
#include "../context/RenderDataAccess.h"

#include <osgUtil/CullVisitor>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

namespace SectionCull {

/// What is kept with a VolumeSlice.
class SectionData : public RenderData
{
public:
    ColorPointsCache colors;

    using MeshPtr = std::shared_ptr<const SectionMesh>;
    MeshPtr mesh(const std::shared_ptr<const slices::SliceFaces>& faces,
                 const std::vector<core::Box3d>& boxes, double thickness, std::size_t mostBricks)
    {
        const Key key{faces, boxes, thickness, mostBricks};
        {
            std::lock_guard<std::mutex> lock(_mutex);
            if (const MeshPtr* known = _meshes.find(key)) return *known;
        }
        const MeshPtr made = makeSectionMesh(*faces, boxes, thickness, mostBricks);
        std::lock_guard<std::mutex> lock(_mutex);
        return _meshes.add(key, made);
    }

    void resizeGLObjectBuffers(unsigned int maximum) override
    {
        colors.resizeGLObjectBuffers(maximum);
    }
    void releaseGLObjects(osg::State* state) const override { colors.releaseGLObjects(state); }

private:
    struct Key
    {
        std::shared_ptr<const slices::SliceFaces> faces;
        std::vector<core::Box3d> boxes;
        double thickness;
        std::size_t mostBricks;
        bool operator==(const Key& o) const
        {
            return faces == o.faces && thickness == o.thickness && mostBricks == o.mostBricks &&
                   boxes == o.boxes;
        }
    };

    std::mutex _mutex;
    core::RecencyCache<Key, MeshPtr> _meshes{4};
};

osg::Matrixd voxelToObject(const Voxels& voxels)
{
    return osg::Matrixd::scale(voxels.getSpacing()) * osg::Matrixd::translate(voxels.getOrigin());
}

osg::BoundingBox boundsOf(const core::Box3d& box, const glm::dvec3& from)
{
    return outwardBox({box.min - from, box.max - from});
}

VolumeAppearance::Interpolation usedInterpolation(const VolumeSlice& slice, const Voxels& voxels)
{
    const bool oneBrick = !voxels.isPaged() && voxels.getLayout().brickCount() < 2;
    if (slice.getInterpolation() != VolumeAppearance::CUBIC || oneBrick || voxels.getOverlap() >= 3)
        return slice.getInterpolation();
    reportOnce({ErrorCode::NOT_SUPPORTED,
                "VolumeSlice \"" + slice.getName() +
                    "\": cubic interpolation needs bricks that share 3 samples, but the voxels' "
                    "overlap is " +
                    std::to_string(voxels.getOverlap()) + "; interpolation is linear"});
    return VolumeAppearance::LINEAR;
}

ProgramFeatures featuresOf(const VolumeSlice& slice, const VolumeAppearance& appearance,
                           const Voxels& voxels, const osgUtil::CullVisitor& visitor)
{
    ProgramFeatures features;
    features.slab = false;
    features.rgba = voxels.getComponents() == 4;
    const auto interpolation = usedInterpolation(slice, voxels);
    features.nearest = interpolation == VolumeAppearance::NEAREST;
    features.cubic = interpolation == VolumeAppearance::CUBIC;
    features.exact = interpolation == VolumeAppearance::LINEAR && slice.getExactFiltering();
    // The same textures as the volume's.
    features.gradientTexture = appearance.getShading() && !features.rgba &&
                               appearance.getGradients() == VolumeAppearance::PRECOMPUTED;
    features.blendsSteps =
        timeStepsOf(appearance, const_cast<osgUtil::CullVisitor&>(visitor).getFrameStamp()).blended;
    if (visitor.getState()) features.filterBits = filterBitsOf(*visitor.getState());
    return features;
}

// The bricks that are touched, as a volume that shows all its values would have them.
std::vector<SelectedBrick> select(const VolumeAppearance& appearance, const Voxels& voxels,
                                  const ProgramFeatures& features, const TouchedBoxes& section,
                                  bool join, osgUtil::CullVisitor& visitor)
{
    VolumeInstance volume;
    volume.appearance = &appearance;
    volume.section = &section;
    volume.joinsSection = join;
    auto prepared = std::make_shared<PreparedGeometry>();
    prepared->frameToObject = toGlm(voxelToObject(voxels));
    prepared->regionBox = {glm::dvec3(-INFINITY), glm::dvec3(INFINITY)};
    volume.prepared = prepared;
    auto look = std::make_shared<VolumeLook>();
    look->features = features;
    look->features.rayFunction = VolumeAppearance::MAXIMUM; // for which every value counts
    volume.look = look;
    volume.viewId = viewIdOf(visitor);
    volume.steps = timeStepsOf(appearance, visitor.getFrameStamp());
    volume.frameToEye = new osg::RefMatrix(voxelToObject(voxels) * *visitor.getModelViewMatrix());
    selectBricks(volume, voxels, ViewHooks::of(visitor.getCurrentCamera()), visitor);
    return std::move(volume.bricks);
}

// Bricks at the border also have what lies just on it.
std::vector<core::Box3d> widenBoxes(const core::Box3d& extent, std::vector<SelectedBrick>& bricks)
{
    constexpr double MARGIN = 1e-3;
    std::vector<core::Box3d> boxes;
    for (SelectedBrick& brick : bricks) {
        brick.box = brick.clipBox;
        for (int axis = 0; axis < 3; ++axis) {
            if (brick.box.min[axis] <= extent.min[axis]) brick.box.min[axis] -= MARGIN;
            if (brick.box.max[axis] >= extent.max[axis]) brick.box.max[axis] += MARGIN;
        }
        boxes.push_back(brick.box);
    }
    return boxes;
}

// How many bricks a slab may be drawn from at a time: a power of two, besides the table.
std::size_t brickLimit(const ProgramFeatures& features, const osgUtil::CullVisitor& visitor)
{
    constexpr int USUAL = 16, MOST = 8;
    const int known = visitor.getState() ? textureUnitsOf(*visitor.getState()) : 0;
    const int units = (known > 0 ? known : USUAL) - 1;
    int limit = 1;
    while (2 * limit * (features.blendsSteps ? 2 : 1) <= units && 2 * limit <= MOST)
        limit *= 2;
    return std::size_t(limit);
}

void addMesh(const VolumeSlice& slice, const std::shared_ptr<const slices::SliceFaces>& faces,
             const core::Box3d& extent, osgUtil::CullVisitor& visitor, SectionPart& part)
{
    const std::size_t limit = brickLimit(part.features.voxels, visitor);
    const std::vector<core::Box3d> boxes = widenBoxes(extent, part.bricks);
    part.mesh = renderData<SectionData>(slice)->mesh(faces, boxes, slice.getThickness(), limit);
    part.features.brickCount = 1;
    while (std::size_t(part.features.brickCount) < part.mesh->mostBricks)
        part.features.brickCount *= 2;
}

void reportLeftOut(const VolumeSlice& slice)
{
    reportOnce({ErrorCode::NOT_SUPPORTED,
                "VolumeSlice \"" + slice.getName() +
                    "\": its slab reaches across more bricks than there are texture units for; the "
                    "farthest are left out (larger bricks help: Voxels::setBrickSize())"});
}

void setLook(const VolumeSlice& slice, const VolumeAppearance& appearance, const Voxels& voxels,
             SectionPart& part)
{
    part.features.slab = slice.getThickness() > 0.0;
    part.features.reduction = slice.getReduction();
    part.features.translucent = slice.isTranslucent();
    part.colors = renderData<SectionData>(slice)->colors.get(*slice.getTableInForce(appearance),
                                                             voxels.getRange());
    part.features.ramp = part.colors.count == 2 && voxels.getComponents() == 1;
    part.texelToFraction = glm::vec2(texelToRangeFraction(voxels));
    part.thickness = static_cast<float>(slice.getThickness());
    part.period = static_cast<float>(slice.getSamplingPeriod());
    part.opacity = static_cast<float>(slice.getOpacity());
    part.usesTableOpacity = slice.getUsesTableOpacity();
}

// What the state above the slice does to it.
void setAbove(const osg::Matrixd& toObject, const osg::Matrixd& toEye,
              osgUtil::CullVisitor& visitor, SectionPart& part)
{
    const StateAbove above = stateAbove(visitor.getCurrentStateGraph());
    part.features.voxels.fog = above.fog.has_value();
    part.toUsualClip = above.toUsualClip;
    if (above.fog) part.fog = *above.fog;
    for (const core::Plane& plane :
         clipPlanesOf(visitor.getCurrentStateGraph(), *visitor.getCurrentRenderBin()->getStage(),
                      toObject, toEye))
        part.planes.emplace_back(glm::dvec4(plane.normal, plane.offset));
    part.features.voxels.planeCount = int(part.planes.size());
}

// What the appearance's cut leaves.
void setCutOf(const VolumeAppearance& appearance, const Voxels& voxels, SectionPart& part)
{
    VolumeInstance volume;
    volume.appearance = &appearance;
    auto prepared = std::make_shared<PreparedGeometry>();
    volume.prepared = prepared;
    volume.cut = cutInForce(appearance, *prepared, false);
    if (!volume.cut) return;
    part.cut =
        makeCutLook(volume, voxels.getLayout().extent().center(), part.features.voxels, true);
    const osg::Vec3d s = voxels.getSpacing();
    double tolerance = 0.5 * std::min({s.x(), s.y(), s.z()});
    if (volume.cut->field) { // which knows no larger distances than two cells
        const glm::dvec3 cell = volume.cut->field->spacing();
        tolerance = std::max({cell.x, cell.y, cell.z});
    }
    part.cutTolerance = static_cast<float>(tolerance);
}

void addLeaf(const std::shared_ptr<SectionPart>& part, const osg::BoundingBox& bounds,
             osg::RefMatrix& toEye, osgUtil::CullVisitor& visitor)
{
    osg::ref_ptr<osg::StateSet> state;
    if (!part->callback) state = sectionStateSet(part->features);
    if (state) visitor.pushStateSet(state);
    const bool inView =
        visitor.getComputeNearFarMode() == osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR ||
        visitor.updateCalculatedNearFar(toEye, bounds);
    const float depth = static_cast<float>(-(osg::Vec3d(bounds.center()) * toEye).z());
    if (inView && !std::isnan(depth))
        visitor.addDrawableAndDepth(new SectionDrawable(part, bounds), &toEye, depth);
    if (state) visitor.popStateSet();
}

} // namespace SectionCull

void cullSection(VolumeSlice& slice, osgUtil::CullVisitor& visitor)
{
    using namespace SectionCull;
    const VolumeAppearance* appearance = nearestAppearance(visitor.getNodePath());
    const Voxels* voxels = appearance ? appearance->getVoxels() : nullptr;
    if (!voxels || !voxels->valid()) return;
    const auto faces = slices::SliceAccess::faces(slice, *voxels);
    if (!faces || faces->bounds.empty()) return;
    if (!passesOsgCulling(slice, boundsOf(faces->bounds, glm::dvec3(0.0)), visitor)) return;
    const osg::Matrixd toObject =
        osg::Matrixd::translate(faces->center.x, faces->center.y, faces->center.z);
    osg::ref_ptr<osg::RefMatrix> toEye =
        new osg::RefMatrix(toObject * *visitor.getModelViewMatrix());
    osg::StateSet* own = slice.getStateSet();
    if (own) visitor.pushStateSet(own);
    auto part = std::make_shared<SectionPart>();
    part->features.voxels = featuresOf(slice, *appearance, *voxels, visitor);
    part->voxels = voxels;
    const SectionBoxes boxes(*faces, slice.getThickness(), toGlm(voxelToObject(*voxels)),
                             toGlm(*toEye), visitor);
    part->bricks = select(*appearance, *voxels, part->features.voxels, boxes, false, visitor);
    const core::Box3d extent = voxels->getLayout().extent();
    if (!part->bricks.empty()) {
        setLook(slice, *appearance, *voxels, *part);
        setAbove(toObject, *toEye, visitor, *part);
        if (slice.getFollowsCut()) setCutOf(*appearance, *voxels, *part);
        part->callback = slice.getBrickDrawCallback();
        part->objectToVoxel = osg::Matrixd::inverse(voxelToObject(*voxels));
        if (part->callback)
            toEye = new osg::RefMatrix(*visitor.getModelViewMatrix());
        else
            addMesh(slice, faces, extent, visitor, *part);
        part->inPlace = !faces->ownPlaces;
        const osg::Vec3d s = voxels->getSpacing(), o = voxels->getOrigin();
        part->positionScale = 1.0 / glm::dvec3(s.x(), s.y(), s.z());
        part->positionOffset =
            (faces->center - glm::dvec3(o.x(), o.y(), o.z())) * part->positionScale;
        // Then one texture for all of them will do.
        if (part->mesh && part->mesh->leavesOut && !voxels->isPaged()) {
            part->bricks =
                select(*appearance, *voxels, part->features.voxels, boxes, true, visitor);
            addMesh(slice, faces, extent, visitor, *part);
        }
        if (part->mesh && part->mesh->leavesOut) reportLeftOut(slice);
        const glm::dvec3 from = part->callback ? glm::dvec3(0.0) : faces->center;
        addLeaf(part, boundsOf(faces->bounds, from), *toEye, visitor);
        count(visitor.getCurrentCamera(), visitor.getFrameStamp(), "osgVolumizer slice bricks",
              double(part->bricks.size()));
    }
    if (own) visitor.popStateSet();
}

} // namespace render
} // namespace osgVolumizer
