#include "TableChoice.h"

#include "../volume/SettingsInForce.h"
#include "AppearanceData.h"

#include <algorithm>

namespace osgVolumizer {
namespace render {

namespace {

bool keepsTolerance(const VolumeAppearance& appearance, const PreparedGeometry& prepared)
{
    if (!(appearance.getErrorTolerance() > 0.0)) return false;
    Reasons reasons;
    const bool kept = canKeepTolerance(appearance, prepared, reasons);
    reportReasons(appearance, reasons);
    return kept;
}

// What the nearest entry is off by counts for the less, the fewer samples there are.
bool isFine(double periodVoxel)
{
    return periodVoxel < 0.999;
}

} // namespace

TableChoice chooseTable(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                        const Precision& ofTextures)
{
    const osg::ref_ptr<AppearanceData> data = renderData<AppearanceData>(appearance);
    const osg::Vec2d range = appearance.getVoxels()->getRange();
    const osg::Vec3d period = appearance.getSamplingPeriod();
    const auto tableOf = [&](VolumeAppearance::Lookup lookup, double periodVoxel) {
        return data->tables.get(*appearance.getLookupTable(), range, lookup, isFine(periodVoxel));
    };
    const VolumeAppearance::Lookup lookup = usedLookup(appearance, prepared);
    if (!keepsTolerance(appearance, prepared))
        return {tableOf(lookup, std::min({period.x(), period.y(), period.z()})), std::nullopt,
                false};
    SamplingQuestion question;
    question.tolerance = appearance.getErrorTolerance();
    if (lookup != VolumeAppearance::PREINTEGRATED)
        question.midpoints = tableOf(VolumeAppearance::AFTER_INTERPOLATION, 1.0);
    if (lookup != VolumeAppearance::AFTER_INTERPOLATION)
        question.integrals = tableOf(VolumeAppearance::PREINTEGRATED, 1.0);
    question.frameToUnits =
        glm::dmat3(prepared.frameToObject) / appearance.getEffectiveOpacityUnit();
    question.box = prepared.regionBox;
    question.nearest = appearance.getInterpolation() == VolumeAppearance::NEAREST;
    const core::PeriodChoice choice = data->choices.get(*appearance.getVoxels(), question);
    const bool exact =
        !question.nearest && !choice.permits(ofTextures.filterWeight, question.tolerance);
    if (choice.integrals) return {question.integrals, choice.periodVoxel, exact};
    return {tableOf(VolumeAppearance::AFTER_INTERPOLATION, choice.periodVoxel), choice.periodVoxel,
            exact};
}

} // namespace render
} // namespace osgVolumizer
