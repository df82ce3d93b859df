#include "Layers.h"

namespace osgVolumizer {
namespace test {

int layerOf(const std::string& file, const Layers& layers)
{
    int layer = -1;
    std::size_t longest = 0;
    for (std::size_t i = 0; i < layers.size(); ++i)
        for (const std::string& folder : layers[i]) {
            if (folder.size() < longest || file.compare(0, folder.size() + 1, folder + "/") != 0)
                continue;
            longest = folder.size();
            layer = static_cast<int>(i);
        }
    return layer;
}

std::vector<Include> upwardIncludes(const std::vector<Include>& includes, const Layers& layers)
{
    std::vector<Include> upward;
    for (const Include& include : includes) {
        const int from = layerOf(include.file, layers), to = layerOf(include.target, layers);
        if (from >= 0 && to >= 0 && to < from) upward.push_back(include);
    }
    return upward;
}

} // namespace test
} // namespace osgVolumizer
