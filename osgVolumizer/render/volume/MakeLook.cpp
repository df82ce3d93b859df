#include "MakeLook.h"

#include "../context/Matrices.h"
#include "../context/ReportOnce.h"
#include "../draw/RayFunctions.h"

#include <osgUtil/CullVisitor>

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace render {

namespace {

// What cannot be done, and what is done instead.
void reportUnsupported(const VolumeAppearance& appearance, const std::string& what)
{
    reportOnce(
        {ErrorCode::NOT_SUPPORTED, "VolumeAppearance \"" + appearance.getName() + "\": " + what});
}

bool overlapSuffices(const Voxels& voxels, int samples)
{
    return voxels.getLayout().brickCount() <= 1 || voxels.getOverlap() >= samples;
}

VolumeAppearance::Interpolation usedInterpolation(const VolumeAppearance& appearance)
{
    const Voxels* voxels = appearance.getVoxels();
    const auto asked = appearance.getInterpolation();
    if (!voxels || asked != VolumeAppearance::CUBIC || overlapSuffices(*voxels, 3)) return asked;
    reportUnsupported(appearance,
                      "cubic interpolation needs bricks that share 3 samples, but the voxels' "
                      "overlap is " +
                          std::to_string(voxels->getOverlap()) + "; interpolation is linear");
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

VolumeAppearance::RayFunction usedRayFunction(const VolumeAppearance& appearance,
                                              const PreparedGeometry& prepared)
{
    const auto asked = appearance.getRayFunction();
    const Voxels* voxels = appearance.getVoxels();
    if (!voxels) return VolumeAppearance::COMPOSITE;
    const RayFunctionRow& row = rowOf(asked);
    const auto nameOf = [](VolumeAppearance::RayFunction function) {
        return std::string("ray function ") + VolumeAppearance::RAY_FUNCTION_NAMES[function];
    };
    if (row.needsOneComponent && voxels->getComponents() != 1) {
        reportUnsupported(appearance,
                          nameOf(asked) + " needs voxels of one component, but these have " +
                              std::to_string(voxels->getComponents()) + "; they are composited");
        return VolumeAppearance::COMPOSITE;
    }
    if (row.needsSlabs && !usesSlabs(appearance, prepared)) {
        reportUnsupported(appearance, nameOf(asked) +
                                          " needs slabs, and so a convex region in one voxel "
                                          "frame; the volume is composited");
        return VolumeAppearance::COMPOSITE;
    }
    return asked;
}

bool usesShading(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                 VolumeAppearance::RayFunction function)
{
    const Voxels* voxels = appearance.getVoxels();
    if (!appearance.getShading() || !voxels) return false;
    if (rowOf(function).gathers) return false; // values have no colour yet
    if (!prepared.voxelFrame) {
        reportUnsupported(appearance,
                          "shading needs one affine map to the voxel frame; the deformed "
                          "volume is not lit");
        return false;
    }
    if (!overlapSuffices(*voxels, appearance.getRequiredOverlap()))
        reportUnsupported(appearance, "shading without seams needs bricks that share " +
                                          std::to_string(appearance.getRequiredOverlap()) +
                                          " samples, but the voxels' overlap is " +
                                          std::to_string(voxels->getOverlap()));
    return true;
}

// Frame units that a pixel's width and height cover where clip w is `w`.
glm::dmat2x3 pixelEdges(const glm::dmat4& toEye, double w, osgUtil::CullVisitor& visitor)
{
    const osg::Viewport* viewport = visitor.getViewport();
    if (!viewport || !visitor.getProjectionMatrix()) return glm::dmat2x3(0.0);
    const glm::dmat2 clipToEye = glm::inverse(glm::dmat2(toGlm(*visitor.getProjectionMatrix())));
    const glm::dmat3 fromEye = glm::inverse(glm::dmat3(toEye));
    return {fromEye * glm::dvec3(clipToEye[0] * (2.0 * w / viewport->width()), 0.0),
            fromEye * glm::dvec3(clipToEye[1] * (2.0 * w / viewport->height()), 0.0)};
}

// Lowest and highest clip w of a box.
glm::dvec2 clipW(const glm::dmat4& toEye, const core::Box3d& bounds, osgUtil::CullVisitor& visitor)
{
    if (!visitor.getProjectionMatrix()) return glm::dvec2(0.0);
    const glm::dmat4 p = toGlm(*visitor.getProjectionMatrix());
    glm::dvec2 range(std::numeric_limits<double>::infinity(), 0.0);
    for (int i = 0; i < 8; ++i) {
        const double w = p[3][3] + p[2][3] * (toEye * glm::dvec4(bounds.corner(i), 1.0)).z;
        range = {std::min(range.x, w), std::max(range.y, w)};
    }
    return {std::max(range.x, 0.0), range.y};
}

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
// be more samples than allowed. Where pixels cover several voxels, periods count in pixels.
double sampleDepth(const glm::dmat4& toEye, const core::Box3d& bounds,
                   const core::SamplingParameters& sampling, osgUtil::CullVisitor& visitor)
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
    return std::max(voxelsPerPixel(toEye, bounds, sampling, visitor) / samplesPerDepth,
                    (farthest - nearest) / sampling.maximumSamples);
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
void setInterpolation(const VolumeAppearance& appearance, const TableTexture& table,
                      double voxelsPerSample, ProgramFeatures& features)
{
    const auto interpolation = usedInterpolation(appearance);
    features.nearest = interpolation == VolumeAppearance::NEAREST;
    features.cubic = interpolation == VolumeAppearance::CUBIC;
    features.exact = interpolation == VolumeAppearance::LINEAR && appearance.getExactFiltering();
    // Of nearest samples the two orders give the same.
    features.before = rowOf(features.rayFunction).integratesLight && !features.nearest &&
                      appearance.getLookup() == VolumeAppearance::BEFORE_INTERPOLATION;
    features.preIntegrated = table.integrals;
    features.shortRuns = table.integrals && table.shortRuns;
    // At a period of a voxel and more what the nearest entry is off by does not count.
    features.smoothTable =
        !table.integrals && (appearance.getExactFiltering() || voxelsPerSample < 0.999);
}

void setFeatures(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                 ProgramFeatures& features)
{
    const Voxels* voxels = appearance.getVoxels();
    features.slab = usesSlabs(appearance, prepared);
    features.voxels = voxels != nullptr;
    features.rgba = voxels && voxels->getComponents() == 4;
    features.voxelCoordinates = !features.slab && voxels && !prepared.voxelFrame;
    features.vertexColors = prepared.tetras.vertices.format().colorSize > 0;
    features.opaqueDepth = features.slab;
    features.rayFunction = usedRayFunction(appearance, prepared);
    features.shading = usesShading(appearance, prepared, features.rayFunction);
    features.gradientTexture = features.shading && !features.rgba &&
                               appearance.getGradients() == VolumeAppearance::PRECOMPUTED;
}

void setValues(const VolumeAppearance& appearance, const Voxels& voxels, VolumeLook& look)
{
    const glm::dvec2 fraction = texelToRangeFraction(voxels);
    const osg::Vec2d range = voxels.getRange();
    look.valueToEntry = glm::vec2(fraction * (look.table.count - 1.0));
    look.texelToFraction = fraction.x;
    const double iso = (appearance.getIsoValue() - range.x()) / (range.y() - range.x());
    look.isoTexel = inFloats((iso - fraction.y) / fraction.x);
    const VolumeAppearance::Material& m = appearance.getMaterial();
    look.material = glm::vec4(m.ambient, m.diffuse, m.specular, m.shininess);
    if (look.features.gradientTexture) look.gradientDecode = gradientDecode(voxels);
}

} // namespace

VolumeAppearance::Lookup usedLookup(const VolumeAppearance& appearance,
                                    const PreparedGeometry& prepared)
{
    // Runs of values need scalars that vary, and the ray in the voxel frame, which slices of a
    // deformed volume do not know.
    const bool runs = prepared.voxelFrame && appearance.getVoxels()->getComponents() == 1 &&
                      appearance.getInterpolation() != VolumeAppearance::NEAREST &&
                      rowOf(usedRayFunction(appearance, prepared)).integratesLight;
    return runs ? appearance.getLookup() : VolumeAppearance::AFTER_INTERPOLATION;
}

bool canKeepTolerance(const VolumeAppearance& appearance, const PreparedGeometry& prepared)
{
    const auto function = usedRayFunction(appearance, prepared);
    if (usesSlabs(appearance, prepared) && appearance.getVoxels()->getComponents() == 1 &&
        rowOf(function).integratesLight && !usesShading(appearance, prepared, function) &&
        appearance.getLookup() != VolumeAppearance::BEFORE_INTERPOLATION)
        return true;
    reportUnsupported(appearance,
                      "an error tolerance needs slabs, composited and not lit, and voxels of one "
                      "component looked up after interpolation; the sampling period is used");
    return false;
}

std::shared_ptr<const VolumeLook> makeLook(const VolumeInstance& volume, const TableTexture& table,
                                           osgUtil::CullVisitor& visitor)
{
    const VolumeAppearance& appearance = *volume.appearance;
    const PreparedGeometry& prepared = *volume.prepared;
    auto look = std::make_shared<VolumeLook>();
    ProgramFeatures& features = look->features;
    look->table = table;
    setFeatures(appearance, prepared, features);
    features.spherical = !features.slab && volume.sampling.mode == SamplingMode::SPHERICAL;
    if (appearance.getVoxels()) setValues(appearance, *appearance.getVoxels(), *look);
    look->frameToUnits =
        frameToUnits(glm::dmat3(prepared.frameToObject), appearance.getEffectiveOpacityUnit());
    look->center = prepared.regionBox.center();
    const glm::dmat4 toEye = toGlm(*volume.frameToEye);
    look->referenceDepth = -(toEye * glm::dvec4(look->center, 1.0)).z;
    look->step = sampleDepth(toEye, prepared.regionBox, volume.sampling, visitor);
    look->maximumSteps = volume.sampling.maximumSamples + 2;
    const glm::dvec3 alongView = glm::inverse(glm::dmat3(toEye)) * glm::dvec3(0.0, 0.0, -1.0);
    look->voxelsPerSample = look->step * glm::length(alongView / volume.sampling.voxelSize);
    if (features.voxels) setInterpolation(appearance, table, look->voxelsPerSample, features);
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

} // namespace render
} // namespace osgVolumizer
