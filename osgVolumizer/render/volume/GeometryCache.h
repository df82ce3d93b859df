#pragma once

#include "../../core/RecencyCache.h"
#include "../context/RenderDataAccess.h"
#include "PreparedGeometry.h"

#include <memory>
#include <mutex>

namespace osgVolumizer {
class VolumeGeometry;

namespace render {

class SliceCache;

/// What is kept with a VolumeGeometry: prepared geometries, by what they were made from, and the
/// slices of all views. Thread safe.
class GeometryCache : public RenderData
{
public:
    GeometryCache();
    /// The slices of all views.
    SliceCache& slices() const { return *_slices; }
    std::shared_ptr<const PreparedGeometry> get(const VolumeGeometry& geometry,
                                                const Voxels* voxels);

    // All of it is in the memory of the process.
    void resizeGLObjectBuffers(unsigned int) override {}
    void releaseGLObjects(osg::State*) const override {}

private:
    struct Key
    {
        unsigned geometryCount;
        const Voxels* voxels;
        unsigned layoutCount;
        bool operator==(const Key& o) const
        {
            return geometryCount == o.geometryCount && voxels == o.voxels &&
                   layoutCount == o.layoutCount;
        }
    };
    static constexpr std::size_t CAPACITY = 4;

    std::shared_ptr<SliceCache> _slices;
    std::mutex _mutex;
    core::RecencyCache<Key, std::shared_ptr<const PreparedGeometry>> _prepared{CAPACITY};
};

} // namespace render
} // namespace osgVolumizer
