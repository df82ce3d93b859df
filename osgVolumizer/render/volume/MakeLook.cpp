#include "MakeLook.h"

#include "../context/ContextLimits.h"
#include "../context/Matrices.h"
#include "CutInForce.h"
#include "GeometryCache.h"
#include "PixelFootprint.h"
#include "SettingsInForce.h"

#include "../../core/accuracy/AdaptiveStep.h"

#include <osgUtil/CullVisitor>

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace render {

namespace {

// How many voxels a pixel covers, at least, where a volume is nearest; 1 where it is less.
double voxelsPerPixel(const glm::dmat4& toEye, const core::Box3d& bounds,
                      const core::SamplingParameters& sampling, osgUtil::CullVisitor& visitor)
{
    const glm::dmat2x3 edges = pixelEdges(toEye, clipW(toEye, bounds, visitor).x, visitor);
    const double voxels = std::min(glm::length(edges[0] / sampling.voxelSize),
                                   glm::length(edges[1] / sampling.voxelSize));
    return std::isfinite(voxels) ? std::max(voxels, 1.0) : 1.0;
}

// Depth between samples: one period, per voxel axis, along the view axis; longer where that would
// be more samples than allowed. Where pixels cover several voxels, periods count in pixels, unless
// an error is to be kept.
double sampleDepth(const glm::dmat4& toEye, const core::Box3d& bounds,
                   const core::SamplingParameters& sampling, bool keepsError,
                   osgUtil::CullVisitor& visitor)
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
    const double stretch = keepsError ? 1.0 : voxelsPerPixel(toEye, bounds, sampling, visitor);
    return std::max(stretch / samplesPerDepth, (farthest - nearest) / sampling.maximumSamples);
}

// Along the view axis.
double voxelsPerDepth(const glm::dmat4& toEye, const core::SamplingParameters& sampling)
{
    const glm::dvec3 alongView = glm::inverse(glm::dmat3(toEye)) * glm::dvec3(0.0, 0.0, -1.0);
    return glm::length(alongView / sampling.voxelSize);
}

// See VolumeLook::pixelMargin.
glm::dvec3 pixelMargin(const glm::dmat4& toEye, const core::Box3d& bounds,
                       osgUtil::CullVisitor& visitor)
{
    constexpr double PIXELS = 0.125; // GL keeps at least 4 bits of a pixel's fraction
    const glm::dmat2x3 edges = pixelEdges(toEye, clipW(toEye, bounds, visitor).y, visitor);
    const glm::dvec3 margin = PIXELS * (glm::abs(edges[0]) + glm::abs(edges[1]));
    return std::isfinite(margin.x + margin.y + margin.z) ? margin : glm::dvec3(0.0);
}

// The nearest number that a float can be.
float inFloats(double v)
{
    constexpr double largest = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp(v, -largest, largest));
}

// Opacity units per frame unit, such that lengths in them are floats: beyond these bounds nothing
// shows any more, or all is opaque.
glm::dmat3 frameToUnits(const glm::dmat3& frameToObject, double unit)
{
    constexpr double largest = 1e18;
    const double longest = std::max({glm::length(frameToObject[0]), glm::length(frameToObject[1]),
                                     glm::length(frameToObject[2])});
    return frameToObject * (longest / unit > largest ? largest / longest : 1.0 / unit);
}

// How the shader gets a colour out of a brick.
void setInterpolation(const VolumeInstance& volume, const TableTexture& table,
                      double voxelsPerSample, ProgramFeatures& features, Reasons& reasons)
{
    const VolumeAppearance& appearance = *volume.appearance;
    const auto interpolation = usedInterpolation(appearance, reasons);
    features.nearest = interpolation == VolumeAppearance::NEAREST;
    features.cubic = interpolation == VolumeAppearance::CUBIC;
    features.exact = interpolation == VolumeAppearance::LINEAR &&
                     (appearance.getExactFiltering() || volume.exactFiltering);
    features.before = looksUpBefore(appearance, features.rayFunction, interpolation);
    features.preIntegrated = table.integrals;
    features.adaptive = volume.adaptsSteps && table.integrals;
    features.cells = table.intervals != nullptr;
    features.corners = features.cells && table.intervals->intervals > 3;
    features.shortRuns = table.integrals && table.shortRuns;
    // At a period of a voxel and more what the nearest entry is off by does not count.
    features.smoothTable = !table.integrals && !table.intervals &&
                           (appearance.getExactFiltering() || voxelsPerSample < 0.999);
}

// Without a tolerance so little that it does not stand out among errors of the period, which are of
// second order.
double opaqueEnough(const VolumeAppearance& appearance, const VolumeLook& look)
{
    constexpr double OF_A_VOXEL = 3e-5, LEAST = 1e-7, OF_EXACT = 1e-6;
    if (appearance.getErrorTolerance() > 0.0)
        return opaqueEnoughFor(appearance.getErrorTolerance());
    if (look.features.cells || look.features.isExact()) return OF_EXACT;
    const double period = std::min(look.voxelsPerSample, 1.0);
    return std::max(OF_A_VOXEL * period * period, LEAST);
}

