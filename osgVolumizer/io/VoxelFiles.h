#pragma once

#include "../ReadVoxels.h"
#include "RawName.h"

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
/// anything else its first channel.
Result<Source> readImage(const std::string& path, const Progress& progress);

/// The voxels of a stack of 2D images, one slice each, in this order; DICOM files in that of
/// readDicom().
Result<Source> readStack(const std::vector<std::string>& paths, const Progress& progress);

/// True where a file starts as DICOM does.
bool isDicomFile(const std::string& path);
/// True where a file is one DICOM slice, and another of its series lies in its folder.
bool isSliceOfSeries(const std::string& path);
/// One DICOM file with any number of frames, or one per slice, sorted along the patient (or by
/// instance number). Data values with slope and intercept (HU for a CT), in the narrowest type that
/// holds them; spacing in mm. NOT_SUPPORTED for what io/DicomHeader.h leaves out.
Result<Source> readDicom(const std::vector<std::string>& paths, const Progress& progress);

/// The images of a folder in natural order ("slice2" before "slice10"): the files of the extensions
/// that OpenImageIO knows, or, where there are none, those without an extension. Hidden files do
/// not count. `volumes`: where there are no images, the files of plugins (see io/PluginFile.h).
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
