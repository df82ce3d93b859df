#include "HandlePointer.h"

#include "../VolumeHandles.h"

#include <osg/NodeVisitor>
#include <osgGA/GUIEventAdapter>
#include <osgViewer/View>

#include <utility>
#include <vector>

namespace osgVolumizer {

namespace {

using Hits = osgUtil::LineSegmentIntersector::Intersections;

/// The paths to all groups of handles that are shown.
class FindHandles : public osg::NodeVisitor
{
public:
    FindHandles() : osg::NodeVisitor(TRAVERSE_ACTIVE_CHILDREN) {}
    void apply(osg::Group& group) override
    {
        if (dynamic_cast<VolumeHandles*>(&group)) paths.push_back(getNodePath());
        traverse(group);
    }

    std::vector<osg::NodePath> paths;
};

/// What a view's pointer hits of one group of handles; where another's are nearer, nothing. Paths
/// begin with the group.
Hits hitsOf(const VolumeHandles& owner, const osgGA::GUIEventAdapter& event, osgViewer::View& view)
{
    FindHandles find;
    if (view.getSceneData()) view.getSceneData()->accept(find);
    Hits nearest;
    const osg::Node* whose = nullptr;
    for (const osg::NodePath& path : find.paths) {
        Hits hits;
        if (!view.computeIntersections(event, path, hits)) continue;
        if (!nearest.empty() && hits.begin()->ratio >= nearest.begin()->ratio) continue;
        nearest = std::move(hits);
        whose = path.back();
    }
    return whose == &owner ? nearest : Hits();
}

osgManipulator::Dragger* outermostDragger(const osg::NodePath& path)
{
    for (osg::Node* node : path)
        if (auto* dragger = dynamic_cast<osgManipulator::Dragger*>(node)) return dragger;
    return nullptr;
}

// As in osgManipulator::Dragger::handle(), but for keys.
bool activates(const osgManipulator::Dragger& dragger, const osgGA::GUIEventAdapter& event)
{
    const unsigned keys = dragger.getActivationModKeyMask();
    const unsigned buttons = dragger.getActivationMouseButtonMask();
    if (keys == 0 && buttons == 0) return true;
    return (static_cast<unsigned>(event.getModKeyMask()) & keys) != 0 ||
           (static_cast<unsigned>(event.getButtonMask()) & buttons) != 0;
}

/// A camera, and a place in its viewport in pixels.
struct CameraPixel
{
    osg::Camera* camera = nullptr;
    float x = 0.0f, y = 0.0f;
};

CameraPixel pixelOf(const osgGA::GUIEventAdapter& event, osgViewer::View& view)
{
    CameraPixel pixel;
    if (event.getNumPointerData() > 0) {
        const osgGA::PointerData& data = *event.getPointerData(event.getNumPointerData() - 1);
        pixel.camera = data.object.valid() ? data.object->asCamera() : nullptr;
        if (pixel.camera && pixel.camera->getViewport()) {
            const osg::Viewport& v = *pixel.camera->getViewport();
            pixel.x = static_cast<float>(v.x() + 0.5 * (data.getXnormalized() + 1.0) * v.width());
            pixel.y = static_cast<float>(v.y() + 0.5 * (data.getYnormalized() + 1.0) * v.height());
            return pixel;
        }
    }
    pixel.camera = const_cast<osg::Camera*>(
        view.getCameraContainingPosition(event.getX(), event.getY(), pixel.x, pixel.y));
    return pixel;
}

} // namespace

bool HandlePointer::press(VolumeHandles& owner, const osgGA::GUIEventAdapter& event,
                          osgViewer::View& view)
{
    _active = nullptr;
    const CameraPixel pixel = pixelOf(event, view);
    if (!pixel.camera) return false;
    const Hits hits = hitsOf(owner, event, view);
    for (auto hit = hits.begin(); hit != hits.end(); ++hit) {
        osgManipulator::Dragger* dragger = outermostDragger(hit->nodePath);
        if (!dragger || !activates(*dragger, event)) continue;
        // What lies behind as well: some draggers prefer their small handles to their large ones.
        _pointer.reset();
        for (auto behind = hit; behind != hits.end(); ++behind)
            _pointer.addIntersection(behind->nodePath, behind->getLocalIntersectPoint());
        _pointer.setCamera(pixel.camera);
        _pointer.setMousePosition(pixel.x, pixel.y);
        if (!dragger->handle(_pointer, event, view)) continue;
        _active = dragger;
        return true;
    }
    return false;
}

bool HandlePointer::handle(VolumeHandles& owner, const osgGA::GUIEventAdapter& event,
                           osgViewer::View& view)
{
    const auto type = event.getEventType();
    if (type == osgGA::GUIEventAdapter::PUSH && !event.getHandled())
        return press(owner, event, view);
    if (!_active ||
        (type != osgGA::GUIEventAdapter::DRAG && type != osgGA::GUIEventAdapter::RELEASE))
        return false;
    const CameraPixel pixel = pixelOf(event, view);
    if (pixel.camera) _pointer.setMousePosition(pixel.x, pixel.y);
    _active->handle(_pointer, event, view);
    if (type == osgGA::GUIEventAdapter::RELEASE) _active = nullptr;
    return true;
}

} // namespace osgVolumizer
