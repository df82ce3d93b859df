// A volume and the handles that it can be changed by.
//
//   osgvolumizerhandles SCENE                   in a window; keys 1 to 7 choose the tool, u and r
//                                               undo and redo
//   osgvolumizerhandles SCENE TOOL PICTURE.png  without one; the tool by its name
//
// The first volume of the scene is taken. Faces of boxes slide only while Ctrl is down, so that the
// mouse still turns the view.

#include <support/PictureFile.h>
#include <support/ReadScene.h>
#include <support/SceneRenderer.h>

#include <osgVolumizer/interact/ClipPlaneDragger.h>
#include <osgVolumizer/interact/CropDragger.h>
#include <osgVolumizer/interact/CutDragger.h>
#include <osgVolumizer/interact/LatticeDragger.h>
#include <osgVolumizer/interact/PartDragger.h>
#include <osgVolumizer/interact/ProbeDragger.h>

#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>

#include <osg/MatrixTransform>
#include <osgGA/GUIEventHandler>
#include <osgManipulator/Dragger>
#include <osgViewer/Viewer>

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <string>

using namespace osgVolumizer;

namespace {

const char* const TOOLS[] = {"plane", "box", "sphere", "crop", "probe", "lattice", "part"};

/// The first volume of a scene.
class FindVolume : public osg::NodeVisitor
{
public:
    FindVolume() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}
    void apply(osg::Drawable& drawable) override
    {
        auto* found = dynamic_cast<VolumeGeometry*>(&drawable);
        if (!found || geometry) return;
        geometry = found;
        for (osg::Node* node : getNodePath())
            if (auto* above = dynamic_cast<VolumeAppearance*>(node)) appearance = above;
    }

    VolumeGeometry* geometry = nullptr;
    VolumeAppearance* appearance = nullptr;
};

osg::ref_ptr<VolumeHandles> cutBy(VolumeAppearance& volume, const CutRegion& region,
                                  const osg::BoundingBoxd& box)
{
    if (!volume.getCut()) volume.setCut(new VolumeCut);
    volume.getCut()->addRegion(region);
    return CutDragger::create(volume.getCut(), volume.getCut()->getNumRegions() - 1, box)
        .value.get();
}

// Splits a box in two, the far part along y below a transform of its own: of the shipped head,
// whose second axis points down, chin and neck.
osg::ref_ptr<VolumeHandles> splitOff(VolumeGeometry& geometry, const osg::BoundingBoxd& box)
{
    osg::BoundingBoxd upper = box, lower = box;
    upper.yMax() = lower.yMin() = box.yMin() + 0.65 * (box.yMax() - box.yMin());
    geometry.setBox(upper);
    osg::ref_ptr<osg::MatrixTransform> part = new osg::MatrixTransform;
    part->addChild(VolumeGeometry::createBox(lower));
    geometry.getParent(0)->addChild(part);
    return new PartDragger(part);
}

osg::ref_ptr<VolumeHandles> probeAlong(VolumeGeometry& geometry, VolumeAppearance& volume,
                                       const osg::BoundingBoxd& box)
{
    osg::Vec3d start = box.center(), end = box.center();
    start.y() = box.yMin(), end.y() = box.yMax();
    osg::ref_ptr<ProbeDragger> line =
        new ProbeDragger(&geometry, &volume, start, end, 0.03 * box.radius());
    line->setCallback([](const Result<VoxelProbe>& found) {
        double highest = 0.0;
        for (const ProbedVoxel& voxel : found->voxels)
            highest = std::max(highest, voxel.raw);
        std::printf("%zu voxels, the highest is %g\n", found->voxels.size(), highest);
    });
    return line;
}

