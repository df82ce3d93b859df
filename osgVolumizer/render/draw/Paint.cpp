#include "Paint.h"

#include "../context/ShaderSource.h"
#include "../context/Uniforms.h"

namespace osgVolumizer {
namespace render {

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
