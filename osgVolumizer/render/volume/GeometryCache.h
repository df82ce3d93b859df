#pragma once

#include "../context/RenderDataAccess.h"
#include "PreparedGeometry.h"

#include <list>
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
    struct Entry
    {
        unsigned geometryCount;
        const Voxels* voxels;
        unsigned layoutCount;
        std::shared_ptr<const PreparedGeometry> prepared;
    };
    static constexpr std::size_t CAPACITY = 4;

    std::shared_ptr<SliceCache> _slices;
    std::mutex _mutex;
    std::list<Entry> _entries; ///< most recent first
};

} // namespace render
} // namespace osgVolumizer
