#pragma once

#include <osgVolumizer/core/Status.h>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <vector>

class vtkDataSet;

namespace osgVolumizer {
namespace vtkimage {

/// Where the samples of a data set lie, in its own frame: points, or middles of cells.
struct Lattice
{
    glm::ivec3 size{1};
    glm::dmat3 steps{1.0};    ///< from a sample to the next, a column for each axis
    glm::dvec3 position{0.0}; ///< of sample 0,0,0
    /// Along an axis whose samples are unevenly spaced, where they lie; empty for the others.
    std::array<std::vector<double>, 3> uneven;

    bool isEven() const { return uneven[0].empty() && uneven[1].empty() && uneven[2].empty(); }
};

/// Of an image or a rectilinear grid. Samples count as evenly spaced that lie within 1e-4 of their
/// spacing. VALUE_INVALID where coordinates are not in order, in words that do not name the file.
Result<Lattice> latticeOf(vtkDataSet& set, bool cells);

} // namespace vtkimage
} // namespace osgVolumizer
