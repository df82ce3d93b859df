#pragma once

#include "Voxels.h"

#include <osgDB/Options>

#include <string>

namespace osgVolumizer {

/// Reads a volume: a file that OpenImageIO opens (3D TIFF, several subimages, DICOM, OpenEXR, OpenVDB), a
/// folder or a numbered pattern ("slice%03d.png", "slice####.png") of 2D images, or a raw file as
/// "name.raw.256,256,110,uint8[,headerBytes[,big|little]]". Found along OSG's data path.
/// The option string of `options` holds, separated by blanks and all optional:
///   spacing=x,y,z  origin=x,y,z  range=low,high  brick=n | brick=x,y,z
/// (unit= and table= are for readVolume). The result refers to the file by the name given here.
OSGVOLUMIZER_EXPORT Result<osg::ref_ptr<Voxels>> readVoxels(const std::string& name,
                                                          const osgDB::Options* options = nullptr);

} // namespace osgVolumizer
