#pragma once

#include <osgVolumizer/core/Status.h>
#include <osgVolumizer/core/geometry/TetraSet.h>

#include <osg/Vec2d>

#include <string>

class vtkUnstructuredGrid;

namespace osgVolumizer {
namespace vtk {

/// What a grid holds, as tetrahedra. Point colours are carried as C4F. Point scalars become voxel
/// coordinates (T3F) in a row of samples that hold the values of `range` evenly spread, so that
/// interpolation, lookup table and everything else work on them as on any volume.
struct GridGeometry
{
    core::TetraSet tetras;
    bool scalars = false;
    std::string name;                    ///< of the array
    osg::Vec2d range{0.0, 1.0};          ///< of the scalars
    double spacing = 1.0;                ///< object units between samples that the cells call for
    static constexpr int SAMPLES = 1024; ///< between the ends of the range
};

/// Takes tetrahedra, pyramids, wedges, hexahedra and voxels; what has no volume is left out.
/// \param arrayName of the point array to show; empty: the active scalars, else the only array
/// VALUE_INVALID where there are cells of other kinds, no such array, or values that are not
/// finite; INDEX_OUT_OF_RANGE with the cell. Messages do not name the file.
Result<GridGeometry> convertGrid(vtkUnstructuredGrid& grid, const std::string& arrayName);

} // namespace vtk
} // namespace osgVolumizer
