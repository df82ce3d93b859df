#pragma once

#include "Scene.h"

namespace osgVolumizer {
namespace oracle {

/// What a ray meets of a volume's values.
struct Projection
{
    double maximum = 0.0;
    double minimum = 0.0;
    double integral = 0.0; ///< of the value over the length in opacity units
    double length = 0.0;   ///< opacity units
};

/// Values on the ray through window position (x, y); false where it misses. Expects a field that is
/// linear interpolation of samples, so that along the ray it is a cubic between its breaks.
bool project(const Volume& volume, const Camera& camera, double x, double y, Projection& result);

/// Depth of the first place where the field takes a value; false where it nowhere does. The same
/// field.
bool firstCrossing(const Volume& volume, const Camera& camera, double x, double y, double value,
                   double& depth);

} // namespace oracle
} // namespace osgVolumizer
