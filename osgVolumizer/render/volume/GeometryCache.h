#pragma once

#include "../../core/RecencyCache.h"
#include "../context/RenderDataAccess.h"
#include "../textures/TetraTextures.h"
#include "PreparedGeometry.h"

#include <osg/Geometry>

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
    /// What rays walk through: the graph, and what fills it. Of scalars that change only these are
    /// made anew. Null, reported, where there is too much of it.
    std::shared_ptr<const TetraTextures>
    tetrahedra(const VolumeGeometry& geometry,
               const std::shared_ptr<const PreparedGeometry>& prepared);
    /// The edges of the tetrahedra, and of the bricks where these are in the same frame, as lines
    /// in the frame of the prepared geometry. Expects that there are tetrahedra.
    osg::ref_ptr<osg::Geometry> outlines(const VolumeGeometry& geometry, const Voxels* voxels);

    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state) const override;

private:
    struct Key
    {
        unsigned geometryCount;
        const Voxels* voxels;
        unsigned layoutCount;
        bool scalars;
        bool operator==(const Key& o) const
        {
            return geometryCount == o.geometryCount && voxels == o.voxels &&
                   layoutCount == o.layoutCount && scalars == o.scalars;
        }
    };
    static constexpr std::size_t CAPACITY = 4;

    static Key keyOf(const VolumeGeometry& geometry, const Voxels* voxels);

    std::shared_ptr<SliceCache> _slices;
    mutable std::mutex _mutex; ///< of what follows
    core::RecencyCache<Key, std::shared_ptr<const PreparedGeometry>> _prepared{CAPACITY};
    core::RecencyCache<Key, osg::ref_ptr<osg::Geometry>> _outlines{CAPACITY};
    core::RecencyCache<std::shared_ptr<const PreparedGeometry>,
                       std::shared_ptr<const TetraTextures>>
        _graphs{CAPACITY};
};

} // namespace render
} // namespace osgVolumizer
