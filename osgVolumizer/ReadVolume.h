#pragma once

#include "ReadVoxels.h"
#include "VolumeAppearance.h"

#include <osg/Matrixd>

namespace osgVolumizer {

/// Reads a volume ready to be shown: voxels by readVoxels(), in one box, with a look that pleases
/// without a setting. The option string of `options` may hold every property of VolumeAppearance by
/// its option (see AppearanceProperties.h; "ray=maximum shading=off"), and
///   table=file              a .lut or .tf, found along OSG's data path or beside the volume; a
///                           name with blanks stands in quotation marks
///   ramp=centre,width[,opacity]  a white table instead
///   orientation=LPS         where the voxel axes point, where the file does not say: left or
///                           right, posterior or anterior, superior or inferior; or file
/// Words of others are left alone, with a message at osg::INFO.
///
/// Where nothing is said: createSuggestedTable() makes the table; volumes of one component whose
/// values run smoothly are lit; views that move get frames of at most 1/15 s, and the exact picture
/// once they rest; time steps (series=on) are played, ten a second; a single slice faces the
/// viewer, unlit and nearly opaque (orientation=file: lies where it says). The appearance's
/// children are the box, turned as the file (or `orientation`) says, so that heads are up, and
/// above it an osg::LOD of one level: its bounding sphere is not that of the box but of what the
/// table shows, for viewers to frame. For that, and for the table, all bricks are read.
///
/// Frame: the file's own, in its unit; for medical files LPS, millimetres: x to the left of the
/// patient, y to the back, z to the head. So two scans of one patient, read by this, lie on each
/// other in one scene. Axes that are skewed or left-handed are shown as they are.
OSGVOLUMIZER_EXPORT Result<osg::ref_ptr<VolumeAppearance>>
readVolume(const std::string& name, const osgDB::Options* options = nullptr,
           const Progress& progress = {});

/// From the object frame of voxels to the frame of their file, as readVolume() places them: the
/// matrix of an osg::MatrixTransform for who builds a graph from readVoxels(). Identity where the
/// file does not say.
OSGVOLUMIZER_EXPORT osg::Matrixd getPlacement(const Voxels& voxels);

/// A table that shows something sensible of any scan, from the voxels' histogram over their range:
/// see core/transfer/ScanStatistics.h. Reads all bricks. RGBA voxels bring their own look; they get
/// the default table.
OSGVOLUMIZER_EXPORT osg::ref_ptr<LookupTable> createSuggestedTable(const Voxels& voxels);

/// An option of readVolume() as it is written, and what it is.
struct VolumeOption
{
    std::string name, values, help;
};
/// All of them, voxels first, then the table, then the properties of VolumeAppearance.
OSGVOLUMIZER_EXPORT std::vector<VolumeOption> volumeOptions();

} // namespace osgVolumizer
