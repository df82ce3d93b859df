#pragma once

#include "Voxels.h"

#include <osgDB/Options>

#include <functional>
#include <string>
#include <vector>

namespace osgVolumizer {

/// Told how much of a long work is done, from 0 to 1.
using Progress = std::function<void(double fraction)>;

/// Reads a volume. `name`, found along OSG's data path, is
/// - a file that OpenImageIO opens: 3D TIFF, several subimages (pages) as slices, OpenEXR; spacing,
/// channels and time steps of a TIFF of ImageJ or OME;
/// - a folder of 2D images, in natural order, or a numbered pattern ("slice%03d.png",
/// "slice####.png") without gaps;
/// - a raw file as "name.raw.256,256,110,uint8[,headerBytes[,big|little]]", or one of NumPy (.npy);
/// - and where the plugin for it was built: DICOM, a file or a folder of series, in data values (HU
/// for a CT); NIfTI, Analyze, NRRD, MetaImage, MRC, Bio-Rad PIC (ITK); VTK's images and rectilinear
/// grids; OpenVDB; NetCDF and Zarr (GDAL); HDF5: of Imaris or BigDataViewer with their levels and
/// time steps, or a dataset of z,y,x or time,z,y,x.
/// What a file is, is told from how it begins, not from its name, where that can be.
/// Raw, NumPy and HDF5 files stay open and are read brick by brick, as bricks are asked for, and so
/// are large files of other formats, as far as those can be; all others are read into memory.
/// With series=on, a folder's files, or those of a pattern ("flow%03d.tif",
/// "flow%03d.raw.64,64,64,float32"), are volumes of one size and type, one for each time step: see
/// VoxelSeries, which opens each when it is shown.
/// Image row 0 is j = 0, the first slice k = 0. A single slice is drawn as thick as its spacing.
/// Four channels R, G, B, A make RGBA voxels, R, G, B their luminance, anything else its first
/// channel.
///
/// The option string of `options` holds, separated by blanks and all optional:
///   spacing=x,y,z  origin=x,y,z  range=low,high  brick=n | brick=x,y,z  overlap=n
///   partial=shrink_to_fit | truncate | average_up  series=on | off
///   dataset=name  channel=n  dimensions=x,y,z[,time]
/// Others are left alone: they may be readVolume()'s, or another loader's. The result refers to the
/// file by the name and options given here.
///
/// Refused: FILE_NOT_FOUND; FILE_UNREADABLE (cut short, or no volume); SIZE_MISMATCH (a raw file of
/// another length, unequal slices); VALUE_INVALID (option, raw format, or no such dataset);
/// INDEX_OUT_OF_RANGE (no such channel); NOT_SUPPORTED (a format whose plugin was not built, or
/// values that are no numbers); TOO_LARGE (more than 2^36 bytes, or than there is memory), found
/// before anything is allocated.
OSGVOLUMIZER_EXPORT Result<osg::ref_ptr<Voxels>> readVoxels(const std::string& name,
                                                            const osgDB::Options* options = nullptr,
                                                            const Progress& progress = {});

/// Reads 2D images of one size, a slice each, in the order given. The result refers to no file, and
/// so is stored inline in a scene.
OSGVOLUMIZER_EXPORT Result<osg::ref_ptr<Voxels>> readSlices(const std::vector<std::string>& names,
                                                            const osgDB::Options* options = nullptr,
                                                            const Progress& progress = {});

/// One of the volumes in a file or a folder: a dataset, a series, a grid, an array.
struct VolumeEntry
{
    std::string name; ///< what option dataset= takes; empty where there is nothing to choose
    std::string text; ///< what else the file says of it, in a line; may be empty
    osg::Vec3i size;  ///< samples per axis
    VoxelType type = VoxelType::UINT8; ///< as it is read
    int channels = 1;                  ///< numbers per sample; option channel= chooses
    int steps = 1;                     ///< of time
    bool chosen = false;               ///< what is read with these options
};

/// The volumes that readVoxels() finds under a name, with the same options; refused as by it.
OSGVOLUMIZER_EXPORT Result<std::vector<VolumeEntry>>
listVolumes(const std::string& name, const osgDB::Options* options = nullptr);

} // namespace osgVolumizer
