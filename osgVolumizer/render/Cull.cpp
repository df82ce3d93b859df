#include "Cull.h"

#include "Matrices.h"
#include "Merger.h"
#include "ReportOnce.h"
#include "Statistics.h"
#include "VolumeInstance.h"

#include <osgUtil/CullVisitor>

#include <glm/matrix.hpp>

#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

const VolumeAppearance* nearestAppearance(const osg::NodePath& path)
{
    for (auto node = path.rbegin(); node != path.rend(); ++node)
        if (const auto* appearance = dynamic_cast<const VolumeAppearance*>(*node)) return appearance;
    return nullptr;
}

// What osgUtil::CullVisitor does for every drawable before it looks at it: false if the user's callback
// or the frustum rejects it.
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

osg::BoundingBox objectBounds(const core::Box3d& box, const glm::dmat4& frameToObject)
{
    osg::BoundingBox result;
    for (int i = 0; i < 8; ++i) {
        const glm::dvec4 p = frameToObject * glm::dvec4(box.corner(i), 1.0);
        result.expandBy(osg::Vec3d(p.x, p.y, p.z));
    }
    return result;
}

// The bricks that can show something: inside geometry and view, and not transparent throughout.
void selectBricks(VolumeInstance& volume, const Voxels& voxels, const TableTexture& table,
                  osgUtil::CullVisitor& visitor)
{
    const core::BrickLayout& layout = voxels.getLayout();
    const osg::Vec2d range = voxels.getRange();
    const double toFraction = 1.0 / (range.y() - range.x());
    const osg::ref_ptr<BrickTextures> textures = BrickTextures::of(voxels);
    const PreparedGeometry& prepared = *volume.prepared;
    for (std::int64_t i = 0; i < layout.brickCount(); ++i) {
        const core::BrickPlace place = layout.brick(i);
        core::Box3d box = place.clipBox;
        if (prepared.voxelFrame) {
            box = intersection(box, prepared.regionBox);
            if (box.empty()) continue;
            if (visitor.isCulled(objectBounds(box, prepared.frameToObject))) continue;
        }
        if (voxels.getComponents() == 1) {
            const auto values = voxels.getBrickRange(i);
            if (!(table.function->maximumOpacity((values.first - range.x()) * toFraction,
                                                 (values.second - range.x()) * toFraction) > 0.0))
                continue;
        }
        const BrickTexture texture = textures->get(voxels, i);
        if (!texture.texture) continue;
        const glm::vec3 size(place.samples.size());
        volume.bricks.push_back({i, box, texture, 1.0f / size,
                                 (0.5f - glm::vec3(place.samples.min)) / size});
    }
}

// What the overlap of the bricks allows; says so where it is not what was asked for.
VolumeAppearance::Interpolation usedInterpolation(const VolumeAppearance& appearance)
{
    const Voxels* voxels = appearance.getVoxels();
    const auto asked = appearance.getInterpolation();
    if (!voxels || asked != VolumeAppearance::CUBIC) return asked;
    if (voxels->getLayout().brickCount() <= 1 || voxels->getOverlap() >= 3) return asked;
    reportOnce({ErrorCode::NOT_SUPPORTED,
                "VolumeAppearance \"" + appearance.getName() +
                    "\": cubic interpolation needs bricks that share 3 samples, but the voxels' "
                    "overlap is " +
                    std::to_string(voxels->getOverlap()) + "; interpolation is linear"});
    return VolumeAppearance::LINEAR;
}

bool usesSlabs(const VolumeAppearance& appearance, const PreparedGeometry& prepared)
{
    return appearance.getTechnique() != VolumeAppearance::SLICES && prepared.region &&
           prepared.voxelFrame && appearance.getVoxels() &&
           prepared.tetras.vertices.format().colorSize == 0 &&
           (appearance.getTechnique() == VolumeAppearance::SLABS ||
            appearance.getSamplingMode() == SamplingMode::VIEWPORT_ALIGNED);
}

// Depth between samples: one period, per voxel axis, along the view axis; longer where that would be more
// samples than allowed.
double sampleDepth(const glm::dmat4& toEye, const core::Box3d& bounds,
                   const core::SamplingParameters& sampling)
{
    const glm::dvec3 alongView = glm::inverse(glm::dmat3(toEye)) * glm::dvec3(0.0, 0.0, -1.0);
    const double samplesPerDepth =
        glm::length(alongView / (sampling.periodVoxel * sampling.voxelSize));
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (int i = 0; i < 8; ++i) {
        const double depth = -(toEye * glm::dvec4(bounds.corner(i), 1.0)).z;
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
    }
    return std::max(1.0 / samplesPerDepth, (farthest - nearest) / sampling.maximumSamples);
}

// See VolumeLook::pixelMargin.
glm::dvec3 pixelMargin(const glm::dmat4& toEye, const core::Box3d& bounds,
                       osgUtil::CullVisitor& visitor)
{
    constexpr double PIXELS = 0.125; // GL keeps at least 4 bits of a pixel's fraction
    const osg::Viewport* viewport = visitor.getViewport();
    if (!viewport || !visitor.getProjectionMatrix()) return glm::dvec3(0.0);
    const glm::dmat4 p = toGlm(*visitor.getProjectionMatrix());
    double w = 0.0;
    for (int i = 0; i < 8; ++i)
        w = std::max(w, p[3][3] + p[2][3] * (toEye * glm::dvec4(bounds.corner(i), 1.0)).z);
    const glm::dmat2 clipToEye = glm::inverse(glm::dmat2(p));
    const glm::dmat3 fromEye = glm::inverse(glm::dmat3(toEye));
    const glm::dvec3 right(clipToEye[0] * (2.0 * w / viewport->width()), 0.0);
    const glm::dvec3 up(clipToEye[1] * (2.0 * w / viewport->height()), 0.0);
    const glm::dvec3 margin = PIXELS * (glm::abs(fromEye * right) + glm::abs(fromEye * up));
    return std::isfinite(margin.x + margin.y + margin.z) ? margin : glm::dvec3(0.0);
}

