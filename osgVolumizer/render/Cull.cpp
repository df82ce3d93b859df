#include "Cull.h"

#include "BrickSelection.h"
#include "Look.h"
#include "Matrices.h"
#include "Merger.h"
#include "SliceCache.h"
#include "Statistics.h"
#include "VolumeInstance.h"

#include <osgUtil/CullVisitor>

#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

const VolumeAppearance* nearestAppearance(const osg::NodePath& path)
{
    for (auto node = path.rbegin(); node != path.rend(); ++node)
        if (const auto* appearance = dynamic_cast<const VolumeAppearance*>(*node))
            return appearance;
    return nullptr;
}

// What osgUtil::CullVisitor does for every drawable before it looks at it: false if the user's
// callback or the frustum rejects it.
bool passesOsgCulling(VolumeGeometry& geometry, osgUtil::CullVisitor& visitor)
{
    if (osg::Callback* callback = geometry.getCullCallback()) {
        osg::RenderInfo& info = visitor.getRenderInfo();
        if (osg::DrawableCullCallback* d = callback->asDrawableCullCallback()) {
            if (d->cull(&visitor, &geometry, &info)) return false;
        } else {
            callback->run(&geometry, &visitor);
        }
    }
    return !(geometry.isCullingActive() && visitor.isCulled(geometry.getBoundingBox()));
}

void report(const VolumeInstance& volume, const Voxels& voxels, osgUtil::CullVisitor& visitor)
{
    const std::pair<const char*, std::int64_t> values[] = {
        {"osgVolumizer bricks total", voxels.getLayout().brickCount()},
        {"osgVolumizer bricks empty", volume.emptyBricks},
        {"osgVolumizer bricks homogeneous", volume.homogeneousBricks},
        {"osgVolumizer cells total", volume.cellCount},
        {"osgVolumizer cells occupied", volume.occupiedCells}};
    for (const auto& value : values)
        count(visitor.getCurrentCamera(), visitor.getFrameStamp(), value.first,
              static_cast<double>(value.second));
}

void registerVolume(std::unique_ptr<VolumeInstance> volume, osgUtil::CullVisitor& visitor)
{
    const glm::dvec4 center(volume->look->center, 1.0);
    const float depth = static_cast<float>(volume->look->referenceDepth);
    if (std::isnan(depth)) return;
    osgUtil::CullVisitor& cv = visitor;
    if (volume->look->features.voxels)
        count(cv.getCurrentCamera(), cv.getFrameStamp(), "osgVolumizer voxels per sample",
              volume->look->voxelsPerSample);
    const osg::ref_ptr<osg::StateSet> stateSet = volumeStateSet(volume->look->features);
    cv.pushStateSet(stateSet);
    volume->drawable = new VolumeDrawable;
    cv.addDrawableAndDepth(volume->drawable, volume->frameToEye.get(), depth);
    Merger::of(*cv.getCurrentRenderBin(), cv)->add(std::move(volume));
    cv.popStateSet();
}

} // namespace

void cull(VolumeGeometry& geometry, osgUtil::CullVisitor& visitor)
{
    if (!passesOsgCulling(geometry, visitor)) return;
    if (visitor.clampedPixelSize(geometry.getBound()) < 1.0f) {
        count(visitor.getCurrentCamera(), visitor.getFrameStamp(), "osgVolumizer volumes too small",
              1.0);
        return;
    }
    const VolumeAppearance* appearance = nearestAppearance(visitor.getNodePath());
    if (!appearance) return;
    const Voxels* voxels = appearance->getVoxels();
    if (voxels && !voxels->valid()) return;
    auto volume = std::make_unique<VolumeInstance>();
    volume->geometry = &geometry;
    volume->appearance = appearance;
    volume->prepared = geometry.geometryCache().get(geometry, voxels);
    if (!volume->prepared) return;
    if (!voxels && volume->prepared->tetras.vertices.format().colorSize == 0) return;
    volume->sampling = appearance->getSamplingParameters();
    volume->viewId = viewIdOf(visitor);
    if (voxels && !volume->prepared->voxelFrame) {
        const osg::Vec3d s = voxels->getSpacing();
        volume->sampling.voxelSize = {s.x(), s.y(), s.z()};
    }
    osg::RefMatrix& objectToEye = *visitor.getModelViewMatrix();
    volume->frameToEye =
        new osg::RefMatrix(toOsg(toGlm(objectToEye) * volume->prepared->frameToObject));
    TableTexture table;
    if (voxels)
        table = appearance->tableTextures().get(*appearance->getLookupTable(), voxels->getRange(),
                                                usedLookup(*appearance, *volume->prepared));
    const std::shared_ptr<VolumeLook> look = makeLook(*volume, table, visitor);
    volume->look = look;
    if (voxels) {
        selectBricks(*volume, *voxels, visitor);
        look->features.skipping = isWorthSkipping(*volume);
        report(*volume, *voxels, visitor);
        if (volume->bricks.empty()) return;
    }
    if (visitor.getComputeNearFarMode() != osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR &&
        !visitor.updateCalculatedNearFar(objectToEye, geometry.getBoundingBox()))
        return;

    if (osg::StateSet* own = geometry.getStateSet()) visitor.pushStateSet(own);
    registerVolume(std::move(volume), visitor);
    if (geometry.getStateSet()) visitor.popStateSet();
}

} // namespace render
} // namespace osgVolumizer