void setFeatures(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                 ProgramFeatures& features, Reasons& reasons)
{
    const Voxels* voxels = voxelsIn(appearance, prepared);
    features.rayFunction = usedRayFunction(appearance, prepared, reasons);
    features.slab = usesSlabs(appearance, prepared);
    features.voxels = voxels != nullptr;
    features.rgba = voxels && voxels->getComponents() == 4;
    features.voxelCoordinates = !features.slab && voxels && !prepared.voxelFrame;
    features.vertexColors = !prepared.scalars && prepared.tetras.vertices.format().colorSize > 0;
    features.tetrahedra = usesTetrahedra(appearance, prepared);
    features.scalars = prepared.scalars;
    features.places = features.tetrahedra && voxels && !prepared.voxelFrame;
    if (features.tetrahedra && prepared.fieldShader > 0 && features.integratesLight()) {
        features.fieldCount = prepared.tetras.vertices.format().userSize;
        features.fieldShader = prepared.fieldShader;
    }
    features.wholeRuns = features.tetrahedra && voxels && prepared.voxelFrame &&
                         !features.vertexColors && features.fieldCount == 0;
    features.opaqueDepth = features.slab;
    features.shading = usesShading(appearance, prepared, features.rayFunction, reasons);
    explainSampling(appearance, prepared, reasons);
    if (voxels && appearance.getCombineRule() != VolumeAppearance::PAINT)
        explainLookup(appearance, prepared, reasons);
    features.gradientTexture = features.shading && !features.rgba &&
                               appearance.getGradients() == VolumeAppearance::PRECOMPUTED;
}

void setMaterial(const VolumeAppearance::Material& m, VolumeLook& look)
{
    look.material = glm::vec4(m.ambient, m.diffuse, m.specular, m.shininess);
}

void setValues(const VolumeAppearance& appearance, const Voxels& voxels, VolumeLook& look)
{
    const glm::dvec2 fraction = texelToRangeFraction(voxels);
    const osg::Vec2d range = voxels.getRange();
    look.valueToEntry = glm::vec2(fraction * (look.table.count - 1.0));
    look.texelToFraction = fraction.x;
    const double iso = (appearance.getIsoValue() - range.x()) / (range.y() - range.x());
    look.isoTexel = inFloats((iso - fraction.y) / fraction.x);
    setMaterial(appearance.getMaterial(), look);
    if (look.features.gradientTexture) look.gradientDecode = gradientDecode(voxels);
}

// Scalars are fractions of their range.
void setScalars(const VolumeInstance& volume, VolumeLook& look)
{
    const osg::Vec2d range = look.tetrahedra->range;
    look.features.cellScalars = look.tetrahedra->ofCells;
    look.valueToEntry = glm::vec2(look.table.count - 1.0, 0.0);
    look.isoTexel =
        inFloats((volume.appearance->getIsoValue() - range.x()) / (range.y() - range.x()));
    setMaterial(volume.appearance->getMaterial(), look);
}

} // namespace

std::shared_ptr<const VolumeLook> makeLook(const VolumeInstance& volume, const TableTexture& table,
                                           osgUtil::CullVisitor& visitor)
{
    const VolumeAppearance& appearance = *volume.appearance;
    const PreparedGeometry& prepared = *volume.prepared;
    auto look = std::make_shared<VolumeLook>();
    ProgramFeatures& features = look->features;
    look->table = table;
    Reasons reasons;
    setFeatures(appearance, prepared, features, reasons);
    if (volume.above.fog) look->fog = *volume.above.fog;
    features.fog = volume.above.fog.has_value();
    features.spherical = !features.slab && volume.sampling.mode == SamplingMode::SPHERICAL;
    if (features.tetrahedra)
        look->tetrahedra = renderData<GeometryCache>(*volume.geometry)
                               ->tetrahedra(*volume.geometry, volume.prepared);
    if (prepared.scalars && look->tetrahedra)
        setScalars(volume, *look);
    else if (!prepared.scalars && appearance.getVoxels())
        setValues(appearance, *appearance.getVoxels(), *look);
    look->frameToUnits =
        frameToUnits(glm::dmat3(prepared.frameToObject), appearance.getEffectiveOpacityUnit());
    look->center = prepared.regionBox.center();
    look->cut = makeCutLook(volume, look->center, features);
    const glm::dmat4 toEye = toGlm(*volume.frameToEye);
    look->referenceDepth = -(toEye * glm::dvec4(look->center, 1.0)).z;
    look->step =
        sampleDepth(toEye, prepared.regionBox, volume.sampling, volume.keepsError, visitor);
    if (volume.keepsError && prepared.voxelFrame)
        look->stepsPerLength = 1.0 / volume.sampling.periodVoxel.x;
    look->maximumSteps = volume.sampling.maximumSamples + 2;
    look->voxelsPerSample = voxelsPerDepth(toEye, volume.sampling) * look->step;
    if (visitor.getState()) features.filterBits = filterBitsOf(*visitor.getState());
    features.blendsSteps = volume.steps.blended;
    if (features.voxels) setInterpolation(volume, table, look->voxelsPerSample, features, reasons);
    look->opaqueEnough = opaqueEnough(appearance, *look);
    look->mostWeight = core::AdaptiveStep::WEIGHT * look->voxelsPerSample;
    reportReasons(appearance, reasons);
    if (features.slab) {
        look->regionMin = glm::vec3(prepared.regionBox.min);
        look->regionMax = glm::vec3(prepared.regionBox.max);
        look->pixelMargin = pixelMargin(toEye, prepared.regionBox, visitor);
        for (const core::Plane& p : prepared.obliquePlanes)
            look->planes.emplace_back(glm::dvec4(p.normal, p.offset));
    }
    for (const core::Plane& p : volume.clipPlanes)
        look->planes.emplace_back(glm::dvec4(p.normal, p.offset));
    features.planeCount = static_cast<int>(look->planes.size());
    return look;
}

} // namespace render
} // namespace osgVolumizer
