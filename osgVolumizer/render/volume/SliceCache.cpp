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
        const Kept* kept = _kept.find(viewId);
        if (kept && kept->faces == faces)
            for (const Part& part : kept->parts)
                if (part.first == first && part.last == last) return part.triangles;
    }
    TrianglesPtr made = make();
    const std::lock_guard<std::mutex> lock(_mutex);
    Kept* known = _kept.find(viewId);
    Kept& kept = known ? *known : _kept.add(viewId, {});
    if (kept.faces != faces || kept.parts.size() >= PARTS) kept.parts.clear();
    kept.faces = faces;
    kept.parts.push_back({first, last, made});
    return made;
}

} // namespace render
} // namespace osgVolumizer
