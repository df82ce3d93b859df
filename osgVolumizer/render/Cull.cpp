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

void registerVolume(std::unique_ptr<VolumeInstance> volume, osgUtil::CullVisitor& visitor)
{
    const glm::dvec4 center(volume->look->center, 1.0);
    const float depth = static_cast<float>(volume->look->referenceDepth);
    if (std::isnan(depth)) return;
    osgUtil::CullVisitor& cv = visitor;
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
    volume->look = makeLook(*volume, table, visitor);
    if (voxels) {
        selectBricks(*volume, *voxels, table, visitor);
        count(visitor.getCurrentCamera(), visitor.getFrameStamp(), "osgVolumizer bricks total",
              static_cast<double>(voxels->getLayout().brickCount()));
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
