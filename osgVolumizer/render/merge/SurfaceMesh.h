#pragma once

#include "../../core/ordering/DepthSchedule.h"
#include "ForeignLeaf.h"

#include <osg/Drawable>
#include <osg/Geometry>

#include <glm/vec2.hpp>

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

/// What a volume can cover of a view: the hull of its box, and depths.
struct VolumeOutline
{
    glm::dvec2 corners[8];  ///< device coordinates
    glm::dvec2 margin{0.0}; ///< around the hull
    core::DepthInterval depth;
    bool everywhere = false; ///< reaches behind the eye: corners are meaningless
};

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

    std::size_t triangleCount() const { return _indices.size() / 3; }

    /// How many of its triangles lie over each other on the screen, at most: an estimate from areas
    /// in a coarse grid; good for closed surfaces of many triangles.
    double coverEstimate() const;

    /// Whether any triangle reaches into an outline. What does not cannot show in the volume, nor
    /// the volume in it.
    bool touches(const VolumeOutline& outline) const;

    /// Indices of the triangles that reach into each interval, far to near, three each.
    using Indices = std::shared_ptr<const std::vector<unsigned>>;
    std::vector<Indices> split(const std::vector<core::DepthInterval>& farToNear) const;
    /// Draws some of the triangles, as the geometry would.
    osg::ref_ptr<osg::Drawable> drawable(Indices indices) const;

private:
    void project(const osg::Vec3Array& vertices, const osgUtil::RenderLeaf& leaf);
    bool touches(const VolumeOutline& outline, const unsigned* triangle) const;

    osg::ref_ptr<const osg::Geometry> _geometry;
    std::vector<unsigned> _indices;  ///< three a triangle
    std::vector<float> _depths;      ///< per vertex
    std::vector<glm::vec2> _devices; ///< per vertex: device coordinates
    BoxInView _view;
    bool _behindEye = false; ///< then device coordinates are meaningless
    float _slack = 0.0f;     ///< of depths
};

} // namespace render
} // namespace osgVolumizer
