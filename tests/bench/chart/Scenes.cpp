#include "Scenes.h"

#include "../support/Tables.h"

#include <osgVolumizer/LookupTable.h>
#include <osgVolumizer/ReadVoxels.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>

namespace osgVolumizer {
namespace bench {

namespace {

using ScalarFunction = std::function<double(const glm::dvec3&)>;

constexpr int SIZE = 128;

// Function of the object coordinate with values in [0, 1], stored over the whole range of the type.
ChartVolume makeVolume(const glm::ivec3& size, const glm::dvec3& origin, VoxelType type,
                       const ScalarFunction& f, const TablePoints& table)
{
    ChartVolume volume;
    volume.size = size;
    volume.origin = origin;
    volume.type = type;
    volume.table = table;
    const double top = type == VoxelType::UINT8 ? 255.0 : type == VoxelType::UINT16 ? 65535.0 : 1.0;
    std::vector<double> values;
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                values.push_back(top * f(origin + glm::dvec3(x, y, z)));
    volume.voxels = oracle::fromDoubles(values, type);
    volume.range = {0.0, top};
    return volume;
}

// The test signal over a cube of `size` samples.
double marschnerLobb(const glm::dvec3& voxel, int size = SIZE)
{
    static const oracle::MarschnerLobbField field;
    return field.value(voxel * (2.0 / (size - 1)) - 1.0);
}

// One in the middle, exactly zero from 24 voxels on, and smooth between.
double blob(const glm::dvec3& voxel)
{
    const glm::dvec3 d = (voxel - 0.5 * (SIZE - 1)) / 24.0;
    const double s = 1.0 - glm::dot(d, d);
    return s > 0.0 ? s * s : 0.0;
}

// By default of the 128^3 box, for whatever part of it has voxels.
void setView(ChartScene& scene, bool perspective, int pixels,
             const osg::Vec3d& center = {63.5, 63.5, 63.5}, double distance = 330.0)
{
    const osg::Vec3d direction(0.42, 0.76, -0.5);
    scene.view.size(pixels, pixels);
    if (perspective)
        scene.view.perspective(40.0);
    else
        scene.view.orthographic(112.0);
    scene.view.lookAt(center - direction * distance, center, {0.0, 0.0, 1.0});
}

ChartScene synthetic(ChartVolume volume, bool perspective = true, int pixels = 512)
{
    ChartScene scene;
    scene.volumes.push_back(std::move(volume));
    setView(scene, perspective, pixels);
    return scene;
}

ChartVolume marschnerLobbVolume(VoxelType type, const TablePoints& table)
{
    return makeVolume(
        glm::ivec3(SIZE), glm::dvec3(0.0), type,
        [](const glm::dvec3& p) { return marschnerLobb(p); }, table);
}

// The test signal twice as fine, from twice as far.
ChartScene large()
{
    constexpr int size = 2 * SIZE;
    ChartScene scene;
    scene.volumes.push_back(makeVolume(
        glm::ivec3(size), glm::dvec3(0.0), VoxelType::FLOAT32,
        [](const glm::dvec3& p) { return marschnerLobb(p, size); }, smoothTable(0.03)));
    setView(scene, true, 1024, {127.5, 127.5, 127.5}, 660.0);
    return scene;
}

// The test signal in two boxes that share about half of their space, in other colours.
ChartScene overlapping()
{
    ChartScene scene = synthetic(marschnerLobbVolume(VoxelType::FLOAT32, smoothTable(0.04)));
    TablePoints table = smoothTable(0.04);
    for (auto& point : table)
        point.color = {point.color.b, point.color.r, point.color.g, point.color.a};
    const glm::dvec3 origin(28.5, -20.25, 16.75);
    scene.volumes.push_back(makeVolume(
        glm::ivec3(SIZE), origin, VoxelType::FLOAT32,
        [&origin](const glm::dvec3& p) { return 1.0 - marschnerLobb(p - origin); }, table));
    const glm::dvec3 center = 63.5 + 0.5 * origin;
    setView(scene, true, 512, {center.x, center.y, center.z}, 370.0);
    return scene;
}

ChartScene withSpheres()
{
    ChartScene scene = synthetic(marschnerLobbVolume(VoxelType::FLOAT32, smoothTable(0.06)));
    const auto add = [&scene](const glm::dvec3& center, double radius, const glm::dvec4& color) {
        scene.surfaces.push_back({test::sphereMesh(center, radius, 100, 51), color});
    };
    add({44, 50, 60}, 24, {0.2, 0.9, 0.3, 0.4});
    add({80, 70, 64}, 28, {0.9, 0.3, 0.2, 0.4});
    add({64, 64, 90}, 20, {0.2, 0.4, 0.9, 0.4});
    return scene;
}

// The MR scan that the library ships, as its own scene file shows it.
ChartScene head(bool shaded)
{
    ChartScene scene;
    scene.shaded = shaded;
    const std::string folder = OSGVOLUMIZER_SOURCE_DIR "/data/";
    const auto voxels = readVoxels(folder + "head.tif");
    const auto table = readLookupTable(folder + "head.lut");
    if (!voxels.ok() || !table.ok()) {
        std::cerr << (voxels.ok() ? table.status.text : voxels.status.text) << "\n";
        return scene;
    }
    ChartVolume volume;
    volume.size = (*voxels)->getLayout().size();
    volume.type = (*voxels)->getType();
    const VoxelBlock block = (*voxels)->getBrick(0);
    volume.voxels.assign(block.data, block.data + block.bytes);
    volume.range = {0.0, 255.0};
    volume.table = (*table)->getNormalizedFunction(osg::Vec2d(0.0, 255.0))->points();
    scene.volumes.push_back(std::move(volume));
    const osg::Vec3d center(63.5, 63.5, 41.5), direction(0.64, 0.12, 0.76);
    scene.view.size(512, 512).perspective(30.0);
    scene.view.lookAt(center - direction * 330.0, center, {0.0, -1.0, 0.0});
    return scene;
}

struct SceneEntry
{
    const char* name;
    const char* description;
    std::function<ChartScene()> make;
};

std::vector<SceneEntry> entries()
{
    const VoxelType f = VoxelType::FLOAT32;
    const auto field = [](VoxelType type, const TablePoints& table, bool perspective = true,
                          int pixels = 512) {
        return [=] { return synthetic(marschnerLobbVolume(type, table), perspective, pixels); };
    };
    const auto blobOf = [](int size, double origin) {
        return [=] {
            return synthetic(makeVolume(glm::ivec3(size), glm::dvec3(origin), VoxelType::FLOAT32,
                                        blob, smoothTable(0.3)));
        };
    };
    const TablePoints smooth = smoothTable(0.06), grey = greyTable(0.06);
    return {
        {"smooth", "smooth table, float voxels fill the box", field(f, smooth)},
        {"smooth-8bit", "the same, 8-bit voxels", field(VoxelType::UINT8, smooth)},
        {"smooth-16bit", "the same, 16-bit voxels", field(VoxelType::UINT16, smooth)},
        {"smooth-ortho", "the same, orthographic", field(f, smooth, false)},
        {"smooth-1024", "the same, 1024 x 1024", field(f, smooth, true, 1024)},
        {"smooth-256", "256^3 voxels, 1024 x 1024", large},
        {"blob", "blob with empty borders", blobOf(SIZE, 0.0)},
        {"blob-tight", "the same blob in a tight box of 50^3 samples", blobOf(50, 39.0)},
        {"peak", "sharp peak in the table", field(f, peakTable())},
        {"grey", "one colour, extinction proportional to value", field(f, grey)},
        {"grey-ortho", "the same, orthographic", field(f, grey, false)},
        {"opaque", "near-opaque", field(f, smoothTable(0.9))},
        {"two-volumes", "two volumes that overlap", overlapping},
        {"spheres", "three translucent spheres inside", withSpheres},
        {"head", "MR head", [] { return head(false); }},
        {"head-shaded", "MR head, shaded", [] { return head(true); }},
    };
}

} // namespace

std::vector<double> ChartVolume::values() const
{
    const std::size_t count = std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    return oracle::toDoubles(voxels.data(), count, type);
}

std::vector<ChartScene> chartScenes(const std::vector<std::string>& filters)
{
    std::vector<ChartScene> scenes;
    for (const SceneEntry& entry : entries()) {
        const bool wanted = filters.empty() ||
                            std::find(filters.begin(), filters.end(), entry.name) != filters.end();
        if (!wanted) continue;
        ChartScene scene = entry.make();
        scene.name = entry.name;
        scene.description = entry.description;
        if (!scene.volumes.empty()) scenes.push_back(std::move(scene));
    }
    return scenes;
}

} // namespace bench
} // namespace osgVolumizer
