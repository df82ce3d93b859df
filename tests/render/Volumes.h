#pragma once

#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

#include <oracles/Grid.h>
#include <oracles/Scene.h>
#include <support/Compare.h>
#include <support/Hooks.h>
#include <support/OracleView.h>

#include <gtest/gtest.h>

#include <functional>
#include <memory>

namespace osgVolumizer {
namespace test {

/// For INSTANTIATE_TEST_SUITE_P.
inline std::string techniqueName(const ::testing::TestParamInfo<VolumeAppearance::Technique>& info)
{
    return info.param == VolumeAppearance::SLABS ? "Slabs" : "Slices";
}

using Points = std::vector<core::TransferFunction::Point>;

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

/// The same samples as an oracle's field in the voxel frame. Expects FLOAT32 scalars in memory.
inline std::shared_ptr<oracle::Grid> gridOf(const Voxels& voxels,
                                            oracle::Grid::Interpolation how = oracle::Grid::LINEAR)
{
    auto* source = dynamic_cast<MemoryVoxelSource*>(voxels.getSource());
    const glm::ivec3 size = voxels.getLayout().size();
    const auto count = std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    return std::make_shared<oracle::Grid>(
        size, oracle::toDoubles(source->data(), count, VoxelType::FLOAT32), how);
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
inline osg::ref_ptr<LookupTable> makeTable(Points points)
{
    osg::ref_ptr<LookupTable> table = new LookupTable;
    table->setPoints(std::move(points), LookupTable::RANGE_FRACTION);
    return table;
}

/// A table whose opacity, and with it what a constant value shows, is the same everywhere.
inline Points constantPoints(const glm::dvec4& color)
{
    return {{0.0, color}, {1.0, color}};
}

/// A volume in OSG and the same one for the oracle.
struct TwinVolume
{
    osg::ref_ptr<VolumeAppearance> node;
    oracle::Volume oracle;

    void setPeriod(double voxels) { node->setSamplingPeriod(osg::Vec3d(voxels, voxels, voxels)); }
};

inline TwinVolume makeTwin(Voxels* voxels, const Points& points,
                           VolumeAppearance::Technique technique = VolumeAppearance::AUTOMATIC)
{
    TwinVolume twin;
    twin.node = makeVolume(voxels);
    twin.node->setLookupTable(makeTable(points));
    twin.node->setTechnique(technique);
    const osg::Vec3d s = voxels->getSpacing(), o = voxels->getOrigin();
    twin.oracle =
        oracle::voxelVolume(gridOf(*voxels), voxels->getLayout().size(), oracle::Table(points),
                            {s.x(), s.y(), s.z()}, {o.x(), o.y(), o.z()});
    return twin;
}

/// The oracle's picture of what renderScene() shows with `options`.
inline support::FloatImage oraclePicture(const oracle::Scene& scene,
                                         const support::RenderOptions& options)
{
    return oracle::render(scene, support::oracleCamera(options));
}

/// The pixels where rasterisers may not disagree.
inline support::Mask awayFromSilhouettes(const oracle::Scene& scene,
                                         const support::RenderOptions& options)
{
    return support::coveredPixels(
        oracle::awayFromSilhouettes(scene, support::oracleCamera(options)));
}

inline oracle::Scene oracleScene(const oracle::Volume& volume)
{
    oracle::Scene scene;
    scene.volumes = {volume};
    return scene;
}

/// A Gaussian blob of height 1 and its place in the middle of the voxels.
inline osg::ref_ptr<Voxels> makeBlob(const glm::ivec3& size, double sigma)
{
    const oracle::GaussianField field(0.5 * glm::dvec3(size - 1), sigma);
    return makeVoxels(size, [&](const glm::dvec3& p) { return field.value(p); });
}

/// A smooth table of three colours, transparent for 0.
inline Points smoothPoints(double opacity)
{
    return {{0.0, {0.1, 0.2, 0.9, 0.0}}, {1.0, {1.0, 0.5, 0.1, opacity}}};
}

/// Something with detail in all directions and no symmetry, between 0 and 1.
inline double bumps(const glm::dvec3& p)
{
    return 0.5 + 0.2 * std::sin(0.43 * p.x + 0.7) + 0.15 * std::sin(0.51 * p.y + 0.31 * p.x) +
           0.15 * std::cos(0.37 * p.z - 0.2 * p.y);
}

} // namespace test
} // namespace osgVolumizer
