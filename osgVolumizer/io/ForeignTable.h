#pragma once

#include "../core/Export.h"

#include <string>

namespace osgVolumizer {
namespace io {

/// What a table in another program's format is, by its text and the ending of its name: "a ParaView
/// colour map (JSON)". Empty for what looks like none of those that are known.
OSGVOLUMIZER_EXPORT std::string foreignTableFormat(const std::string& text,
                                                   const std::string& name);

} // namespace io
} // namespace osgVolumizer
