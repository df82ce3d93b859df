#include "ResidentTexture.h"

#include <algorithm>
#include <tuple>

namespace osgVolumizer {
namespace render {

void keepWithin(std::int64_t room, const std::vector<osg::ref_ptr<ResidentTexture>>& textures,
                osg::State& state)
{
    std::int64_t held = 0;
    std::vector<std::tuple<unsigned, float, ResidentTexture*>> byUse;
    for (const auto& texture : textures) {
        if (!texture->isIn(state.getContextID())) continue;
        held += texture->bytes();
        byUse.emplace_back(texture->lastFrame(), texture->priority(), texture.get());
    }
    if (held <= room) return;
    std::sort(byUse.begin(), byUse.end());
    for (auto next = byUse.begin(); held > room && next != byUse.end(); ++next) {
        ResidentTexture& texture = *std::get<2>(*next);
        held -= texture.bytes();
        texture.releaseGLObjects(&state);
    }
}

} // namespace render
} // namespace osgVolumizer
