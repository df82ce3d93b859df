#include "Scenes.h"

#include <osgVolumizer/LookupTable.h>
#include <osgVolumizer/ReadVoxels.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>

namespace osgVolumizer {
namespace bench {

namespace {

using Points = std::vector<core::TransferFunction::Point>;
using ScalarFunction = std::function<double(const glm::dvec3&)>;

constexpr int SIZE = 128;

// Function of the voxel coordinate with values in [0, 1], stored over the whole range of the type.
void fill(ChartScene& scene, const ScalarFunction& f)
{
    const double top = scene.type == VoxelType::UINT8    ? 255.0
                       : scene.type == VoxelType::UINT16 ? 65535.0
                                                         : 1.0;
    std::vector<double> values;
    for (int z = 0; z < scene.size.z; ++z)
        for (int y = 0; y < scene.size.y; ++y)
            for (int x = 0; x < scene.size.x; ++x)
                values.push_back(top * f(scene.origin + glm::dvec3(x, y, z)));
    scene.voxels = oracle::fromDoubles(values, scene.type);
    scene.range = {0.0, top};
}

double marschnerLobb(const glm::dvec3& voxel)
{
    static const oracle::MarschnerLobbField field;
    return field.value(voxel * (2.0 / (SIZE - 1)) - 1.0);
}

// One in the middle, exactly zero from 24 voxels on, and smooth between.
double blob(const glm::dvec3& voxel)
{
    const glm::dvec3 d = (voxel - 0.5 * (SIZE - 1)) / 24.0;
    const double s = 1.0 - glm::dot(d, d);
    return s > 0.0 ? s * s : 0.0;
}

// Colours and opacity without kinks that matter: 65 points of smooth functions.
Points smoothTable(double opacity)
{
    Points points;
    for (int i = 0; i <= 64; ++i) {
        const double v = i / 64.0, s = v * v * (3.0 - 2.0 * v);
        points.push_back({v, {s, 0.5 + 0.4 * std::sin(3.0 * v), 1.0 - 0.8 * s, opacity * s}});
    }
    return points;
}

// A transparent background with one opaque peak, 1/32 of the range wide.
Points peakTable()
{
    const glm::dvec3 blue(0.2, 0.4, 0.9), gold(1.0, 0.8, 0.2);
    return {{0.0, {blue, 0.0}},
            {0.5, {blue, 0.0}},
            {0.515625, {gold, 0.8}},
            {0.53125, {blue, 0.0}},
            {1.0, {blue, 0.0}}};
}

// The same view of the 128^3 box for whatever part of it has voxels.
void setView(ChartScene& scene, bool perspective, int pixels)
{
    const osg::Vec3d center(63.5, 63.5, 63.5), direction(0.42, 0.76, -0.5);
    scene.view.size(pixels, pixels);
    if (perspective)
        scene.view.perspective(40.0);
    else
        scene.view.orthographic(112.0);
    scene.view.lookAt(center - direction * 330.0, center, {0.0, 0.0, 1.0});
}

ChartScene synthetic(const std::string& name, const std::string& description, VoxelType type,
                     const ScalarFunction& f, const Points& table)
{
    ChartScene scene;
    scene.name = name;
    scene.description = description;
    scene.size = glm::ivec3(SIZE);
    scene.type = type;
    scene.table = table;
    fill(scene, f);
    setView(scene, true, 512);
    return scene;
}

ChartScene tightBlob()
{
    ChartScene scene;
    scene.name = "blob-tight";
    scene.description = "the same blob in a tight box of 50^3 samples";
    scene.size = glm::ivec3(50);
    scene.origin = glm::dvec3(39.0);
    scene.type = VoxelType::FLOAT32;
    scene.table = smoothTable(0.3);
    fill(scene, blob);
    setView(scene, true, 512);
    return scene;
}

// The MR scan that the library ships, as its own scene file shows it.
ChartScene head(const std::string& name, bool shaded)
{
    ChartScene scene;
    scene.name = name;
    scene.description = shaded ? "MR head, shaded" : "MR head";
    scene.shaded = shaded;
    const std::string folder = OSGVOLUMIZER_SOURCE_DIR "/data/";
    const auto voxels = readVoxels(folder + "head.tif");
    const auto table = readLookupTable(folder + "head.lut");
    if (!voxels.ok() || !table.ok()) {
        std::cerr << name << ": " << (voxels.ok() ? table.status.text : voxels.status.text) << "\n";
        return scene;
    }
    scene.size = (*voxels)->getLayout().size();
    scene.type = (*voxels)->getType();
    const VoxelBlock block = (*voxels)->getBrick(0);
    scene.voxels.assign(block.data, block.data + block.bytes);
    scene.range = {0.0, 255.0};
    scene.table = (*table)->getNormalizedFunction(osg::Vec2d(0.0, 255.0))->points();
    const osg::Vec3d center(63.5, 63.5, 41.5), direction(0.64, 0.12, 0.76);
    scene.view.size(512, 512).perspective(30.0);
    scene.view.lookAt(center - direction * 330.0, center, {0.0, -1.0, 0.0});
    return scene;
}

using Maker = std::function<ChartScene()>;

std::vector<std::pair<std::string, Maker>> makers()
{
    const auto field = [](const char* text, VoxelType type, const ScalarFunction& f,
                          const Points& table, bool perspective = true, int pixels = 512) {
        return [=](const std::string& name) {
            ChartScene scene = synthetic(name, text, type, f, table);
            setView(scene, perspective, pixels);
            return scene;
        };
    };
    const VoxelType f = VoxelType::FLOAT32;
    const Points smooth = smoothTable(0.06);
    const std::vector<std::pair<std::string, std::function<ChartScene(const std::string&)>>> list =
        {
            {"smooth", field("smooth table, float voxels fill the box", f, marschnerLobb, smooth)},
            {"smooth-8bit",
             field("the same, 8-bit voxels", VoxelType::UINT8, marschnerLobb, smooth)},
            {"smooth-16bit",
             field("the same, 16-bit voxels", VoxelType::UINT16, marschnerLobb, smooth)},
            {"smooth-ortho", field("the same, orthographic", f, marschnerLobb, smooth, false)},
            {"smooth-1024", field("the same, 1024 x 1024", f, marschnerLobb, smooth, true, 1024)},
            {"blob", field("blob with empty borders", f, blob, smoothTable(0.3))},
            {"blob-tight", [](const std::string&) { return tightBlob(); }},
            {"peak", field("sharp peak in the table", f, marschnerLobb, peakTable())},
            {"opaque", field("near-opaque", f, marschnerLobb, smoothTable(0.9))},
            {"head", [](const std::string& name) { return head(name, false); }},
            {"head-shaded", [](const std::string& name) { return head(name, true); }},
        };
    std::vector<std::pair<std::string, Maker>> result;
    for (const auto& entry : list)
        result.emplace_back(entry.first, [entry] { return entry.second(entry.first); });
    return result;
}

} // namespace

std::vector<double> ChartScene::values() const
{
    const std::size_t count = std::size_t(size.x) * size.y * size.z;
    return oracle::toDoubles(voxels.data(), count, type);
}

std::vector<ChartScene> chartScenes(const std::vector<std::string>& filters)
{
    std::vector<ChartScene> scenes;
    for (const auto& maker : makers()) {
        const bool wanted = filters.empty() ||
                            std::find(filters.begin(), filters.end(), maker.first) != filters.end();
        if (!wanted) continue;
        ChartScene scene = maker.second();
        if (!scene.voxels.empty()) scenes.push_back(std::move(scene));
    }
    return scenes;
}

} // namespace bench
} // namespace osgVolumizer
