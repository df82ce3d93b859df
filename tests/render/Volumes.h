#pragma once

#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

#include <functional>

namespace osgVolumizer {
namespace test {

/// Float voxels from a function of the voxel frame.
inline osg::ref_ptr<Voxels> makeVoxels(const glm::ivec3& size,
                                       const std::function<double(const glm::dvec3&)>& value)
{
    VoxelSource::Description description;
    description.size = size;
    description.type = VoxelType::FLOAT32;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    source->allocate(description);
    float* out = static_cast<float*>(source->data());
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                *out++ = static_cast<float>(value(glm::dvec3(x, y, z)));
    osg::ref_ptr<Voxels> voxels = new Voxels(source);
    voxels->setRange(osg::Vec2d(0.0, 1.0));
    return voxels;
}

/// A volume of the whole box of voxels.
inline osg::ref_ptr<VolumeAppearance> makeVolume(Voxels* voxels)
{
    osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->setVoxels(voxels);
    appearance->addChild(VolumeGeometry::createBox(*voxels));
    return appearance;
}

/// A table from points (fraction of the range, straight RGBA).
inline osg::ref_ptr<LookupTable> makeTable(std::vector<core::TransferFunction::Point> points)
{
    osg::ref_ptr<LookupTable> table = new LookupTable;
    table->setPoints(std::move(points), LookupTable::RANGE_FRACTION);
    return table;
}

} // namespace test
} // namespace osgVolumizer
