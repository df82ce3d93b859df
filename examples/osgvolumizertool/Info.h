#pragma once

#include <osgVolumizer/ReadVoxels.h>

#include <iosfwd>

/// All that is known of a volume: size, type, where it lies, levels and time steps, the range of
/// its values and a histogram, and the memory that it takes. Reads all of it, or, where it is
/// paged, a
/// coarse level; fails with what reading does.
osgVolumizer::Status printInfo(std::ostream& out, const osgVolumizer::Voxels& voxels);

/// The volumes of a file or folder, a line each: what dataset= takes, and what there is.
void printList(std::ostream& out, const std::vector<osgVolumizer::VolumeEntry>& entries);
