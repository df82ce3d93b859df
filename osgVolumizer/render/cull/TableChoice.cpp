#include "TableChoice.h"

#include "../draw/RayFunctions.h"
#include "../volume/SettingsInForce.h"
#include "AppearanceData.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

// Tolerances. If none of a thousand rays meets what samples miss, up to three more of a thousand
// may, at 95 %: that is a twentieth of it, root mean square.
constexpr double MOST_MISSED = 15.0;

bool keepsTolerance(const VolumeAppearance& appearance, const PreparedGeometry& prepared)
{
    if (!(appearance.getErrorTolerance() > 0.0)) return false;
    Reasons reasons;
    const bool kept = canKeepTolerance(appearance, prepared, reasons);
    reportReasons(appearance, reasons);
    return kept;
}

// Of a deformed volume as if it were not.
glm::dmat3 voxelToObject(const Voxels& voxels, const PreparedGeometry& prepared)
{
    if (prepared.voxelFrame) return glm::dmat3(prepared.frameToObject);
    const osg::Vec3d s = voxels.getSpacing();
    return glm::dmat3(s.x(), 0.0, 0.0, 0.0, s.y(), 0.0, 0.0, 0.0, s.z());
}

SamplingQuestion questionFor(const VolumeAppearance& appearance, const PreparedGeometry& prepared)
{
    using A = VolumeAppearance;
    const osg::ref_ptr<AppearanceData> data = renderData<AppearanceData>(appearance);
    const Voxels& voxels = *appearance.getVoxels();
    const osg::Vec2d range = voxels.getRange();
    const auto tableOf = [&](A::Lookup lookup) {
        return data->tables.get(*appearance.getLookupTable(), range, lookup);
    };
    const A::Lookup lookup = usedLookup(appearance, prepared);
    SamplingQuestion question;
    question.tolerance = appearance.getErrorTolerance();
    question.opaqueEnough = opaqueEnoughFor(question.tolerance);
    question.cells = (lookup == A::AUTOMATIC_LOOKUP || lookup == A::CELL_BY_CELL) &&
                     canSplitRays(appearance, prepared);
    const bool steps = lookup != A::CELL_BY_CELL;
    const bool runs =
        lookup != A::AFTER_INTERPOLATION && appearance.getInterpolation() != A::NEAREST;
    if (steps && lookup != A::PREINTEGRATED) question.midpoints = tableOf(A::AFTER_INTERPOLATION);
    if (steps && runs) question.integrals = tableOf(A::PREINTEGRATED);
    // What random rays may have missed, too, is not left to chance.
    if (runs && question.midpoints.missed > MOST_MISSED * question.tolerance)
        question.midpoints = TableTexture();
    question.intervals = tableOf(A::CELL_BY_CELL);
    question.frameToUnits = voxelToObject(voxels, prepared) / appearance.getEffectiveOpacityUnit();
    question.box = prepared.voxelFrame ? prepared.regionBox : voxels.getLayout().extent();
    question.nearest = appearance.getInterpolation() == A::NEAREST;
    Reasons ofOthers;
    const A::RayFunction function = usedRayFunction(appearance, prepared, ofOthers);
    if (usesShading(appearance, prepared, function, ofOthers)) {
        const A::Material& m = appearance.getMaterial();
        // Powers of two, so that small changes of a light change nothing.
        const double brightness = std::exp2(std::ceil(std::log2(*data->brightness)));
        question.shading = core::RayShading{m.ambient, m.diffuse * brightness,
                                            m.specular * brightness, m.shininess};
    }
    return question;
}

// Keeps every tolerance, whatever the data, at more than its price.
core::PeriodChoice safeChoice(const SamplingQuestion& question)
{
    core::PeriodChoice choice;
    if (question.shading && question.integrals.texture) {
        // Normals turn faster than values change, and steps that adapt see more of them.
        const double period = 0.06 * std::sqrt(question.tolerance / 1e-3);
        choice.rule = core::RayRule::ADAPTIVE;
        choice.periodVoxel = std::clamp(period, 1.0 / 32.0, 0.25);
    } else if (question.cells) {
        // Of white noise, the worst that there is, pieces of a voxel are off by up to 1.4e-3,
        // halves by 1.2e-4, and so on: they are of third order at least.
        const double tolerance = question.tolerance;
        choice.rule = core::RayRule::CELLS;
        choice.periodVoxel = tolerance >= 3e-3   ? 1.0
                             : tolerance >= 2e-4 ? 0.5
                             : tolerance >= 2e-5 ? 0.25
                                                 : 0.125;
        if (question.shading) choice.periodVoxel *= 0.25;
    } else {
        choice.rule =
            question.integrals.texture ? core::RayRule::INTEGRALS : core::RayRule::MIDPOINTS;
        choice.periodVoxel = 1.0 / 16.0;
    }
    return choice;
}

} // namespace

TableChoice chooseTable(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                        const Precision& ofTextures)
{
    const osg::ref_ptr<AppearanceData> data = renderData<AppearanceData>(appearance);
    const Voxels& voxels = *appearance.getVoxels();
    if (!keepsTolerance(appearance, prepared)) {
        TableChoice choice;
        choice.table = data->tables.get(*appearance.getLookupTable(), voxels.getRange(),
                                        usedLookup(appearance, prepared));
        return choice;
    }
    const SamplingQuestion question = questionFor(appearance, prepared);
    const std::optional<core::PeriodChoice> known = data->choices.get(voxels, question);
    const core::PeriodChoice made = known ? *known : safeChoice(question);
    TableChoice choice;
    choice.table = made.rule == core::RayRule::CELLS       ? question.intervals
                   : made.rule == core::RayRule::MIDPOINTS ? question.midpoints
                                                           : question.integrals;
    choice.adaptive = made.rule == core::RayRule::ADAPTIVE;
    choice.periodVoxel = made.periodVoxel;
    choice.refining = !known;
    choice.expectedError = made.error;
    choice.exactFiltering =
        !question.nearest && ofTextures.filterWeight > 0.0 &&
        (!known || question.shading || !made.permits(ofTextures.filterWeight, question.tolerance));
    return choice;
}

TableChoice chooseTable(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                        const osg::Vec2d& scalarRange)
{
    const osg::ref_ptr<AppearanceData> data = renderData<AppearanceData>(appearance);
    const LookupTable& table = *appearance.getLookupTable();
    Reasons reasons;
    const bool gathers = rowOf(usedRayFunction(appearance, prepared, reasons)).gathers;
    TableChoice choice;
    choice.table = gathers
                       ? data->tables.get(table, scalarRange, VolumeAppearance::AFTER_INTERPOLATION)
                       : data->tables.points(table, scalarRange);
    return choice;
}

} // namespace render
} // namespace osgVolumizer
