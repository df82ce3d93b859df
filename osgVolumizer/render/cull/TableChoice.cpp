#include "TableChoice.h"

#include "../draw/RayFunctions.h"
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

// Of a deformed volume as if it were not.
glm::dmat3 voxelToObject(const Voxels& voxels, const PreparedGeometry& prepared)
{
    if (prepared.voxelFrame) return glm::dmat3(prepared.frameToObject);
    const osg::Vec3d s = voxels.getSpacing();
    return glm::dmat3(s.x(), 0.0, 0.0, 0.0, s.y(), 0.0, 0.0, 0.0, s.z());
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
    const Voxels& voxels = *appearance.getVoxels();
    question.frameToUnits = voxelToObject(voxels, prepared) / appearance.getEffectiveOpacityUnit();
    question.box = prepared.voxelFrame ? prepared.regionBox : voxels.getLayout().extent();
    question.nearest = appearance.getInterpolation() == VolumeAppearance::NEAREST;
    const core::PeriodChoice choice = data->choices.get(voxels, question);
    return {choice.integrals ? question.integrals : question.midpoints, choice.periodVoxel,
            !question.nearest && !choice.permits(ofTextures.filterWeight, question.tolerance)};
}

TableChoice chooseTable(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                        const osg::Vec2d& scalarRange)
{
    const osg::ref_ptr<AppearanceData> data = renderData<AppearanceData>(appearance);
    const LookupTable& table = *appearance.getLookupTable();
    Reasons reasons;
    const bool gathers = rowOf(usedRayFunction(appearance, prepared, reasons)).gathers;
    return {gathers ? data->tables.get(table, scalarRange, VolumeAppearance::AFTER_INTERPOLATION)
                    : data->tables.points(table, scalarRange),
            std::nullopt, false};
}

} // namespace render
} // namespace osgVolumizer
