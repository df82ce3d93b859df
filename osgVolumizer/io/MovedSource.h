#pragma once

#include "../Voxels.h"

namespace osgVolumizer {
namespace io {

/// The source of voxels, of its first time step, where they are said to lie now.
class MovedSource : public VoxelSource
{
public:
    META_Object(osgVolumizer, MovedSource);

    MovedSource() = default;
    MovedSource(const MovedSource& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY)
        : VoxelSource(o, op), _source(o._source), _description(o._description)
    {
    }
    explicit MovedSource(const Voxels& voxels)
        : _source(voxels.getSource()), _description(voxels.getSource()->describe())
    {
        const osg::Vec3d spacing = voxels.getSpacing(), origin = voxels.getOrigin();
        _description.spacing = {spacing.x(), spacing.y(), spacing.z()};
        _description.origin = {origin.x(), origin.y(), origin.z()};
    }
    Description describe() const override { return _description; }
    Status read(const core::Box3i& region, void* destination) const override
    {
        return _source->read(region, destination);
    }

protected:
    ~MovedSource() override = default;

private:
    osg::ref_ptr<const VoxelSource> _source;
    Description _description;
};

} // namespace io
} // namespace osgVolumizer
