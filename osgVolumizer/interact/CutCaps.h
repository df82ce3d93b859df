#pragma once

#include "../core/Export.h"

#include <osg/Group>
#include <osg/ref_ptr>

namespace osgVolumizer {

class VolumeCut;

/// Slices that show the voxels on the surfaces of a cut, opaque: to be put below the appearance
/// whose cut it is, beside its geometry. They are VolumeSlices, one child a surface, which follow
/// the cut (VolumeSlice::setFollowsCut()), and may be given a window, a table or an opacity. Masks
/// have none. Of the cut as it is; after a change they are to be made anew.
OSGVOLUMIZER_EXPORT osg::ref_ptr<osg::Group> createCaps(const VolumeCut& cut);

} // namespace osgVolumizer
