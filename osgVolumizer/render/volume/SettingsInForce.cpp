#include "SettingsInForce.h"

#include "../context/ReportOnce.h"
#include "../draw/RayFunctions.h"

#include <algorithm>
#include <sstream>

namespace osgVolumizer {
namespace render {

namespace {

bool overlapSuffices(const Voxels& voxels, int samples)
{
    return (voxels.getLayout().brickCount() <= 1 && !voxels.isPaged()) ||
           voxels.getOverlap() >= samples;
}

// Rays through a deformed volume meet its bricks in any order, each perhaps more than once.
bool fitIntoOneTexture(const Voxels& voxels)
{
    constexpr int LARGEST_SIDE = 2048; // that every card with OpenGL 4 has
    constexpr double MOST_BYTES = 1 << 30;
    constexpr double SAMPLE_BYTES = 16.0; // at most: gradients, or colours, in floats
    const glm::ivec3 size = voxels.getLayout().size();
    if (voxels.isPaged()) return false;
    return voxels.getLayout().brickCount() == 1 ||
           (voxels.getOverlap() >= 1 && std::max({size.x, size.y, size.z}) <= LARGEST_SIDE &&
            double(size.x) * double(size.y) * double(size.z) * SAMPLE_BYTES <= MOST_BYTES);
}

bool wantsSurfaces(const VolumeAppearance& appearance)
{
    return appearance.getTechnique() == VolumeAppearance::AUTOMATIC &&
           (appearance.getSamplingMode() != SamplingMode::VIEWPORT_ALIGNED ||
            appearance.getSamplingSpace() != SamplingSpace::OBJECT);
}

// What rules slabs out; the first thing that does. Empty where nothing does.
std::string whyNoSlabs(const VolumeAppearance& appearance, const PreparedGeometry& prepared)
{
    if (prepared.scalars) return {};
    const bool needsSlabs = prepared.fieldShader > 0; // slices know no fields
    const Voxels* voxels = appearance.getVoxels();
    if (voxels && !prepared.voxelFrame && !fitIntoOneTexture(*voxels))
        return "the voxels of a deformed volume do not fit into one texture";
    if (needsSlabs || !wantsSurfaces(appearance)) return {};
    return appearance.getSamplingMode() != SamplingMode::VIEWPORT_ALIGNED
               ? "sampling surfaces other than VIEWPORT_ALIGNED are asked for"
               : "a sampling space other than OBJECT is asked for";
}

// Another lookup than what is asked for is in force.
const char* const WHY_ANOTHER_LOOKUP =
    "another lookup needs composited voxels of one component, in one voxel frame or marched, "
    "interpolated linearly or better; lookup is after interpolation";

void explainTechnique(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                      VolumeAppearance::Settings& settings)
{
    const auto asked = appearance.getTechnique();
    settings.technique =
        usesSlabs(appearance, prepared) ? VolumeAppearance::SLABS : VolumeAppearance::SLICES;
    if (settings.technique == asked) return;
    const std::string why = whyNoSlabs(appearance, prepared);
    if (!why.empty())
        settings.reasons.push_back(why + "; the technique is slices");
    else if (asked == VolumeAppearance::SLICES)
        settings.reasons.emplace_back("scalars and fields are not drawn as slices; the technique "
                                      "is slabs");
    else if (usesTetrahedra(appearance, prepared))
        settings.reasons.emplace_back("rays walk through the tetrahedra; the technique is slabs");
    else
        settings.reasons.emplace_back("the region is convex, in one voxel frame; the technique is "
                                      "slabs");
}

void explainLookup(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                   VolumeAppearance::Lookup table, VolumeAppearance::Settings& settings)
{
    const auto asked = appearance.getLookup();
    settings.lookup =
        table == VolumeAppearance::AFTER_INTERPOLATION &&
                looksUpBefore(appearance, settings.rayFunction, settings.interpolation)
            ? VolumeAppearance::BEFORE_INTERPOLATION
            : table;
    if (settings.lookup == asked) return;
    if (table == VolumeAppearance::CELL_BY_CELL)
        settings.reasons.push_back("steps would not keep the error tolerance, or not as fast; "
                                   "lookup is cell by cell");
    else if (table == VolumeAppearance::PREINTEGRATED)
        settings.reasons.push_back("samples would miss jumps or peaks of the table; lookup is "
                                   "preintegrated");
    else if (asked == VolumeAppearance::AUTOMATIC_LOOKUP &&
             usedLookup(appearance, prepared) == asked)
        settings.reasons.push_back("the table is smooth; lookup is after interpolation");
    else
        settings.reasons.push_back(WHY_ANOTHER_LOOKUP);
}

// A volume that paints is sampled by the shaders of those it paints.
void explainPaint(const VolumeAppearance& appearance, VolumeAppearance::Settings& settings)
{
    if (appearance.getCombineRule() != VolumeAppearance::PAINT) return;
    if (settings.interpolation == VolumeAppearance::CUBIC) {
        settings.interpolation = VolumeAppearance::LINEAR;
        settings.reasons.push_back("a volume that paints is interpolated linearly");
    }
    if (settings.lookup != VolumeAppearance::AFTER_INTERPOLATION) {
        settings.lookup = VolumeAppearance::AFTER_INTERPOLATION;
        settings.reasons.push_back("a volume that paints is looked up after interpolation");
    }
    settings.shading = settings.exactFiltering = false;
}

} // namespace

VolumeAppearance::Interpolation usedInterpolation(const VolumeAppearance& appearance,
                                                  Reasons& reasons)
{
    const Voxels* voxels = appearance.getVoxels();
    const auto asked = appearance.getInterpolation();
    if (!voxels || asked != VolumeAppearance::CUBIC || overlapSuffices(*voxels, 3)) return asked;
    reasons.push_back("cubic interpolation needs bricks that share 3 samples, but the voxels' "
                      "overlap is " +
                      std::to_string(voxels->getOverlap()) + "; interpolation is linear");
    return VolumeAppearance::LINEAR;
}

const Voxels* voxelsIn(const VolumeAppearance& appearance, const PreparedGeometry& prepared)
{
    return prepared.scalars ? nullptr : appearance.getVoxels();
}

bool usesSlabs(const VolumeAppearance& appearance, const PreparedGeometry& prepared)
{
    const bool neverSlices = prepared.scalars || prepared.fieldShader > 0;
    return (neverSlices || appearance.getTechnique() != VolumeAppearance::SLICES) &&
           whyNoSlabs(appearance, prepared).empty();
}

bool usesTetrahedra(const VolumeAppearance& appearance, const PreparedGeometry& prepared)
{
    const bool convex = appearance.getVoxels() && prepared.voxelFrame && prepared.region &&
                        prepared.tetras.vertices.format().colorSize == 0 &&
                        prepared.fieldShader == 0;
    return usesSlabs(appearance, prepared) && !convex;
}

VolumeAppearance::RayFunction usedRayFunction(const VolumeAppearance& appearance,
                                              const PreparedGeometry& prepared, Reasons& reasons)
{
    const auto asked = appearance.getRayFunction();
    const Voxels* voxels = voxelsIn(appearance, prepared);
    if (!voxels && !prepared.scalars) return VolumeAppearance::COMPOSITE;
    const RayFunctionRow& row = rowOf(asked);
    const std::string name =
        std::string("ray function ") + VolumeAppearance::RAY_FUNCTION_NAMES[asked];
    if (row.needsOneComponent && voxels && voxels->getComponents() != 1) {
        reasons.push_back(name + " needs voxels of one component, but these have " +
                          std::to_string(voxels->getComponents()) + "; they are composited");
        return VolumeAppearance::COMPOSITE;
    }
    if (row.needsSlabs && !usesSlabs(appearance, prepared)) {
        reasons.push_back(name + " needs slabs; the volume is composited");
        return VolumeAppearance::COMPOSITE;
    }
    return asked;
}

bool usesShading(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                 VolumeAppearance::RayFunction function, Reasons& reasons)
{
    const Voxels* voxels = voxelsIn(appearance, prepared);
    if (!appearance.getShading() || (!voxels && !prepared.scalars)) return false;
    if (rowOf(function).gathers) { // values have no colour yet
        reasons.push_back("what the ray function gathers is not lit");
        return false;
    }
    if (!prepared.voxelFrame && !usesSlabs(appearance, prepared)) {
        reasons.push_back("slices of a deformed volume are not lit");
        return false;
    }
    if (voxels && !overlapSuffices(*voxels, appearance.getRequiredOverlap()))
        reasons.push_back("shading without seams needs bricks that share " +
                          std::to_string(appearance.getRequiredOverlap()) +
                          " samples, but the voxels' overlap is " +
                          std::to_string(voxels->getOverlap()));
    return true;
}

void explainSampling(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                     Reasons& reasons)
{
    if (usesSlabs(appearance, prepared) &&
        (appearance.getSamplingMode() != SamplingMode::VIEWPORT_ALIGNED ||
         appearance.getSamplingSpace() != SamplingSpace::OBJECT))
        reasons.push_back("sampling mode and space are those of slices, but the technique is "
                          "slabs; each ray is sampled along itself");
}

void explainLookup(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                   Reasons& reasons)
{
    if (appearance.getLookup() != VolumeAppearance::AUTOMATIC_LOOKUP &&
        usedLookup(appearance, prepared) != appearance.getLookup())
        reasons.push_back(WHY_ANOTHER_LOOKUP);
}

VolumeAppearance::Lookup usedLookup(const VolumeAppearance& appearance,
                                    const PreparedGeometry& prepared)
{
    // Runs of values need scalars that vary, and the ray in the voxel frame, which slices of a
    // deformed volume do not know.
    Reasons ofRayFunction;
    const bool rays = prepared.voxelFrame || usesSlabs(appearance, prepared);
    const bool runs = rays && appearance.getVoxels()->getComponents() == 1 &&
                      appearance.getInterpolation() != VolumeAppearance::NEAREST &&
                      rowOf(usedRayFunction(appearance, prepared, ofRayFunction)).integratesLight;
    const auto asked = appearance.getLookup();
    const bool chosen = asked == VolumeAppearance::AUTOMATIC_LOOKUP &&
                        appearance.getErrorTolerance() > 0.0 && canSplitRays(appearance, prepared);
    const bool suits = asked == VolumeAppearance::CELL_BY_CELL ? canSplitRays(appearance, prepared)
                                                               : runs || chosen;
    return suits ? asked : VolumeAppearance::AFTER_INTERPOLATION;
}

bool canSplitRays(const VolumeAppearance& appearance, const PreparedGeometry& prepared)
{
    Reasons ofOthers;
    return usesSlabs(appearance, prepared) && appearance.getVoxels()->getComponents() == 1 &&
           usedInterpolation(appearance, ofOthers) != VolumeAppearance::CUBIC &&
           appearance.getCombineRule() != VolumeAppearance::PAINT &&
           rowOf(usedRayFunction(appearance, prepared, ofOthers)).integratesLight;
}

double opaqueEnoughFor(double tolerance)
{
    constexpr double SHARE = 0.02, LEAST = 1e-7, MOST = 1e-3;
    return std::clamp(SHARE * tolerance, LEAST, MOST);
}

void explainError(double tolerance, double expectedError, Reasons& reasons)
{
    if (!(tolerance > 0.0 && expectedError > tolerance)) return;
    std::ostringstream words;
    words << "an error of " << tolerance << " cannot be kept with these voxels and this table; "
          << expectedError << " is expected";
    reasons.push_back(words.str());
}

bool looksUpBefore(const VolumeAppearance& appearance, VolumeAppearance::RayFunction function,
                   VolumeAppearance::Interpolation interpolation)
{
    // Of nearest samples the two orders give the same.
    return rowOf(function).integratesLight && interpolation != VolumeAppearance::NEAREST &&
           appearance.getLookup() == VolumeAppearance::BEFORE_INTERPOLATION;
}

bool canKeepTolerance(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                      Reasons& reasons)
{
    if (appearance.getVoxels()->isPaged()) {
        reasons.push_back("an error tolerance needs voxels that fit into memory, not ones that are "
                          "paged; the sampling period is used");
        return false;
    }
    Reasons ofOthers;
    const auto function = usedRayFunction(appearance, prepared, ofOthers);
    if (usesSlabs(appearance, prepared) && appearance.getVoxels()->getComponents() == 1 &&
        rowOf(function).integratesLight &&
        appearance.getLookup() != VolumeAppearance::BEFORE_INTERPOLATION)
        return true;
    reasons.push_back("an error tolerance needs slabs, composited, and voxels of one component "
                      "looked up after interpolation; the sampling period is used");
    return false;
}

VolumeAppearance::Settings settingsInForce(const VolumeAppearance& appearance,
                                           const PreparedGeometry& prepared,
                                           VolumeAppearance::Lookup table, bool exactFiltering,
                                           bool adaptive)
{
    VolumeAppearance::Settings settings;
    Reasons& reasons = settings.reasons;
    explainTechnique(appearance, prepared, settings);
    settings.interpolation = usedInterpolation(appearance, reasons);
    settings.rayFunction = usedRayFunction(appearance, prepared, reasons);
    settings.shading = usesShading(appearance, prepared, settings.rayFunction, reasons);
    explainSampling(appearance, prepared, reasons);
    if (!voxelsIn(appearance, prepared)) return settings;
    explainLookup(appearance, prepared, table, settings);
    if (appearance.getErrorTolerance() > 0.0) (void)canKeepTolerance(appearance, prepared, reasons);
    settings.exactFiltering = settings.interpolation == VolumeAppearance::LINEAR &&
                              (appearance.getExactFiltering() || exactFiltering);
    if (settings.exactFiltering && !appearance.getExactFiltering())
        reasons.push_back("texture units may filter too coarsely for the error tolerance; "
                          "filtering is exact");
    if (adaptive)
        reasons.emplace_back("the error tolerance is kept by steps that are as long as the light "
                             "that they give allows");
    explainPaint(appearance, settings);
    return settings;
}

void reportReasons(const VolumeAppearance& appearance, const Reasons& reasons)
{
    for (const std::string& reason : reasons)
        reportOnce({ErrorCode::NOT_SUPPORTED,
                    "VolumeAppearance \"" + appearance.getName() + "\": " + reason});
}

} // namespace render
} // namespace osgVolumizer
