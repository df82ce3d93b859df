#pragma once

#include "Scenes.h"

#include <support/Compare.h>

namespace osgVolumizer {
namespace bench {

/// The double-precision picture of a scene and the pixels that are compared.
struct Reference
{
    support::FloatImage picture;
    support::Mask mask; ///< off the silhouettes of the box, where rasterisers may rightly disagree
    double remainingError = 0.0; ///< of the picture: largest change when the tolerance is tightened
};

/// Computed by the oracle on the first call, later read from the build folder's chart/.
Reference reference(const ChartScene& scene);

} // namespace bench
} // namespace osgVolumizer
