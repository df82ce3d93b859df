#pragma once

#include <string>
#include <vector>

namespace osgVolumizer {
namespace test {

/// One file that includes another; paths from the project's folder, with '/'.
struct Include
{
    std::string file, target;

    bool operator==(const Include& o) const { return file == o.file && target == o.target; }
};

/// Layers from the top down. Each is the folders that it is made of; a file is in the innermost
/// folder that is named.
using Layers = std::vector<std::vector<std::string>>;

/// A number from 0, the top, on; -1 for a file in none.
int layerOf(const std::string& file, const Layers& layers);

/// Those that include something of a layer above their own. Files in none do not count.
std::vector<Include> upwardIncludes(const std::vector<Include>& includes, const Layers& layers);

} // namespace test
} // namespace osgVolumizer
