#include "CutRegion.h"

#include "core/Text.h"

#include <osg/Drawable>
#include <osg/TriangleFunctor>

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace osgVolumizer {

namespace {

struct AddTriangle
{
    core::TriangleMesh mesh;

    void operator()(const osg::Vec3& a, const osg::Vec3& b, const osg::Vec3& c, bool = false)
    {
        for (const osg::Vec3* v : {&a, &b, &c}) {
            mesh.indices.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
            mesh.vertices.emplace_back(v->x(), v->y(), v->z());
        }
    }
};

Status refusal(const std::string& text)
{
    return {ErrorCode::VALUE_INVALID, "a region to cut by: " + text};
}

} // namespace

CutRegion CutRegion::halfSpace(const osg::Vec4d& plane)
{
    CutRegion region;
    region._plane = plane;
    return region;
}

CutRegion CutRegion::box(const osg::BoundingBoxd& box)
{
    CutRegion region;
    region._kind = BOX;
    region._box = box;
    return region;
}

CutRegion CutRegion::sphere(const osg::Vec3d& center, double radius)
{
    CutRegion region;
    region._kind = SPHERE;
    region._center = center;
    region._radius = radius;
    return region;
}

CutRegion CutRegion::surface(const osg::Drawable& triangles)
{
    osg::TriangleFunctor<AddTriangle> functor;
    triangles.accept(functor);
    return surface(functor.mesh, true);
}

CutRegion CutRegion::surface(const core::TriangleMesh& mesh)
{
    return surface(mesh, false);
}

CutRegion CutRegion::surface(const core::TriangleMesh& mesh, bool floats)
{
    CutRegion region;
    region._kind = SURFACE;
    core::TriangleMesh made = mesh;
    if (mesh.validate().ok()) {
        // What a float may be off by, and what modellers round by.
        const core::Box3d bounds = mesh.bounds();
        const glm::dvec3 largest = glm::max(glm::abs(bounds.min), glm::abs(bounds.max));
        const double ofFloats = floats ? 2.0 * std::numeric_limits<float>::epsilon() *
                                             std::max({largest.x, largest.y, largest.z})
                                       : 0.0;
        made = welded(mesh, std::max(1e-6 * glm::length(bounds.size()), ofFloats));
    }
    region._mesh = std::make_shared<core::TriangleMesh>(std::move(made));
    return region;
}

CutRegion CutRegion::mask(Voxels* voxels, double low, double high)
{
    CutRegion region;
    region._kind = MASK;
    region._mask = voxels;
    region._low = low;
    region._high = high;
    return region;
}

CutRegion CutRegion::complement() const
{
    CutRegion region = *this;
    region._complement = !_complement;
    return region;
}

Status CutRegion::validate() const
{
    switch (_kind) {
    case HALF_SPACE: {
        const double length = glm::length(glm::dvec3(_plane.x(), _plane.y(), _plane.z()));
        if (!std::isfinite(length) || !(length > 0.0) || !std::isfinite(_plane.w()))
            return refusal("its plane has no direction, or is not finite");
        break;
    }
    case BOX:
        if (!std::isfinite((_box._max - _box._min).length()) ||
            !(_box.xMin() < _box.xMax() && _box.yMin() < _box.yMax() && _box.zMin() < _box.zMax()))
            return refusal("its box has no volume, or is not finite");
        break;
    case SPHERE:
        if (!(_radius > 0.0) || !std::isfinite(_radius + _center.length()))
            return refusal("the radius of its sphere is " + core::formatNumber(_radius) +
                           ", expected it above 0, and all finite");
        break;
    case SURFACE:
        return core::checkClosed(*_mesh);
    case MASK:
        if (!_mask || !_mask->valid()) return refusal("its mask has no voxels");
        if (_mask->isPaged()) return refusal("its mask has several levels or time steps");
        if (!(_low <= _high) || !std::isfinite(_low))
            return refusal("its mask is to have values from " + core::formatNumber(_low) + " to " +
                           core::formatNumber(_high) + ", which is no range");
        break;
    }
    return {};
}

} // namespace osgVolumizer
