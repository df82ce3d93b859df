#pragma once

#include <osgVolumizer/VolumeGeometry.h>

#include <gtest/gtest.h>
#include <oracles/TestMeshes.h>
#include <oracles/TetraMesh.h>

#include <utility>
#include <vector>

namespace osgVolumizer {
namespace test {

/// A lattice of tetrahedra over a cube of so many voxels per axis, as voxel coordinates and as
/// positions; `bend` is what points inside are off by, in voxels.
inline osg::ref_ptr<VolumeGeometry> deformedLattice(int size, double bend, int n = 4)
{
    oracle::TetraMesh mesh = oracle::latticeMesh(glm::ivec3(n));
    oracle::jitter(mesh, 0.2 / n, 5);
    core::TetraSet set;
    set.vertices = core::VertexArray(core::VertexLayout::T3F_V3F);
    set.vertices.resize(mesh.points.size());
    const std::vector<bool> outer = oracle::boundaryPoints(mesh);
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
        const glm::dvec3 voxel = double(size - 1) * mesh.points[i];
        set.vertices.setPosition(i, voxel);
        set.vertices.setVoxelCoordinate(i, voxel + (outer[i] ? 0.0 : bend));
    }
    for (const auto& cell : mesh.cells)
        set.indices.insert(set.indices.end(), cell.begin(), cell.end());
    osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    EXPECT_TRUE(geometry->setTetraSet(std::move(set)).ok());
    return geometry;
}

} // namespace test
} // namespace osgVolumizer
