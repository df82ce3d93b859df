#include "Cull.h"

#include "../context/ClipPlanes.h"
#include "../context/Matrices.h"
#include "../context/Statistics.h"
#include "../draw/VolumeProgram.h"
#include "../merge/Merger.h"
#include "../volume/CutInForce.h"
#include "../volume/GeometryCache.h"
#include "../volume/MakeLook.h"
#include "../volume/NearestAppearance.h"
#include "../volume/SettingsInForce.h"
#include "../volume/SliceCache.h"
#include "../volume/VolumeInstance.h"
#include "AppearanceData.h"
#include "BrickSelection.h"
#include "TableChoice.h"

#include <osg/Timer>
#include <osgUtil/CullVisitor>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

// Surfaces, and steps of a ray, whatever is asked for: nobody would wait for more, and floats still
// tell the ends of steps apart.
constexpr int MOST_SAMPLES = 1 << 16;

void report(const VolumeInstance& volume, const Voxels& voxels, osgUtil::CullVisitor& visitor)
{
    const std::pair<const char*, std::int64_t> values[] = {
        {"osgVolumizer bricks total",
         voxels.isPaged() ? voxels.getTree().brickCount() : voxels.getLayout().brickCount()},
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
    const osg::ref_ptr<osg::StateSet> stateSet = volumeStateSet(partOf(*volume).features);
    cv.pushStateSet(stateSet);
    volume->drawable = new VolumeDrawable;
    cv.addDrawableAndDepth(volume->drawable, volume->frameToEye.get(), depth);
    Merger::of(*cv.getCurrentRenderBin(), cv)->add(std::move(volume));
    cv.popStateSet();
}

// The table, and, where an error tolerance or a frame time is asked for, the period.
TableTexture chooseSampling(VolumeInstance& volume, osgUtil::CullVisitor& visitor)
{
    const VolumeAppearance& appearance = *volume.appearance;
    const Precision precision = visitor.getState() ? precisionOf(*visitor.getState()) : Precision();
    TableChoice choice =
        volume.prepared->scalars
            ? chooseTable(appearance, *volume.prepared, volume.geometry->getScalarRange())
            : chooseTable(appearance, *volume.prepared, precision);
    volume.exactFiltering = choice.exactFiltering;
    volume.adaptsSteps = choice.adaptive;
    if (choice.periodVoxel) volume.brightness = renderData<AppearanceData>(appearance)->brightness;
    volume.keepsError = choice.periodVoxel.has_value();
    if (choice.periodVoxel) volume.sampling.periodVoxel = glm::dvec3(*choice.periodVoxel);
    Reasons reasons;
    explainError(appearance.getErrorTolerance(), choice.expectedError, reasons);
    reportReasons(appearance, reasons);
    if (appearance.getTargetFrameTime() > 0.0 && visitor.getFrameStamp()) {
        const double now = osg::Timer::instance()->time_s();
        const osg::Matrixd toClip = *volume.frameToEye * *visitor.getProjectionMatrix();
        const double reduction =
            renderData<AppearanceData>(appearance)
                ->frameTimes.reduction(volume.viewId, visitor.getFrameStamp()->getFrameNumber(),
                                       toClip, now, appearance.getTargetFrameTime(),
                                       ViewHooks::of(visitor.getCurrentCamera()).reduction);
        const ReducedSampling reduced = reducedSampling(reduction);
        volume.rayDistance = reduced.rayDistance;
        volume.sampling.periodVoxel *= reduced.stretch;
        // Pieces of cells do not become longer; runs of values do.
        if (reduced.stretch > 1.0 && choice.table.intervals)
            choice.table =
                renderData<AppearanceData>(appearance)
                    ->tables.get(*appearance.getLookupTable(), appearance.getVoxels()->getRange(),
                                 appearance.getInterpolation() == VolumeAppearance::NEAREST
                                     ? VolumeAppearance::AFTER_INTERPOLATION
                                     : VolumeAppearance::PREINTEGRATED);
    }
    return choice.table;
}

// Without voxels a tetrahedron is as long as two; periods are in object units where vertices have
// colours.
void setSamplingOfMesh(VolumeInstance& volume)
{
    const PreparedGeometry& prepared = *volume.prepared;
    volume.sampling.voxelSize =
        glm::dvec3(prepared.scalars ? 0.5 * prepared.meanEdge : 1.0 / prepared.unitsPerFrame);
}

// A piece for all of what has no bricks.
SelectedBrick wholeOf(const PreparedGeometry& prepared)
{
    SelectedBrick whole;
    whole.box = whole.clipBox = prepared.regionBox;
    return whole;
}

// All that is known before bricks are selected; null where there is nothing to draw.
std::unique_ptr<VolumeInstance> makeInstance(VolumeGeometry& geometry,
                                             const VolumeAppearance& appearance,
                                             osgUtil::CullVisitor& visitor)
{
    const Voxels* voxels = appearance.getVoxels();
    if (voxels && !voxels->valid()) return nullptr;
    auto volume = std::make_unique<VolumeInstance>();
    volume->geometry = &geometry;
    volume->appearance = &appearance;
    volume->prepared = renderData<GeometryCache>(geometry)->get(geometry, voxels);
    if (!volume->prepared) return nullptr;
    if (volume->prepared->scalars) voxels = nullptr;
    if (!voxels && !volume->prepared->scalars && volume->prepared->fieldShader == 0 &&
        volume->prepared->tetras.vertices.format().colorSize == 0)
        return nullptr;
    volume->sampling = appearance.getSamplingParameters();
    volume->sampling.maximumSamples = std::min(volume->sampling.maximumSamples, MOST_SAMPLES);
    volume->viewId = viewIdOf(visitor);
    volume->above = stateAbove(visitor.getCurrentStateGraph());
    if (voxels && !volume->prepared->voxelFrame) {
        const osg::Vec3d s = voxels->getSpacing() / volume->prepared->unitsPerFrame;
        volume->sampling.voxelSize = {s.x(), s.y(), s.z()};
    } else if (!voxels) {
        setSamplingOfMesh(*volume);
    }
    volume->frameToEye = new osg::RefMatrix(
        toOsg(toGlm(*visitor.getModelViewMatrix()) * volume->prepared->frameToObject));
    volume->clipPlanes =
        clipPlanesOf(visitor.getCurrentStateGraph(), *visitor.getCurrentRenderBin()->getStage(),
                     toOsg(volume->prepared->frameToObject), *volume->frameToEye);
    volume->cut = cutInForce(appearance, *volume->prepared);
    for (const core::Plane& plane : planesOfCut(*volume))
        volume->clipPlanes.push_back(plane);
    TableTexture table;
    if (voxels) volume->steps = timeStepsOf(appearance, visitor.getFrameStamp());
    if (voxels || volume->prepared->scalars) table = chooseSampling(*volume, visitor);
    volume->look = makeLook(*volume, table, visitor);
    const bool lacksTetrahedra = volume->look->features.tetrahedra && !volume->look->tetrahedra;
    return lacksTetrahedra ? nullptr : std::move(volume);
}

// False where no brick shows anything.
bool select(VolumeInstance& volume, osgUtil::CullVisitor& visitor)
{
    const ViewHooks& hooks = ViewHooks::of(visitor.getCurrentCamera());
    volume.countSamples = volume.look->features.slab && hooks.countSamples;
    const Voxels* voxels = voxelsIn(*volume.appearance, *volume.prepared);
    if (!voxels) {
        if (volume.look->features.slab) volume.bricks.push_back(wholeOf(*volume.prepared));
        return true;
    }
    selectBricks(volume, *voxels, hooks, visitor);
    volume.skipping = isWorthSkipping(volume);
    report(volume, *voxels, visitor);
    return !volume.bricks.empty();
}

// What a volume is under a PolygonMode of lines or points.
void drawOutlines(VolumeGeometry& geometry, const Voxels* voxels, osgUtil::CullVisitor& visitor)
{
    if (voxels && !voxels->valid()) voxels = nullptr;
    const osg::ref_ptr<GeometryCache> cache = renderData<GeometryCache>(geometry);
    const auto prepared = cache->get(geometry, voxels);
    if (!prepared) return;
    if (visitor.getComputeNearFarMode() != osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR &&
        !visitor.updateCalculatedNearFar(*visitor.getModelViewMatrix(), geometry.getBoundingBox()))
        return;
    const osg::ref_ptr<osg::Geometry> lines = cache->outlines(geometry, voxels);
    const osg::ref_ptr<osg::RefMatrix> toEye =
        new osg::RefMatrix(toOsg(toGlm(*visitor.getModelViewMatrix()) * prepared->frameToObject));
    const glm::dvec3 center = prepared->bounds.center();
    visitor.pushStateSet(lines->getStateSet());
    visitor.addDrawableAndDepth(
        lines, toEye.get(),
        static_cast<float>(-(osg::Vec3d(center.x, center.y, center.z) * *toEye).z()));
    visitor.popStateSet();
}

} // namespace

