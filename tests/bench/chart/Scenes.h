#pragma once

#include <osgVolumizer/core/transfer/TransferFunction.h>
#include <osgVolumizer/core/voxels/VoxelType.h>

#include "Meshes.h"

#include <oracles/Grid.h>
#include <support/SceneRenderer.h>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <string>
#include <vector>

namespace osgVolumizer {
namespace bench {

/// A box of voxels in the object frame (= voxel frame moved by `origin`, spacing 1, opacity unit 1)
/// and one table. World = object frame.
struct ChartVolume
{
    glm::ivec3 size{0};
    glm::dvec3 origin{0.0}; ///< object position of sample (0,0,0)
    VoxelType type = VoxelType::FLOAT32;
    std::vector<unsigned char> voxels;                ///< x fastest, native byte order
    glm::dvec2 range{0.0, 1.0};                       ///< data values at the table's two ends
    std::vector<core::TransferFunction::Point> table; ///< fraction of the range

    /// The box of the samples in the object frame.
    glm::dvec3 boxMin() const { return origin; }
    glm::dvec3 boxMax() const { return origin + glm::dvec3(size - 1); }
    /// Data values of the samples.
    std::vector<double> values() const;
};

/// Translucent triangles of one colour, unlit.
struct ChartSurface
{
    test::Mesh mesh;       ///< world frame
    glm::dvec4 color{0.0}; ///< straight RGBA
};

/// What every renderer draws: volumes (one, unless said otherwise), surfaces and one view.
struct ChartScene
{
    std::string name;
    std::string description;
    std::vector<ChartVolume> volumes;
    std::vector<ChartSurface> surfaces;
    support::RenderOptions view;
    bool shaded = false;  ///< by a head light, with normals from central differences
    double ambient = 0.3; ///< where shaded: colour * (ambient + diffuse * |normal . light|)
    double diffuse = 0.7;

    /// For renderers of nothing else.
    bool isOneVolume() const { return volumes.size() == 1 && surfaces.empty(); }
};

/// The scenes of the chart, in order; those named in `filters`, or all. The MR
/// head is read from the source tree's data/.
std::vector<ChartScene> chartScenes(const std::vector<std::string>& filters);

} // namespace bench
} // namespace osgVolumizer
