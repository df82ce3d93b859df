#pragma once

#include "Lattice.h"

#include <osgVolumizer/VoxelSource.h>

namespace osgVolumizer {
namespace vtkimage {

/// The even lattice for an uneven one: along each uneven axis as many samples as its shortest
/// spacing calls for, but no more than four times those that there are. Where that makes more than
/// eight times the samples in all and more than 2^24, or more bytes than half of what paged voxels
/// may take in memory (see Paging.h), fewer; never fewer than there are.
Lattice evenLattice(const Lattice& uneven, std::size_t bytesPerSample);

/// Voxels of an uneven lattice at the places of an even one, by trilinear interpolation; scalars
/// become floating point. Holes stay holes. \param error is set to the largest difference between
/// what is interpolated in the result at a sample of `voxels` and that sample.
/// TOO_LARGE where there is no memory, in words that do not name the file.
Result<osg::ref_ptr<MemoryVoxelSource>> resample(const MemoryVoxelSource& voxels,
                                                 const Lattice& uneven, const Lattice& even,
                                                 double& error);

} // namespace vtkimage
} // namespace osgVolumizer
