#pragma once

#include <osgVolumizer/VoxelSource.h>

/// A test pattern: the volume filled with cubes of `edge` voxels, in each of which the value falls
/// linearly from its centre to its surface. For integers from the type's highest value to 0, else
/// from 1 to 0.
class Cubes : public osgVolumizer::VoxelSource
{
public:
    META_Object(osgvolumizertool, Cubes)

        Cubes() = default;
    Cubes(const glm::ivec3& size, int edge, osgVolumizer::VoxelType type);
    Cubes(const Cubes& o, const osg::CopyOp& op) : VoxelSource(o, op), _edge(o._edge) {}

    Description describe() const override { return _description; }
    osgVolumizer::Status read(const osgVolumizer::core::Box3i& region,
                              void* destination) const override;

protected:
    ~Cubes() override = default;

private:
    Description _description;
    int _edge = 1;
};
