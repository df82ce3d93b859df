#include "TableChoice.h"

#include "../volume/SettingsInForce.h"
#include "AppearanceData.h"

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

} // namespace

TableChoice chooseTable(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                        const Precision& ofTextures)
{
    const osg::ref_ptr<AppearanceData> data = renderData<AppearanceData>(appearance);
    const osg::Vec2d range = appearance.getVoxels()->getRange();
    const auto tableOf = [&](VolumeAppearance::Lookup lookup) {
        return data->tables.get(*appearance.getLookupTable(), range, lookup);
    };
    const VolumeAppearance::Lookup lookup = usedLookup(appearance, prepared);
    if (!keepsTolerance(appearance, prepared)) return {tableOf(lookup), std::nullopt, false};
    SamplingQuestion question;
    question.tolerance = appearance.getErrorTolerance();
    if (lookup != VolumeAppearance::PREINTEGRATED)
        question.midpoints = tableOf(VolumeAppearance::AFTER_INTERPOLATION);
    if (lookup != VolumeAppearance::AFTER_INTERPOLATION)
        question.integrals = tableOf(VolumeAppearance::PREINTEGRATED);
    question.frameToUnits =
        glm::dmat3(prepared.frameToObject) / appearance.getEffectiveOpacityUnit();
    question.box = prepared.regionBox;
    question.nearest = appearance.getInterpolation() == VolumeAppearance::NEAREST;
    const core::PeriodChoice choice = data->choices.get(*appearance.getVoxels(), question);
    return {choice.integrals ? question.integrals : question.midpoints, choice.periodVoxel,
            !question.nearest && !choice.permits(ofTextures.filterWeight, question.tolerance)};
}

} // namespace render
} // namespace osgVolumizer
