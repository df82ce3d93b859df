#pragma once

#include "../core/ordering/DepthSchedule.h"
#include "ForeignLeaf.h"

#include <osg/Drawable>
#include <osg/Geometry>

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

/// The triangles of a foreign leaf that is a plain osg::Geometry, with their depths in one view, so
/// that each interval draws only those that reach into it, far to near.
class SurfaceMesh
{
public:
    /// Nothing where the triangles cannot be known or drawn by index: other drawables, vertex
    /// shaders that may move them, lines and points, instances, arrays bound per primitive set,
    /// draw callbacks.
    static std::unique_ptr<SurfaceMesh> of(const ForeignLeaf& leaf);

    /// Of the vertices themselves: tighter than that of the bounding box.
    const BoxInView& view() const { return _view; }

    std::size_t triangleCount() const { return _triangles.size(); }

    /// Indices of the triangles that reach into each interval, far to near, three each.
    using Indices = std::shared_ptr<const std::vector<unsigned>>;
    std::vector<Indices> split(const std::vector<core::DepthInterval>& farToNear) const;
    /// Draws some of the triangles, as the geometry would.
    osg::ref_ptr<osg::Drawable> drawable(Indices indices) const;

private:
    struct Triangle
    {
        unsigned vertex[3];
        float nearDepth, farDepth, middle;
    };

    osg::ref_ptr<const osg::Geometry> _geometry;
    std::vector<Triangle> _triangles; ///< by middle, far to near
    BoxInView _view;
};

} // namespace render
} // namespace osgVolumizer
