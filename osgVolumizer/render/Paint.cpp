#include "Paint.h"

#include "Matrices.h"
#include "MergeGroups.h"
#include "ReportOnce.h"
#include "ShaderSource.h"
#include "Uniforms.h"
#include "VolumeInstance.h"

#include <glm/matrix.hpp>

#include <algorithm>

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

// The paints of a volume, still for itself as the painted one.
std::vector<Paint> paintsOf(const VolumeInstance& volume)
{
    const PreparedGeometry& prepared = *volume.prepared;
    if (!volume.look->features.voxels || !prepared.voxelFrame || !prepared.region ||
        prepared.obliquePlanes.size() > std::size_t(Paint::MAXIMUM_PLANES)) {
        refuse(volume, "painting needs voxels in a convex region of no more than " +
                           std::to_string(Paint::MAXIMUM_PLANES) +
                           " oblique faces, in one voxel frame; the volume is not shown");
        return {};
    }
    std::vector<Paint> result;
    for (const SelectedBrick& brick : volume.bricks) {
        Paint paint;
        paint.voxels = brick.texels;
        paint.table = volume.look->table;
        paint.textureScale = brick.textureScale;
        paint.textureOffset = brick.textureOffset;
        paint.boxMin = glm::vec3(brick.box.min);
        paint.boxMax = glm::vec3(brick.box.max);
        for (const core::Plane& plane : prepared.obliquePlanes)
            paint.planes.emplace_back(glm::dvec4(plane.normal, plane.offset));
        paint.planes.resize(Paint::MAXIMUM_PLANES, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
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
        auto look = std::make_shared<VolumeLook>(*volume.look);
        for (auto p = firstPaint; p != volumes.end(); ++p) {
            if (!overlaps(viewOf(**p), view)) continue;
            const glm::dmat4 fromFrame =
                glm::inverse(toGlm(*(*p)->frameToEye)) * toGlm(*volume.frameToEye);
            for (Paint& paint : paintsOf(**p)) {
                paint.fromFrame = fromFrame;
                look->paints.push_back(std::move(paint));
            }
        }
        if (look->paints.size() > std::size_t(Paint::MAXIMUM_COUNT)) {
            refuse(volume, "it overlaps " + std::to_string(look->paints.size()) +
                               " bricks of volumes that paint it; it shows only " +
                               std::to_string(Paint::MAXIMUM_COUNT));
            look->paints.resize(Paint::MAXIMUM_COUNT);
        }
        look->features.paintCount = static_cast<int>(look->paints.size());
        volume.look = std::move(look);
    }
    volumes.erase(firstPaint, volumes.end());
}

std::string paintSource(int count)
{
    std::string source, cuts, product;
    for (int i = 0; i < count; ++i) {
        const std::string number = std::to_string(i);
        for (char c : shaderSource("paint.glsl"))
            source += c == '@' ? number : std::string(1, c);
        cuts += "    cut(paint" + number + "Segment(origin, direction), t, next);\n";
        product += " * paint" + number + "At(point)";
    }
    return source +
           "\nvoid cut(vec2 ends, float t, inout float next)\n{\n"
           "    if (ends.x >= ends.y) return;\n"
           "    if (ends.x > t) next = min(next, ends.x);\n"
           "    else if (ends.y > t) next = min(next, ends.y);\n}\n"
           "\n// The next place on a ray, after t and up to `end`, where paint begins or ends.\n"
           "float nextCut(vec3 origin, vec3 direction, float t, float end)\n{\n"
           "    float next = end;\n" +
           cuts +
           "    return next;\n}\n\nvec3 painted(vec3 color, vec3 point)\n{\n    return color" +
           product + ";\n}\n";
}

void setPaints(osg::RenderInfo& renderInfo, const ContextLimits& limits, const Uniforms& uniforms,
               const std::vector<Paint>& all, unsigned firstUnit)
{
    osg::State& state = *renderInfo.getState();
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Paint& paint = all[i];
        const std::string prefix = "paint" + std::to_string(i);
        const auto name = [&prefix](const char* suffix) { return prefix + suffix; };
        const unsigned unit = firstUnit + 2 * static_cast<unsigned>(i);
        const CoarseTexture voxels = paint.voxels.apply(renderInfo, limits, unit);
        const bool complete =
            voxels.texture &&
            (!paint.table.texture || applyTable(state, paint.table.texture.get(), unit + 1));
        uniforms.set(name("Voxels").c_str(), static_cast<int>(unit));
        uniforms.set(name("Table").c_str(), static_cast<int>(unit + 1));
        uniforms.set(name("FromFrame").c_str(), paint.fromFrame);
        uniforms.set(name("TextureScale").c_str(), paint.textureScale * voxels.scale);
        uniforms.set(name("TextureOffset").c_str(),
                     paint.textureOffset * voxels.scale + voxels.offset);
        // What the card has no memory for paints nothing.
        uniforms.set(name("Min").c_str(), paint.boxMin);
        uniforms.set(name("Max").c_str(), complete ? paint.boxMax : paint.boxMin);
        uniforms.set(name("Planes").c_str(), paint.planes);
        uniforms.set(name("ValueToEntry").c_str(), paint.valueToEntry);
        uniforms.set(name("LastEntry").c_str(), static_cast<float>(paint.table.count - 1));
        uniforms.set(name("Rgba").c_str(), paint.rgba ? 1 : 0);
        uniforms.set(name("Nearest").c_str(), paint.nearest ? 1 : 0);
        for (unsigned used : {unit, unit + 1})
            state.haveAppliedTextureAttribute(used, osg::StateAttribute::TEXTURE);
    }
}

} // namespace render
} // namespace osgVolumizer
