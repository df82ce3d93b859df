// What VolumeGeometry calls for OSG's intersectors.
#include "../../private/Picker.h"

#include "../Pick.h"
#include "GlmToOsg.h"
#include "PolytopeSearch.h"

#include "../../VolumeAppearance.h"
#include "../../VolumeGeometry.h"

#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>
#include <osgUtil/PolytopeIntersector>
#include <osgUtil/RayIntersector>

#include <algorithm>

namespace osgVolumizer {
namespace picking {

namespace {

using osgUtil::Intersector;

/// The visitor keeps the intersector in local coordinates to itself and to its heirs.
struct VisitorHeir : osgUtil::IntersectionVisitor
{
    static Intersector* currentOf(const osgUtil::IntersectionVisitor& visitor)
    {
        const IntersectorStack& stack = visitor.*(&VisitorHeir::_intersectorStack);
        return stack.empty() ? nullptr : stack.back().get();
    }
};

/// A volume under a visitor.
struct Visited
{
    VolumeGeometry& geometry;
    const VolumeAppearance& appearance;
    osgUtil::IntersectionVisitor& visitor;
    double simulationTime;

    std::optional<PickHit> pick(const osg::Vec3d& start, const osg::Vec3d& end) const
    {
        PickOptions options;
        options.simulationTime = simulationTime;
        options.clipPlanes = clipPlanesAbove(visitor.getNodePath());
        return pickVolume(geometry, appearance, start, end, options).value;
    }
    template <class Hit>
    void describe(Hit& hit, unsigned tetrahedron) const
    {
        hit.nodePath = visitor.getNodePath();
        hit.drawable = &geometry;
        hit.matrix = visitor.getModelMatrix();
        hit.primitiveIndex = tetrahedron;
    }
};

// As OSG does for other drawables; `key` is what intersections are sorted by.
template <class Ray, class Hit>
void insertHit(Ray& ray, const Hit& hit, double Hit::*key)
{
    auto& hits = ray.getIntersections();
    if (ray.getIntersectionLimit() == Intersector::LIMIT_NEAREST && !hits.empty()) {
        if (hit.*key >= (*hits.begin()).*key) return;
        hits.clear();
    }
    ray.insertIntersection(hit);
}

void intersectSegment(osgUtil::LineSegmentIntersector& segment, const Visited& volume)
{
    const auto found = volume.pick(segment.getStart(), segment.getEnd());
    if (!found) return;
    osgUtil::LineSegmentIntersector::Intersection hit;
    volume.describe(hit, found->tetrahedron);
    hit.ratio = found->ratio;
    hit.localIntersectionPoint = found->point;
    hit.localIntersectionNormal = found->normal;
    insertHit(segment, hit, &osgUtil::LineSegmentIntersector::Intersection::ratio);
}

// What of the ray can be in the volume is a segment.
void intersectRay(osgUtil::RayIntersector& ray, const Visited& volume)
{
    const osg::Vec3d start = ray.getStart();
    osg::Vec3d direction = ray.getDirection();
    if (!(direction.normalize() > 0.0)) return;
    const core::Box3d box = volume.geometry.getTetraSet()->bounds();
    double length = 0.0;
    for (int i = 0; i < 8; ++i)
        length = std::max(length, (toOsg(box.corner(i)) - start) * direction);
    length += 1e-6 * glm::length(box.size());
    const auto found = volume.pick(start, start + direction * length);
    if (!found) return;
    osgUtil::RayIntersector::Intersection hit;
    volume.describe(hit, found->tetrahedron);
    hit.distance = found->ratio * length;
    hit.localIntersectionPoint = found->point;
    hit.localIntersectionNormal = found->normal;
    insertHit(ray, hit, &osgUtil::RayIntersector::Intersection::distance);
}

core::Plane planeOf(const osg::Plane& plane)
{
    return {{plane[0], plane[1], plane[2]}, plane[3]};
}

bool isFinite(const core::Plane& plane)
{
    return std::isfinite(plane.normal.x + plane.normal.y + plane.normal.z + plane.offset);
}

void intersectPolytope(osgUtil::PolytopeIntersector& polytope, const Visited& volume)
{
    std::vector<core::Plane> planes;
    for (const osg::Plane& plane : polytope.getPolytope().getPlaneList())
        planes.push_back(planeOf(plane));
    for (const osg::Vec4d& plane : clipPlanesAbove(volume.visitor.getNodePath()))
        planes.push_back({{plane[0], plane[1], plane[2]}, plane[3]});
    const core::Plane reference = planeOf(polytope.getReferencePlane());
    if (planes.empty() || !isFinite(reference) ||
        !std::all_of(planes.begin(), planes.end(), isFinite))
        return;
    const VolumeView view(volume.geometry, volume.appearance, volume.simulationTime);
    const PolytopeHit found = findInPolytope(view, planes, reference, PickOptions::DEFAULT_BYTES);
    if (!found.found) return;
    using Intersection = osgUtil::PolytopeIntersector::Intersection;
    Intersection hit;
    volume.describe(hit, found.tetrahedron);
    hit.distance = found.distance;
    hit.maxDistance = found.farthest;
    hit.localIntersectionPoint = toOsg(found.center);
    hit.numIntersectionPoints = static_cast<unsigned>(
        std::min<std::size_t>(found.corners.size(), Intersection::MaxNumIntesectionPoints));
    for (unsigned i = 0; i < hit.numIntersectionPoints; ++i)
        hit.intersectionPoints[i] = toOsg(found.corners[i]);
    insertHit(polytope, hit, &Intersection::distance);
}

void intersectBy(Intersector& intersector, const Visited& volume)
{
    if (intersector.disabled() || intersector.reachedLimit()) return;
    if (auto* group = dynamic_cast<osgUtil::IntersectorGroup*>(&intersector)) {
        for (const auto& member : group->getIntersectors())
            intersectBy(*member, volume);
    } else if (auto* segment = dynamic_cast<osgUtil::LineSegmentIntersector*>(&intersector)) {
        intersectSegment(*segment, volume);
    } else if (auto* ray = dynamic_cast<osgUtil::RayIntersector*>(&intersector)) {
        intersectRay(*ray, volume);
    } else if (auto* polytope = dynamic_cast<osgUtil::PolytopeIntersector*>(&intersector)) {
        intersectPolytope(*polytope, volume);
    }
}

class VolumePicker : public Picker
{
public:
    void intersect(VolumeGeometry& geometry, osgUtil::IntersectionVisitor& visitor,
                   double simulationTime) override
    {
        Intersector* intersector = VisitorHeir::currentOf(visitor);
        const VolumeAppearance* appearance = appearanceOf(visitor.getNodePath());
        if (!intersector || !appearance || visitor.getDoDummyTraversal()) return;
        intersectBy(*intersector, {geometry, *appearance, visitor, simulationTime});
    }
};

// Never destroyed: nodes may be, after everything static.
[[maybe_unused]] const bool pickerInstalled = [] {
    setPicker(new VolumePicker);
    return true;
}();

} // namespace

} // namespace picking
} // namespace osgVolumizer
