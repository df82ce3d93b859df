#include "ApplyPaint.h"

#include "../context/Matrices.h"
#include "../context/ReportOnce.h"
#include "MergeGroups.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <string>

namespace osgVolumizer {
namespace render {

namespace {

bool paints(const VolumeInstance* volume)
{
    return volume->appearance->getCombineRule() == VolumeAppearance::PAINT;
}

void refuse(const VolumeInstance& volume, const std::string& why)
{
    reportOnce({ErrorCode::NOT_SUPPORTED,
                "VolumeAppearance \"" + volume.appearance->getName() + "\": " + why});
}

// The half-spaces that a volume lies in besides its box.
std::vector<glm::vec4> planesOf(const VolumeInstance& volume)
{
    std::vector<glm::vec4> planes;
    for (const auto* some : {&volume.prepared->obliquePlanes, &volume.clipPlanes})
        for (const core::Plane& plane : *some)
            planes.emplace_back(glm::dvec4(plane.normal, plane.offset));
    return planes;
}

// The paints of a volume, still for itself as the painted one.
std::vector<Paint> paintsOf(const VolumeInstance& volume)
{
    const PreparedGeometry& prepared = *volume.prepared;
    std::vector<glm::vec4> planes = planesOf(volume);
    if (!volume.look->features.voxels || !prepared.voxelFrame || !prepared.region ||
        planes.size() > std::size_t(Paint::MAXIMUM_PLANES) || volume.look->features.cut) {
        refuse(volume, "painting needs voxels in a convex region of no more than " +
                           std::to_string(Paint::MAXIMUM_PLANES) +
                           " oblique faces and planes that cut, in one voxel frame; the volume is "
                           "not shown");
        return {};
    }
    planes.resize(Paint::MAXIMUM_PLANES, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    std::vector<Paint> result;
    for (const SelectedBrick& brick : volume.bricks) {
        Paint paint;
        paint.voxels = brick.texels;
        paint.table = volume.look->table;
        paint.textureScale = brick.textureScale;
        paint.textureOffset = brick.textureOffset;
        paint.boxMin = glm::vec3(brick.box.min);
        paint.boxMax = glm::vec3(brick.box.max);
        paint.planes = planes;
        paint.valueToEntry = volume.look->valueToEntry;
        paint.rgba = volume.look->features.rgba;
        paint.nearest = volume.look->features.nearest;
        result.push_back(paint);
    }
    return result;
}

} // namespace

void applyPaint(std::vector<VolumeInstance*>& volumes)
{
    const auto firstPaint =
        std::stable_partition(volumes.begin(), volumes.end(),
                              [](const VolumeInstance* volume) { return !paints(volume); });
    if (firstPaint == volumes.end()) return;
    for (auto painted = volumes.begin(); painted != firstPaint; ++painted) {
        VolumeInstance& volume = **painted;
        if (volume.look->features.gathers()) continue;
        const BoxInView view = viewOf(volume);
        auto all = std::make_shared<std::vector<Paint>>();
        for (auto p = firstPaint; p != volumes.end(); ++p) {
            if (!overlaps(viewOf(**p), view)) continue;
            const glm::dmat4 fromFrame =
                glm::inverse(toGlm(*(*p)->frameToEye)) * toGlm(*volume.frameToEye);
            for (Paint& paint : paintsOf(**p)) {
                paint.fromFrame = fromFrame;
                all->push_back(std::move(paint));
            }
        }
        if (all->size() > std::size_t(Paint::MAXIMUM_COUNT)) {
            refuse(volume, "it overlaps " + std::to_string(all->size()) +
                               " bricks of volumes that paint it; it shows only " +
                               std::to_string(Paint::MAXIMUM_COUNT));
            all->resize(Paint::MAXIMUM_COUNT);
        }
        if (!all->empty()) volume.paints = std::move(all);
    }
    volumes.erase(firstPaint, volumes.end());
}

} // namespace render
} // namespace osgVolumizer
