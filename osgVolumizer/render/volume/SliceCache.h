#pragma once

#include "../draw/VolumeMesh.h"

#include "../../core/RecencyCache.h"
#include "../../core/sampling/FaceCache.h"

#include <osgUtil/CullVisitor>

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <vector>

namespace osgVolumizer {
namespace render {

/// What says from where a volume is seen: the visitor's identifier and the place in the graph. Two
/// that get the same number by chance cost time, not correctness.
std::uint64_t viewIdOf(osgUtil::CullVisitor& visitor);

/// Slices as triangles, brick after brick, without what may change from frame to frame.
struct SliceTriangles
{
    VolumeMesh mesh;         ///< its batches lack their bricks
    std::vector<int> bricks; ///< per batch
};

/// The slices of one VolumeGeometry and the triangles made from them, as long as its views stay the
/// same. Thread safe.
class SliceCache
{
public:
    using FacesPtr = core::FaceCache::FacesPtr;
    using TrianglesPtr = std::shared_ptr<const SliceTriangles>;

    core::FaceCache& faces() { return _faces; }
    /// The triangles of surfaces [first, last) of a view's present faces; made by `make` when there
    /// are none yet.
    TrianglesPtr triangles(std::uint64_t viewId, const FacesPtr& faces, int first, int last,
                           const std::function<TrianglesPtr()>& make);

private:
    struct Part
    {
        int first, last;
        TrianglesPtr triangles;
    };
    struct Kept
    {
        FacesPtr faces; ///< that the parts were made from
        std::vector<Part> parts;
    };
    static constexpr std::size_t VIEWS = 16, PARTS = 256; ///< no more are kept

    core::FaceCache _faces{VIEWS};
    std::mutex _mutex;
    core::RecencyCache<std::uint64_t, Kept> _kept{VIEWS}; ///< by view
};

} // namespace render
} // namespace osgVolumizer