bool passesOsgCulling(osg::Drawable& drawable, const osg::BoundingBox& bounds,
                      osgUtil::CullVisitor& visitor)
{
    if (osg::Callback* callback = drawable.getCullCallback()) {
        osg::RenderInfo& info = visitor.getRenderInfo();
        if (osg::DrawableCullCallback* d = callback->asDrawableCullCallback()) {
            if (d->cull(&visitor, &drawable, &info)) return false;
        } else {
            callback->run(&drawable, &visitor);
        }
    }
    return !(drawable.isCullingActive() && visitor.isCulled(bounds));
}

void cull(VolumeGeometry& geometry, osgUtil::CullVisitor& visitor)
{
    if (!passesOsgCulling(geometry, geometry.getBoundingBox(), visitor)) return;
    if (visitor.clampedPixelSize(geometry.getBound()) < 1.0f) {
        count(visitor.getCurrentCamera(), visitor.getFrameStamp(), "osgVolumizer volumes too small",
              1.0);
        return;
    }
    const VolumeAppearance* appearance = nearestAppearance(visitor.getNodePath());
    if (!appearance) return;
    osg::StateSet* own = geometry.getStateSet();
    if (own) visitor.pushStateSet(own);
    if (showsOutlines(visitor.getCurrentStateGraph())) {
        drawOutlines(geometry, appearance->getVoxels(), visitor);
        if (own) visitor.popStateSet();
        return;
    }
    std::unique_ptr<VolumeInstance> volume = makeInstance(geometry, *appearance, visitor);
    const auto isInView = [&] {
        return visitor.getComputeNearFarMode() == osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR ||
               visitor.updateCalculatedNearFar(*visitor.getModelViewMatrix(),
                                               geometry.getBoundingBox());
    };
    if (volume && select(*volume, visitor) && isInView())
        registerVolume(std::move(volume), visitor);
    if (own) visitor.popStateSet();
}

} // namespace render
} // namespace osgVolumizer
