#include "Scenes.h"

#include <osgVolumizer/Voxels.h>

#include <cmath>
#include <functional>

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
    return {{0.0, {blue, 0.0}},           {0.5, {blue, 0.0}}, {0.515625, {gold, 0.8}},
            {0.53125, {blue, 0.0}}, {1.0, {blue, 0.0}}};
}

void setView(ChartScene& scene, bool perspective, int pixels)
{
    // The same view of the 128^3 box for whatever part of it has voxels.
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
    setView(scene, false, 512);
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
    setView(scene, false, 512);
    return scene;
}

using Maker = std::function<ChartScene()>;

std::vector<std::pair<std::string, Maker>> makers()
{
    const VoxelType f = VoxelType::FLOAT32;
    const auto smooth = [](const std::string& name, VoxelType type, bool perspective, int pixels) {
        return Maker([=] {
            ChartScene s =
                synthetic(name, "Marschner-Lobb 128^3 fills the box, smooth table", type,
                          marschnerLobb, smoothTable(0.06));
            setView(s, perspective, pixels);
            return s;
        });
    };
    return {
        {"smooth", smooth("smooth", f, false, 512)},
        {"smooth-perspective", smooth("smooth-perspective", f, true, 512)},
        {"smooth-1024", smooth("smooth-1024", f, false, 1024)},
        {"smooth-8bit", smooth("smooth-8bit", VoxelType::UINT8, false, 512)},
        {"smooth-16bit", smooth("smooth-16bit", VoxelType::UINT16, false, 512)},
        {"blob",
         [f] {
             return synthetic("blob", "interior blob with empty borders", f, blob, smoothTable(0.3));
         }},
        {"blob-tight", tightBlob},
        {"peak",
         [f] {
             return synthetic("peak", "Marschner-Lobb 128^3, sharp peak in the table", f,
                              marschnerLobb, peakTable());
         }},
        {"opaque",
         [f] {
             return synthetic("opaque", "Marschner-Lobb 128^3, near-opaque", f, marschnerLobb,
                              smoothTable(0.9));
         }},
    };
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
        bool wanted = filters.empty();
        for (const std::string& filter : filters) wanted = wanted || maker.first == filter;
        if (wanted) scenes.push_back(maker.second());
    }
    return scenes;
}

} // namespace bench
} // namespace osgVolumizer
