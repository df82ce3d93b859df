#include "Reference.h"

#include <oracles/Scene.h>
#include <support/OracleView.h>
#include <support/PictureFile.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>

namespace osgVolumizer {
namespace bench {

namespace {

// Rays are added up from pieces that are good to this; float pixels round to 6e-8.
constexpr double TOLERANCE = 1e-9;

oracle::Scene oracleScene(const ChartScene& scene)
{
    oracle::Scene result;
    for (const ChartVolume& volume : scene.volumes) {
        const auto grid = std::make_shared<oracle::Grid>(volume.size, volume.values());
        result.volumes.push_back(oracle::voxelVolume(grid, volume.size,
                                                     oracle::Table(volume.table, volume.range),
                                                     glm::dvec3(1.0), volume.origin));
    }
    for (const ChartSurface& surface : scene.surfaces)
        result.addMesh(surface.mesh.points, surface.mesh.triangles,
                       glm::dvec4(glm::vec4(surface.color)));
    result.tolerance = TOLERANCE;
    return result;
}

// Changes with everything that the picture depends on.
std::string key(const ChartScene& scene)
{
    std::string bytes;
    const auto append = [&bytes](const void* data, std::size_t size) {
        bytes.append(static_cast<const char*>(data), size);
    };
    const auto appendAll = [&append](const auto& items) {
        append(items.data(), items.size() * sizeof(items[0]));
    };
    for (const ChartVolume& volume : scene.volumes) {
        appendAll(volume.voxels);
        appendAll(volume.table);
        append(&volume.size, sizeof(volume.size));
        append(&volume.origin, sizeof(volume.origin));
    }
    for (const ChartSurface& surface : scene.surfaces) {
        appendAll(surface.mesh.points);
        append(&surface.color, sizeof(surface.color));
    }
    append(scene.view.view.ptr(), 16 * sizeof(double));
    append(scene.view.projection.ptr(), 16 * sizeof(double));
    append(&scene.view.width, sizeof(int));
    append(&TOLERANCE, sizeof(TOLERANCE));
    return std::to_string(std::hash<std::string>()(bytes));
}

// On every 37th pixel, against a hundredth of the tolerance.
double findRemainingError(oracle::Scene scene, const oracle::Camera& camera,
                          const support::FloatImage& picture)
{
    scene.tolerance = 0.01 * TOLERANCE;
    double worst = 0.0;
    for (std::size_t i = 0; i < picture.pixels.size(); i += 37 * 11) {
        const int x = int(i % std::size_t(picture.width)), y = int(i / std::size_t(picture.width));
        const glm::dvec4 exact = oracle::trace(scene, camera, x + 0.5, y + 0.5);
        for (int c = 0; c < 4; ++c)
            worst = std::max(worst, std::abs(exact[c] - double(picture.at(x, y)[c])));
    }
    return worst;
}

} // namespace

Reference reference(const ChartScene& scene)
{
    const oracle::Scene traced = oracleScene(scene);
    const oracle::Camera camera = support::oracleCamera(scene.view);
    const std::filesystem::path folder = OSGVOLUMIZER_BINARY_DIR "/chart/reference";
    std::error_code ignored; // without the cache the picture is computed each time
    std::filesystem::create_directories(folder, ignored);
    const std::string file = (folder / (scene.name + "-" + key(scene) + ".exr")).string();

    Reference result;
    const auto cached = support::readFloatPicture(file);
    if (cached.ok()) {
        result.picture = *cached;
    } else {
        std::cerr << "Reference of " << scene.name << " ...\n";
        result.picture = oracle::render(traced, camera);
        const Status status = support::writeFloatPicture(result.picture, file);
        if (!status.ok()) std::cerr << status.text << "\n";
    }
    result.remainingError = findRemainingError(traced, camera, result.picture);
    result.mask = support::coveredPixels(oracle::awayFromSilhouettes(traced, camera), 0.5f) &
                  support::coveredPixels(result.picture);
    return result;
}

} // namespace bench
} // namespace osgVolumizer
