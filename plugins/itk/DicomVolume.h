#pragma once

#include <osgVolumizer/io/VolumeRequest.h>
#include <osgVolumizer/io/VoxelFiles.h>

namespace osgVolumizer {
namespace medical {

/// A series of DICOM files in calibrated values, in memory: of all files of the request, or of its
/// path alone. What was chosen, set aside or made good is told at OSG_NOTICE.
Result<io::Source> readDicom(const io::VolumeRequest& request);
/// The series of the files.
Result<std::vector<VolumeEntry>> listDicom(const io::VolumeRequest& request);

} // namespace medical
} // namespace osgVolumizer
