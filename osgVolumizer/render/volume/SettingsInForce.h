#pragma once

#include "PreparedGeometry.h"

#include "../../VolumeAppearance.h"

#include <string>
#include <vector>

namespace osgVolumizer {
namespace render {

/// Why settings of an appearance are not in force: what cannot be done, and what is done instead.
using Reasons = std::vector<std::string>;

/// The voxels that fill a geometry; null where there are none, or scalars.
const Voxels* voxelsIn(const VolumeAppearance& appearance, const PreparedGeometry& prepared);

// Each of the following adds its reasons, which a frame reports as errors.

/// What bricks that share too few samples leave of CUBIC.
VolumeAppearance::Interpolation usedInterpolation(const VolumeAppearance& appearance,
                                                  Reasons& reasons);
/// Slabs, where they were not ruled out, or slices.
bool usesSlabs(const VolumeAppearance& appearance, const PreparedGeometry& prepared);
/// Slabs whose rays walk through tetrahedra: of all but convex regions of voxels in one frame.
bool usesTetrahedra(const VolumeAppearance& appearance, const PreparedGeometry& prepared);
VolumeAppearance::RayFunction usedRayFunction(const VolumeAppearance& appearance,
                                              const PreparedGeometry& prepared, Reasons& reasons);
bool usesShading(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                 VolumeAppearance::RayFunction function, Reasons& reasons);
/// Of sampling mode and space, where slabs make nothing of them.
void explainSampling(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                     Reasons& reasons);
/// Of a lookup that is asked for, where another one is in force. Expects voxels.
void explainLookup(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                   Reasons& reasons);
/// When the table can be applied, of what the appearance asks for: AUTOMATIC_LOOKUP where the table
/// is to decide. Expects voxels.
VolumeAppearance::Lookup usedLookup(const VolumeAppearance& appearance,
                                    const PreparedGeometry& prepared);
/// Whether rays can be split at faces of cells and corners of the table: composited slabs of one
/// component that is not interpolated cubically, and does not paint. Expects voxels.
bool canSplitRays(const VolumeAppearance& appearance, const PreparedGeometry& prepared);
/// What is left of the light where rays end that keep a tolerance.
double opaqueEnoughFor(double tolerance);
/// Whether samples are looked up before they are interpolated.
bool looksUpBefore(const VolumeAppearance& appearance, VolumeAppearance::RayFunction function,
                   VolumeAppearance::Interpolation interpolation);
/// Whether periods can be chosen for an error tolerance: composited slabs of voxels of
/// one component that are looked up after interpolation. Expects voxels.
bool canKeepTolerance(const VolumeAppearance& appearance, const PreparedGeometry& prepared,
                      Reasons& reasons);

/// All of them together. `table`: how that which is used is read.
/// `exactFiltering`: whether an error tolerance needs that; `adaptive`: whether steps adapt for it.
VolumeAppearance::Settings settingsInForce(const VolumeAppearance& appearance,
                                           const PreparedGeometry& prepared,
                                           VolumeAppearance::Lookup table, bool exactFiltering,
                                           bool adaptive);
/// That an error is expected which is more than what was asked for; nothing where none is known.
void explainError(double tolerance, double expectedError, Reasons& reasons);

/// Reports each reason once in the life of the process.
void reportReasons(const VolumeAppearance& appearance, const Reasons& reasons);

} // namespace render
} // namespace osgVolumizer
