#pragma once

#include "Axis.h"

namespace osgVolumizer {
namespace gdal {

/// Linear between the samples that were read, x fastest. Beside a hole (NaN) the nearer of the two
/// counts. \param destination as many as the fetches have places
void interpolate(const double* samples, const Fetch (&fetch)[3], double* destination);

} // namespace gdal
} // namespace osgVolumizer
