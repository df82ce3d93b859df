#include "MergeGroups.h"

#include "../context/LeafState.h"
#include "../context/Matrices.h"

#include <numeric>
#include <unordered_set>

namespace osgVolumizer {
namespace render {

namespace {

// Disjoint sets, joined by the overlaps that are found.
class DisjointSets
{
public:
    explicit DisjointSets(std::size_t count) : _parent(count)
    {
        std::iota(_parent.begin(), _parent.end(), std::size_t(0));
    }
    std::size_t root(std::size_t i)
    {
        while (_parent[i] != i)
            i = _parent[i] = _parent[_parent[i]];
        return i;
    }
    void join(std::size_t a, std::size_t b) { _parent[root(a)] = root(b); }

private:
    std::vector<std::size_t> _parent;
};

// Volumes that overlap each other.
void joinOverlapping(const std::vector<BoxInView>& views, DisjointSets& sets)
{
    for (std::size_t a = 0; a < views.size(); ++a)
        for (std::size_t b = a + 1; b < views.size(); ++b)
            if (overlaps(views[a], views[b])) sets.join(a, b);
}

// Joins the volumes that a surface overlaps, and returns one of them; their number for none.
std::size_t joinThrough(const BoxInView& surface, const std::vector<BoxInView>& views,
                        DisjointSets& sets)
{
    std::size_t first = views.size();
    for (std::size_t v = 0; v < views.size(); ++v) {
        if (!overlaps(views[v], surface)) continue;
        if (first == views.size())
            first = v;
        else
            sets.join(first, v);
    }
    return first;
}

} // namespace

bool overlaps(const BoxInView& a, const BoxInView& b)
{
    return a.depth.overlaps(b.depth) && a.screen.overlaps(b.screen);
}

BoxInView viewOf(const VolumeInstance& volume)
{
    const core::Box3d& box = volume.prepared->regionBox;
    BoxInView view = boxInView({box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z},
                               *volume.leaf->_modelview, usualProjection(*volume.leaf));
    view.depth = volume.depth;
    return view;
}

MergeGroups findMergeGroups(const std::vector<VolumeInstance*>& volumes,
                            const std::vector<osgUtil::RenderLeaf*>& leaves)
{
    MergeGroups result;
    if (volumes.empty()) return result;
    std::vector<BoxInView> views;
    std::unordered_set<const osgUtil::RenderLeaf*> own;
    for (const VolumeInstance* volume : volumes) {
        views.push_back(viewOf(*volume));
        own.insert(volume->leaf);
    }
    DisjointSets sets(volumes.size());
    joinOverlapping(views, sets);
    std::vector<std::size_t> anyVolumeOf; // per surface
    const osg::Matrixd projection = usualProjection(*volumes.front()->leaf);
    for (osgUtil::RenderLeaf* leaf : leaves) {
        if (own.count(leaf)) continue;
        const auto surface = ForeignLeaf::examine(*leaf, projection);
        if (!surface) continue;
        const std::size_t volume = joinThrough(surface->view(), views, sets);
        if (volume == views.size()) continue;
        result.surfaces.push_back(*surface);
        anyVolumeOf.push_back(volume);
    }
    std::vector<std::size_t> groupOfRoot(volumes.size(), volumes.size());
    const auto groupOf = [&](std::size_t volume) -> MergeGroup& {
        std::size_t& group = groupOfRoot[sets.root(volume)];
        if (group == volumes.size()) {
            group = result.groups.size();
            result.groups.emplace_back();
        }
        return result.groups[group];
    };
    for (std::size_t v = 0; v < volumes.size(); ++v)
        groupOf(v).volumes.push_back(volumes[v]);
    std::size_t s = 0;
    for (const ForeignLeaf& surface : result.surfaces)
        groupOf(anyVolumeOf[s++]).surfaces.push_back(&surface);
    return result;
}

} // namespace render
} // namespace osgVolumizer
