#pragma once

#include "Lattice.h"

#include <osgVolumizer/VoxelSource.h>

namespace osgVolumizer {
namespace vtkimage {

/// The even lattice for an uneven one: along each uneven axis as many samples as its shortest
/// spacing calls for, but no more than four times those that there are. Where that makes more than
/// 2^31 samples in all, fewer.
Lattice evenLattice(const Lattice& uneven);

/// Voxels of an uneven lattice at the places of an even one, by trilinear interpolation; scalars
/// become floating point. Holes stay holes. \param error is set to the largest difference between
/// what is interpolated in the result at a sample of `voxels` and that sample.
/// TOO_LARGE where there is no memory, in words that do not name the file.
Result<osg::ref_ptr<MemoryVoxelSource>> resample(const MemoryVoxelSource& voxels,
                                                 const Lattice& uneven, const Lattice& even,
                                                 double& error);

} // namespace vtkimage
} // namespace osgVolumizer
