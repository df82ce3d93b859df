#pragma once

#include "../ReadVoxels.h"

#include <osg/Object>

#include <vector>

namespace osgVolumizer {
namespace io {

/// What a plugin says there is in a file: see listVolumes().
class OSGVOLUMIZER_EXPORT VolumeContents : public osg::Object
{
public:
    META_Object(osgVolumizer, VolumeContents);

    VolumeContents() = default;
    VolumeContents(const VolumeContents& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY)
        : osg::Object(o, op), entries(o.entries)
    {
    }
    std::vector<VolumeEntry> entries;

protected:
    ~VolumeContents() override;
};

} // namespace io
} // namespace osgVolumizer
