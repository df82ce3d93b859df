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
    const unsigned geometryCount = geometry.getModifiedCount();
    const unsigned layoutCount = voxels ? voxels->getLayoutCount() : 0;
    std::lock_guard<std::mutex> lock(_mutex);
    for (auto i = _entries.begin(); i != _entries.end(); ++i) {
        if (i->geometryCount != geometryCount || i->voxels != voxels ||
            i->layoutCount != layoutCount)
            continue;
        _entries.splice(_entries.begin(), _entries, i);
        return _entries.front().prepared;
    }
    const auto set = geometry.getTetraSet();
    std::shared_ptr<const PreparedGeometry> prepared;
    if (!set->empty()) prepared = prepareGeometry(*set, voxels);
    _entries.push_front({geometryCount, voxels, layoutCount, prepared});
    if (_entries.size() > CAPACITY) _entries.pop_back();
    return prepared;
}

} // namespace render
} // namespace osgVolumizer