// Runs of values need scalars that vary, and the ray in the voxel frame, which slices of a deformed volume
// do not know.
VolumeAppearance::Lookup lookupOf(const VolumeAppearance& appearance,
                                  const PreparedGeometry& prepared)
{
    const bool runs = prepared.voxelFrame && appearance.getVoxels()->getComponents() == 1 &&
                      appearance.getInterpolation() != VolumeAppearance::NEAREST;
    return runs ? appearance.getLookup() : VolumeAppearance::AFTER_INTERPOLATION;
}

// How the shader gets a colour out of a brick.
void setInterpolation(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                      const TableTexture& table, double voxelsPerSample,
                      ProgramFeatures& features)
{
    if (!features.voxels) return;
    const auto interpolation = usedInterpolation(appearance);
    features.nearest = interpolation == VolumeAppearance::NEAREST;
    features.cubic = interpolation == VolumeAppearance::CUBIC;
    features.exact =
        interpolation == VolumeAppearance::LINEAR && appearance.getExactFiltering();
    // Of nearest samples the two orders give the same.
    features.before = appearance.getLookup() == VolumeAppearance::BEFORE_INTERPOLATION &&
                      interpolation != VolumeAppearance::NEAREST;
    features.preIntegrated = table.integrals;
    features.smoothTable =
        !table.integrals && (appearance.getExactFiltering() || voxelsPerSample < 0.999);
}

std::shared_ptr<VolumeLook> makeLook(const VolumeInstance& volume, const TableTexture& table,
                                     osgUtil::CullVisitor& visitor)
{
    const VolumeAppearance& appearance = *volume.appearance;
    const Voxels* voxels = appearance.getVoxels();
    const PreparedGeometry& prepared = *volume.prepared;
    auto look = std::make_shared<VolumeLook>();
    ProgramFeatures& features = look->features;
    features.slab = usesSlabs(appearance, prepared);
    features.voxels = voxels != nullptr;
    features.rgba = voxels && voxels->getComponents() == 4;
    features.voxelCoordinates = !features.slab && voxels && !prepared.voxelFrame;
    features.vertexColors = prepared.tetras.vertices.format().colorSize > 0;
    features.opaqueDepth = features.slab;
    features.spherical = !features.slab && volume.sampling.mode == SamplingMode::SPHERICAL;
    look->table = table;
    if (voxels) {
        const glm::dvec2 fraction = texelToRangeFraction(*voxels);
        look->valueToEntry = glm::vec2(fraction * (table.count - 1.0));
    }
    look->frameToUnits =
        glm::dmat3(prepared.frameToObject) / appearance.getEffectiveOpacityUnit();
    look->center = prepared.regionBox.center();
    const glm::dmat4 toEye = toGlm(*volume.frameToEye);
    look->referenceDepth = -(toEye * glm::dvec4(look->center, 1.0)).z;
    look->step = sampleDepth(toEye, prepared.regionBox, volume.sampling);
    look->maximumSteps = volume.sampling.maximumSamples + 2;
    const glm::dvec3 alongView = glm::inverse(glm::dmat3(toEye)) * glm::dvec3(0.0, 0.0, -1.0);
    setInterpolation(appearance, prepared, table,
                     look->step * glm::length(alongView / volume.sampling.voxelSize), features);
    if (features.slab) {
        look->regionMin = glm::vec3(prepared.regionBox.min);
        look->regionMax = glm::vec3(prepared.regionBox.max);
        look->pixelMargin = pixelMargin(toEye, prepared.regionBox, visitor);
        features.planeCount = static_cast<int>(prepared.obliquePlanes.size());
        for (const core::Plane& p : prepared.obliquePlanes)
            look->planes.emplace_back(glm::dvec4(p.normal, p.offset));
    }
    return look;
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
    if (voxels && !volume->prepared->voxelFrame) {
        const osg::Vec3d s = voxels->getSpacing();
        volume->sampling.voxelSize = {s.x(), s.y(), s.z()};
    }
    TableTexture table;
    const osg::Camera* camera = visitor.getCurrentCamera();
    if (voxels) {
        table = appearance->tableTextures().get(*appearance->getLookupTable(), voxels->getRange(),
                                              lookupOf(*appearance, *volume->prepared));
        selectBricks(*volume, *voxels, table, visitor);
        count(camera, visitor.getFrameStamp(), "osgVolumizer bricks total",
              static_cast<double>(voxels->getLayout().brickCount()));
        if (volume->bricks.empty()) return;
    }
    osg::RefMatrix& objectToEye = *visitor.getModelViewMatrix();
    if (visitor.getComputeNearFarMode() != osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR &&
        !visitor.updateCalculatedNearFar(objectToEye, geometry.getBoundingBox()))
        return;
    volume->frameToEye =
        new osg::RefMatrix(toOsg(toGlm(objectToEye) * volume->prepared->frameToObject));
    volume->look = makeLook(*volume, table, visitor);

    if (osg::StateSet* own = geometry.getStateSet()) visitor.pushStateSet(own);
    registerVolume(std::move(volume), visitor);
    if (geometry.getStateSet()) visitor.popStateSet();
}

} // namespace render
} // namespace osgVolumizer
