#include "GeometryCache.h"

#include "../../VolumeGeometry.h"
#include "../../Voxels.h"
#include "SliceCache.h"

namespace osgVolumizer {
namespace render {

GeometryCache::GeometryCache() : _slices(std::make_shared<SliceCache>()) {}

std::shared_ptr<const PreparedGeometry> GeometryCache::get(const VolumeGeometry& geometry,
                                                           const Voxels* voxels)
{
    const Key key{geometry.getModifiedCount(), voxels, voxels ? voxels->getLayoutCount() : 0};
    std::lock_guard<std::mutex> lock(_mutex);
    if (const auto* known = _prepared.find(key)) return *known;
    const auto set = geometry.getTetraSet();
    return _prepared.add(key, set->empty() ? nullptr : prepareGeometry(*set, voxels));
}

} // namespace render
} // namespace osgVolumizer
