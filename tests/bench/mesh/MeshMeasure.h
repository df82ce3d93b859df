#pragma once

#include "MeshRenderer.h"

#include <support/Compare.h>

namespace osgVolumizer {
namespace bench {

/// One point of the chart: one renderer with one mesh.
struct MeshPoint
{
    std::string renderer;
    support::Difference difference;      ///< picture minus reference, red, green and blue
    std::vector<double> milliseconds;    ///< wall clock of a frame, one per round
    std::vector<double> cpuMilliseconds; ///< of all threads of the process
    support::FloatImage picture;         ///< of view 0
};

/// Every fourth pixel of view 0 in x and y, in double precision.
support::FloatImage meshReference(const MeshScene& scene);

/// Draws a scene with all renderers: one round after the other, in each every renderer, so that
/// whatever else the machine does falls on all alike. Pictures are of view 0. Each frame that is
/// timed is of a view that the renderer has not drawn before, after one of the view before that, so
/// that neither what only a first frame costs is counted nor what a view that stands still saves.
/// Renderers that do not draw the scene, or nothing of it, are left out, and said so.
std::vector<MeshPoint> measureMesh(const MeshScene& scene, const support::FloatImage& reference,
                                   const std::vector<MeshRendererPtr>& renderers, int rounds);

} // namespace bench
} // namespace osgVolumizer
