#include "SliceCache.h"

namespace osgVolumizer {
namespace render {

std::uint64_t viewIdOf(osgUtil::CullVisitor& visitor)
{
    // FNV-1a over the addresses.
    std::uint64_t hash = 14695981039346656037u;
    const auto add = [&hash](const void* p) {
        hash = (hash ^ reinterpret_cast<std::uintptr_t>(p)) * 1099511628211u;
    };
    add(visitor.getIdentifier());
    for (const osg::Node* node : visitor.getNodePath())
        add(node);
    return hash;
}

SliceCache::TrianglesPtr SliceCache::triangles(std::uint64_t viewId, const FacesPtr& faces,
                                               int first, int last,
                                               const std::function<TrianglesPtr()>& make)
{
    {
        const std::lock_guard<std::mutex> lock(_mutex);
        const auto kept = _kept.find(viewId);
        if (kept != _kept.end() && kept->second.faces == faces)
            for (const Part& part : kept->second.parts)
                if (part.first == first && part.last == last) return part.triangles;
    }
    TrianglesPtr made = make();
    const std::lock_guard<std::mutex> lock(_mutex);
    if (_kept.size() >= VIEWS && _kept.find(viewId) == _kept.end()) _kept.clear();
    Kept& kept = _kept[viewId];
    if (kept.faces != faces || kept.parts.size() >= PARTS) kept.parts.clear();
    kept.faces = faces;
    kept.parts.push_back({first, last, made});
    return made;
}

} // namespace render
} // namespace osgVolumizer
