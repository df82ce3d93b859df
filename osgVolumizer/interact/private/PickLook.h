#pragma once

#include "../../VolumeAppearance.h"
#include "../../core/transfer/PreIntegration.h"
#include "../../core/voxels/VoxelData.h"
#include "../../render/volume/PreparedGeometry.h"

#include <memory>

namespace osgVolumizer {
namespace picking {

/// A function of the fraction of the voxels' range, and its integrals.
struct PickTable
{
    explicit PickTable(LookupTable::Function f) : function(std::move(f)), integral(*function) {}

    LookupTable::Function function;
    core::TransferIntegral integral;
};

/// How a volume is drawn, as far as picking has to know: the settings in force, and what values
/// become. Immutable.
struct PickLook
{
    VolumeAppearance::RayFunction rayFunction = VolumeAppearance::COMPOSITE;
    VolumeAppearance::Interpolation interpolation = VolumeAppearance::LINEAR;
    bool before = false;  ///< samples are looked up, and extinctions interpolated
    bool paints = false;  ///< shows nothing by itself
    bool voxels = true;   ///< else vertex colours alone are shown
    bool plain = false;   ///< not even those: half opaque a unit
    bool scalars = false; ///< of an unstructured grid, in place of voxels
    /// Of RGBA voxels the values are opacities.
    bool rgba = false;
    /// Value in data units -> fraction of the range, or opacity: scale and offset.
    double scale = 1.0, offset = 0.0;
    std::shared_ptr<const PickTable> table; ///< of fractions; of RGBA voxels an opacity is itself
    double isoFraction = 0.0;
    double opacityUnit = 1.0; ///< object units

    double fraction(double value) const { return scale * value + offset; }
    /// Extinction per opacity unit, of a value (as a fraction), and its mean over a run of them.
    double extinction(double fraction) const;
    double meanExtinction(double from, double to) const;
    /// Opacity of a layer one unit thick; the largest of the values between two.
    double opacity(double fraction) const { return table->function->evaluate(fraction).a; }
    double maximumOpacity(double lowFraction, double highFraction) const
    {
        return table->function->maximumOpacity(lowFraction, highFraction);
    }
};

/// \param scalarRange of a geometry with scalars
PickLook makePickLook(const VolumeAppearance& appearance, const render::PreparedGeometry& prepared,
                      const osg::Vec2d& scalarRange);

} // namespace picking
} // namespace osgVolumizer
