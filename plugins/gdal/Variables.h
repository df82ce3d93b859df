#pragma once

#include "Values.h"

#include <memory>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace gdal {

/// An array of a file that can be a volume: of numbers, with two axes or more that have more than
/// one sample.
struct Variable
{
    std::string path; ///< "/group/temperature"
    Array array;
    std::shared_ptr<GDALGroup> group;

    int longAxes() const; ///< those of more than one sample
    /// "temperature (time 4, level 10, lat 20, lon 40) K"
    std::string text() const;
};

/// Those of a group and of all within it. Expects a Session.
std::vector<Variable> variablesOf(const std::shared_ptr<GDALGroup>& root);

} // namespace gdal
} // namespace osgVolumizer
