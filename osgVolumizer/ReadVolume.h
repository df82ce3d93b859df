#pragma once

#include "ReadVoxels.h"
#include "VolumeAppearance.h"

namespace osgVolumizer {

/// Reads a volume ready to be shown: voxels by readVoxels(), in one box. The option string of
/// `options` may also hold
///   unit=x      the opacity unit, in object units
///   table=file  a .lut or .tf, found along OSG's data path or beside the volume
/// Without a table, createSuggestedTable() makes one.
OSGVOLUMIZER_EXPORT Result<osg::ref_ptr<VolumeAppearance>>
readVolume(const std::string& name, const osgDB::Options* options = nullptr,
           const Progress& progress = {});

/// A table that shows something sensible of any scan, from the voxels' histogram over their range:
/// see core/transfer/ScanStatistics.h. Reads all bricks. RGBA voxels bring their own look; they get
/// the default table.
OSGVOLUMIZER_EXPORT osg::ref_ptr<LookupTable> createSuggestedTable(const Voxels& voxels);

} // namespace osgVolumizer
