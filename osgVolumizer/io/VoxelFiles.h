#pragma once

#include "../ReadVoxels.h"
#include "RawName.h"

#include <optional>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace io {

using Source = osg::ref_ptr<VoxelSource>;
using MemorySource = osg::ref_ptr<MemoryVoxelSource>;

/// The voxels of a raw file, read as they are asked for. The file must have exactly the bytes that
/// the name says: fewer are FILE_UNREADABLE, more SIZE_MISMATCH.
Result<Source> readRaw(const RawName& raw, const std::string& path, const Progress& progress);

/// The voxels of a pyramid (see io/PyramidFormat.h), read as they are asked for.
Result<Source> readPyramid(const std::string& path);

/// The voxels of one file that OpenImageIO opens: the first subimage where that has depth, else all
/// subimages as slices; row 0 of an image is j = 0. Integers keep their values. Four channels R, G,
/// B, A make RGBA voxels with straight alpha as stored; R, G, B their luminance (Rec. 709);
/// anything else its first channel, or the one that is asked for.
Result<Source> readImage(const std::string& path, std::optional<int> channel,
                         const Progress& progress);

/// What readImage() would read, without reading pixels.
Result<VolumeEntry> listImage(const std::string& path, std::optional<int> channel);

/// The array of a NumPy file (.npy), of z,y,x or time,z,y,x, read as it is asked for: the last
/// dimension is x where the order is C's, the first where it is Fortran's. NOT_SUPPORTED for
/// numbers that no voxels are of.
Result<Source> readNumpy(const std::string& path, const Progress& progress);

/// The voxels of a stack of 2D images, one slice each, in this order.
Result<Source> readStack(const std::vector<std::string>& paths, std::optional<int> channel,
                         const Progress& progress);

/// The images of a folder in natural order ("slice2" before "slice10"): DICOM files, where there
/// are any; else those of the extensions that OpenImageIO knows, or, where there are none, those
/// without an extension. Hidden files do not count. Folders within are looked into for DICOM files
/// where a folder has no files but those of the standard's own (DICOMDIR). `volumes`: where there
/// are no images, the files of plugins (see io/PluginFile.h).
Result<std::vector<std::string>> listFolder(const std::string& folder, bool volumes = false);

/// True where a name holds "%d", "%03d" or "###".
bool looksLikePattern(const std::string& name);
/// The files of a numbered pattern, by number, which must have no gaps. A pattern with a relative
/// folder is looked for in each of `folders`.
Result<std::vector<std::string>> listPattern(const std::string& pattern,
                                             const std::vector<std::string>& folders);

/// Numbers within names compare as numbers, everything else by its bytes.
bool naturalLess(const std::string& a, const std::string& b);

} // namespace io
} // namespace osgVolumizer
