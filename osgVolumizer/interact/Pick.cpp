#include "DrawnDepth.h"

#include "../VolumeAppearance.h"
#include "../VolumeGeometry.h"
#include "../core/Text.h"
#include "../render/context/ClipPlanes.h"
#include "../render/context/ModeInForce.h"
#include "../render/volume/NearestAppearance.h"
#include "private/GlmToOsg.h"
#include "private/VolumeView.h"

#include <osg/Camera>
#include <osg/ClipNode>
#include <osg/Transform>
#include <osgUtil/IntersectionVisitor>
#include <osgUtil/LineSegmentIntersector>

#include <cmath>
#include <cstddef>
#include <map>

namespace osgVolumizer {

namespace {

using picking::toGlm;
using picking::toOsg;

Status checkPick(const picking::Segment& segment, const PickOptions& options)
{
    if (!segment.valid())
        return {ErrorCode::VALUE_INVALID, "a segment from " + core::formatTriple(segment.start) +
                                              " to " + core::formatTriple(segment.end) +
                                              " has no length, or is not finite"};
    if (!(options.opacity >= 0.0 && options.opacity < 1.0))
        return {ErrorCode::VALUE_INVALID, "the opacity of a pick is " +
                                              core::formatNumber(options.opacity) +
                                              ", expected it to be in [0, 1)"};
    return {};
}

PickHit hitOf(const picking::VolumeView& view, picking::ValueField* field,
              const picking::Segment& segment, const picking::SeenPlace& seen)
{
    PickHit hit;
    hit.ratio = seen.parameter;
    hit.point = toOsg(segment.at(seen.parameter));
    hit.normal = toOsg(view.normalAt(field, segment, seen.span, seen.parameter));
    hit.tetrahedron = seen.span.inTetrahedron ? seen.span.tetrahedron
                                              : view.region->tetrahedronAt(segment, seen.parameter);
    if (view.look.scalars) hit.value = seen.span.scalarAt(seen.parameter);
    if (!field) return hit;
    hit.voxel = toOsg(seen.span.voxelAt(seen.parameter));
    const picking::GridLine line(seen.span, field->grid());
    hit.value = field->dataAt(line.at(seen.parameter), view.look.rgba ? 3 : 0);
    hit.level = field->level();
    return hit;
}

} // namespace

Result<std::optional<PickHit>> pickVolume(const VolumeGeometry& geometry,
                                          const VolumeAppearance& appearance,
                                          const osg::Vec3d& start, const osg::Vec3d& end,
                                          const PickOptions& options)
{
    const picking::Segment segment{toGlm(start), toGlm(end)};
    if (Status status = checkPick(segment, options); !status.ok()) return status;
    const picking::VolumeView view(geometry, appearance, options.simulationTime);
    std::optional<PickHit> none;
    if (!view.region) return none;
    const std::vector<picking::Span> spans = view.spans(segment, options.clipPlanes);
    if (spans.empty()) return none;
    const double opacity = options.opacity > 0.0 ? options.opacity : appearance.getPickOpacity();
    const double units = picking::unitsPerParameter(segment, view.look);
    for (int level = 0;; ++level) {
        level = view.levelWithin(spans, options.maximumBytes, level);
        const auto field = view.fieldOf(level);
        const picking::SeenPlace seen =
            picking::findSeenPlace(field.get(), view.look, spans, units, opacity);
        // Where pages cannot be read, coarser ones are seen.
        if (field && field->failed() && level + 1 < view.levelCount()) continue;
        if (!seen.found) return none;
        return std::optional<PickHit>(hitOf(view, field.get(), segment, seen));
    }
}

std::vector<osg::Vec4d> clipPlanesAbove(const osg::NodePath& path)
{
    std::map<unsigned, osg::Vec4d> byNumber; // the last one of a number counts
    for (std::size_t i = 0; i < path.size(); ++i) {
        const auto* node = dynamic_cast<const osg::ClipNode*>(path[i]);
        if (!node || node->getReferenceFrame() != osg::ClipNode::RELATIVE_RF) continue;
        // By way of the world: below there may be transforms of no reference to what is above.
        const osg::NodePath above(path.begin(), path.begin() + std::ptrdiff_t(i) + 1);
        osg::Matrixd fromWorld;
        if (!picking::invert(osg::computeLocalToWorld(above), fromWorld)) continue;
        const osg::Matrixd toNode = osg::computeLocalToWorld(path) * fromWorld;
        for (const auto& plane : node->getClipPlaneList()) {
            const core::Plane made = render::transformedPlane(plane->getClipPlane(), toNode);
            byNumber[plane->getClipPlaneNum()] = osg::Vec4d(toOsg(made.normal), made.offset);
        }
    }
    std::vector<const osg::StateSet*> sets;
    for (const osg::Node* node : path)
        if (node->getStateSet()) sets.push_back(node->getStateSet());
    std::vector<osg::Vec4d> planes;
    for (const auto& plane : byNumber)
        if (render::isOn(sets, GL_CLIP_PLANE0 + plane.first, false)) planes.push_back(plane.second);
    return planes;
}

const VolumeAppearance* appearanceOf(const osg::NodePath& path)
{
    return render::nearestAppearance(path);
}

const VolumeGeometry* geometryOf(const osg::NodePath& path)
{
    return path.empty() ? nullptr : dynamic_cast<const VolumeGeometry*>(path.back());
}

namespace {

// Under a window position of a camera, what a visitor finds.
Result<std::optional<PixelPick>> pickPixel(osg::Camera& camera, double x, double y,
                                           osg::Node::NodeMask mask,
                                           osgUtil::IntersectionVisitor& visitor)
{
    if (!std::isfinite(x) || !std::isfinite(y))
        return Status(ErrorCode::VALUE_INVALID, "window position " + core::formatNumber(x) + "," +
                                                    core::formatNumber(y) + " is not finite");
    const osg::Viewport* viewport = camera.getViewport();
    if (!viewport) return Status(ErrorCode::VALUE_INVALID, "the camera has no viewport");
    const osg::Matrixd toWindow = camera.getViewMatrix() * camera.getProjectionMatrix();
    if (osg::Matrixd inverse; !picking::invert(toWindow, inverse))
        return Status(ErrorCode::SINGULAR_MATRIX, "the camera's matrices have no inverse");
    osg::ref_ptr<osgUtil::LineSegmentIntersector> intersector = new osgUtil::LineSegmentIntersector(
        osgUtil::Intersector::WINDOW, viewport->x() + x, viewport->y() + y);
    intersector->setIntersectionLimit(osgUtil::Intersector::LIMIT_NEAREST);
    visitor.setIntersector(intersector);
    visitor.setTraversalMask(mask);
    camera.accept(visitor);
    if (!intersector->containsIntersections()) return std::optional<PixelPick>();
    const auto first = intersector->getFirstIntersection();
    PixelPick pick;
    pick.point = first.getWorldIntersectPoint();
    pick.normal = first.getWorldIntersectNormal();
    pick.normal.normalize();
    pick.ratio = first.ratio;
    pick.nodePath = first.nodePath;
    pick.drawable = first.drawable;
    pick.isVolume = dynamic_cast<const VolumeGeometry*>(first.drawable.get()) != nullptr;
    return std::optional<PixelPick>(pick);
}

/// Finds volumes, which accept visitors themselves, and no other drawable.
struct VolumesOnly : osgUtil::IntersectionVisitor
{
    void apply(osg::Drawable&) override {}
};

} // namespace

Result<std::optional<PixelPick>> zpick(osg::Camera& camera, double x, double y,
                                       osg::Node::NodeMask mask)
{
    osgUtil::IntersectionVisitor visitor;
    return pickPixel(camera, x, y, mask, visitor);
}

Result<std::optional<PixelPick>> zpickDrawn(osg::Camera& camera, double x, double y,
                                            double windowDepth, osg::Node::NodeMask mask)
{
    if (!(windowDepth >= 0.0 && windowDepth <= 1.0))
        return Status(ErrorCode::VALUE_INVALID,
                      "window depth " + core::formatNumber(windowDepth) + " is outside [0, 1]");
    VolumesOnly visitor;
    const auto found = pickPixel(camera, x, y, mask, visitor);
    if (!found.ok() || windowDepth == 1.0) return found; // nothing was drawn there
    const osg::Matrixd fromWindow =
        osg::Matrixd::inverse(camera.getViewMatrix() * camera.getProjectionMatrix() *
                              camera.getViewport()->computeWindowMatrix());
    const auto at = [&](double z) {
        const osg::Viewport& viewport = *camera.getViewport();
        return osg::Vec3d(viewport.x() + x, viewport.y() + y, z) * fromWindow;
    };
    PixelPick drawn;
    drawn.point = at(windowDepth);
    drawn.ratio = (drawn.point - at(0.0)).length() / (at(1.0) - at(0.0)).length();
    if (found.value && found.value->ratio <= drawn.ratio) return found;
    return std::optional<PixelPick>(drawn);
}

} // namespace osgVolumizer
