#pragma once

#include "Variables.h"

#include <osgVolumizer/core/Status.h>

#include <array>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace gdal {

/// Which of a variable's dimensions lie along x, y, z and time, by their number; -1 for none.
struct Roles
{
    std::array<int, 4> of{-1, -1, -1, -1};

    bool has(int dimension) const;
};

/// What attributes and units of the dimensions say (CF conventions), else their names, else the
/// type that GDAL gives them; of those that say nothing and have more than one sample, the last is
/// x, then y, z and time. Expects a Session.
Roles rolesOf(const Variable& variable);
/// As said: "lon,lat,level,time", two to four names, of which some may be empty. VALUE_INVALID for
/// a name that is not there, or there twice; the text lacks the path. Expects a Session.
Result<Roles> rolesOf(const Variable& variable, const std::string& dimensions);

} // namespace gdal
} // namespace osgVolumizer
