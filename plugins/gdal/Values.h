#pragma once

#include <gdal_priv.h>

#include <memory>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace gdal {

// All functions here expect a Session.

using Array = std::shared_ptr<GDALMDArray>;
using Dimension = std::shared_ptr<GDALDimension>;

/// Attributes of an array: empty where one is missing or something else.
std::string textAttribute(const GDALMDArray& array, const char* name);
std::vector<double> numberAttribute(const GDALMDArray& array, const char* name);
/// Its unit: "degrees_north".
std::string unitOf(const GDALMDArray& array);
/// True where its values are numbers with one part.
bool isNumeric(const GDALMDArray& array);

/// The array of an axis, one number for each of its samples; null where there is none.
Array coordinateArray(const GDALGroup& group, const GDALDimension& dimension);
/// The values of such an array; empty where they cannot be read, or are too many.
std::vector<double> coordinateValues(const GDALMDArray& array);

} // namespace gdal
} // namespace osgVolumizer