osg::ref_ptr<VolumeHandles> makeTool(const std::string& name, VolumeGeometry& geometry,
                                     VolumeAppearance& volume)
{
    const osg::BoundingBoxd box = geometry.getBoundingBox();
    const osg::Vec3d middle = box.center(), half = (box._max - box._min) * 0.3;
    if (name == "plane")
        return cutBy(volume,
                     CutRegion::halfSpace(
                         {0.3, 0.9, 0.2, -0.3 * middle.x() - 0.9 * middle.y() - 0.2 * middle.z()}),
                     box);
    if (name == "box") return cutBy(volume, CutRegion::box({middle - half, middle + half}), box);
    if (name == "sphere")
        return cutBy(volume, CutRegion::sphere(middle, 0.3 * box.radius()).complement(), box);
    if (name == "crop") return new CropDragger(&geometry);
    if (name == "probe") return probeAlong(geometry, volume, box);
    if (name == "part") return splitOff(geometry, box);
    const auto lattice =
        LatticeDeformer::create(&geometry, *volume.getVoxels(), box, {3, 3, 3}, {8, 8, 8});
    return lattice.ok() ? new LatticeDragger(lattice.value) : nullptr;
}

/// Chooses tools, undoes and redoes.
class Keys : public osgGA::GUIEventHandler
{
public:
    Keys(VolumeGeometry& geometry, VolumeAppearance& volume) : _geometry(geometry), _volume(volume)
    {
    }
    bool handle(const osgGA::GUIEventAdapter& event, osgGA::GUIActionAdapter&) override
    {
        if (event.getEventType() != osgGA::GUIEventAdapter::KEYDOWN) return false;
        const int key = event.getKey();
        if (key == 'u') return _history->undo();
        if (key == 'r') return _history->redo();
        if (key < '1' || key > '7') return false;
        choose(TOOLS[key - '1']);
        return true;
    }
    void choose(const std::string& name)
    {
        osg::Group& parent = *_geometry.getParent(0);
        if (_tool) parent.removeChild(_tool);
        _tool = makeTool(name, _geometry, _volume);
        if (!_tool) return;
        _tool->setHistory(_history);
        if (name == "box" || name == "crop")
            _tool->getDragger(0)->setActivationModKeyMask(osgGA::GUIEventAdapter::MODKEY_CTRL);
        parent.addChild(_tool);
    }
    VolumeHandles* tool() const { return _tool.get(); }

private:
    VolumeGeometry& _geometry;
    VolumeAppearance& _volume;
    osg::ref_ptr<VolumeHandles> _tool;
    osg::ref_ptr<DragHistory> _history = new DragHistory;
};

int drawPicture(osg::Node* scene, const char* file)
{
    support::RenderOptions options;
    const osg::BoundingSphere& bound = scene->getBound();
    options.size(640, 480).perspective(30.0).lookAt(
        bound.center() + osg::Vec3d(-2.8, -4.1, 1.4) * bound.radius(), bound.center(), {0, 0, 1});
    options.background = osg::Vec4(0.10f, 0.11f, 0.13f, 1.0f);
    options.light = true;
    options.frames = 3; // handles keep their size on the screen; the view is at rest thereafter
    const Status status = support::writePicture(support::renderScene(scene, options), file);
    if (!status) std::fprintf(stderr, "osgvolumizerhandles: %s\n", status.text.c_str());
    return status ? 0 : 1;
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2 && argc != 4) {
        std::fprintf(stderr, "usage: osgvolumizerhandles SCENE [TOOL PICTURE.png]\n");
        return 2;
    }
    const auto read = support::readScene(argv[1]);
    FindVolume find;
    if (read.ok()) read.value->accept(find);
    if (!find.appearance) {
        std::fprintf(stderr, "osgvolumizerhandles: %s\n",
                     read.ok() ? "there is no volume" : read.status.text.c_str());
        return 1;
    }
    if (argc == 4 &&
        std::find(std::begin(TOOLS), std::end(TOOLS), std::string(argv[2])) == std::end(TOOLS)) {
        std::fprintf(stderr, "osgvolumizerhandles: there is no tool '%s'\n", argv[2]);
        return 2;
    }
    osg::ref_ptr<Keys> keys = new Keys(*find.geometry, *find.appearance);
    keys->choose(argc == 4 ? argv[2] : TOOLS[0]);
    if (argc == 4) return drawPicture(*read, argv[3]);
    osgViewer::Viewer viewer;
    viewer.addEventHandler(keys);
    viewer.setSceneData(*read);
    return viewer.run();
}
