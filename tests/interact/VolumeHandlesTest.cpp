// Handles in a scene: seen, found and moved among volumes and surfaces, in all threading models.
#include "Drags.h"
#include "PickOracle.h"

#include <osgVolumizer/interact/CutDragger.h>
#include <osgVolumizer/interact/PartDragger.h>
#include <osgVolumizer/interact/ProbeDragger.h>

#include <osg/ClipNode>
#include <osg/MatrixTransform>
#include <osgDB/ReadFile>
#include <osgDB/WriteFile>
#include <osgUtil/Optimizer>

#include <support/GLTest.h>
#include <support/Reports.h>
#include <support/Shapes.h>

#include <cstdio>

namespace VolumeHandlesTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::makeQuad;
using support::RenderOptions;

namespace {

constexpr int SIZE = 25;
const osg::Vec3d MIDDLE(12, 12, 12);

// Along y, so that pixels are easy to name.
RenderOptions front()
{
    return RenderOptions().size(120, 120).orthographic(15.0).lookAt({12, -60, 12}, MIDDLE,
                                                                    {0, 0, 1});
}

glm::vec4 at(const FloatImage& picture, const osg::Vec3d& world)
{
    const int x = static_cast<int>(60 + 4 * (world.x() - 12)),
              y = static_cast<int>(60 + 4 * (world.z() - 12));
    return picture.at(x, y);
}

osg::ref_ptr<VolumeAppearance> dense(double opacity)
{
    const osg::ref_ptr<VolumeAppearance> volume =
        makeVolume(makeVoxels(glm::ivec3(SIZE), [](const glm::dvec3&) { return 0.5; }));
    volume->setLookupTable(makeTable(constantPoints({1.0, 0.2, 0.1, opacity})));
    return volume;
}

/// A volume with a ball of radius 2 that probes at a point, blue.
struct Probing
{
    explicit Probing(const osg::Vec3d& point, double opacity = 0.9) : volume(dense(opacity))
    {
        handles = new ProbeDragger(&geometryBelow(*volume), volume, point, 2.0);
        root->addChild(volume);
        root->addChild(handles);
    }
    FloatImage picture() const { return support::renderScene(root, front()); }

    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<VolumeAppearance> volume;
    osg::ref_ptr<ProbeDragger> handles;
};

// The colour of points, see HandleShapes.h.
const glm::vec3 BLUE(0.2f, 0.8f, 0.95f);

class HandlePictures : public support::GLTest
{
};

} // namespace

TEST_F(HandlePictures, AreSeenInFrontOfAVolumeAndInIt)
{
    const osg::Vec3d inFront(12, -6, 12), within(12, 12, 12), beside(12, 12, 25.5);
    const FloatImage seen = Probing(inFront).picture();
    EXPECT_LT(glm::length(glm::vec3(at(seen, inFront)) - BLUE), 1e-3f);
    EXPECT_LT(glm::length(glm::vec3(at(Probing(beside).picture(), beside)) - BLUE), 1e-3f);
    // Within, nothing would be left of it: 1e-10 of its light gets out. It shows through.
    const Probing hidden(within);
    const FloatImage through = hidden.picture();
    support::savePicture(through, "handles_in_dense_volume");
    const glm::vec3 red(1.0f, 0.2f, 0.1f);
    EXPECT_LT(glm::length(glm::vec3(at(through, within)) - glm::mix(red, BLUE, 0.35f)), 1e-3f);
    EXPECT_LT(glm::length(glm::vec3(at(through, {17, 12, 12})) - red), 1e-3f);
    ASSERT_TRUE(hidden.handles->setThroughOpacity(0.0));
    EXPECT_LT(glm::length(glm::vec3(at(hidden.picture(), within)) - red), 1e-3f);
    // Of a thin volume what is in front of it counts, and the rest is behind.
    const FloatImage thin = Probing(within, 0.02).picture();
    const double front12 = std::pow(0.98, 10.0); // object units from the face to the ball
    const glm::vec3 solid = glm::mix(red, BLUE, float(front12));
    EXPECT_LT(glm::length(glm::vec3(at(thin, within)) - glm::mix(solid, BLUE, 0.35f)), 2e-3f);
}

TEST_F(HandlePictures, ShowThroughSurfacesAndClipPlanes)
{
    const osg::Vec3d within(12, 12, 12);
    Probing scene(within);
    scene.root->addChild(
        makeQuad({osg::Vec3(0, -5, 0), {24, -5, 0}, {24, -5, 24}, {0, -5, 24}}, {1, 1, 0, 1}));
    const FloatImage wall = scene.picture();
    EXPECT_LT(glm::length(glm::vec3(at(wall, within)) - glm::mix(glm::vec3(1, 1, 0), BLUE, 0.35f)),
              1e-3f);
    // A plane takes the volume away, and not what moves it.
    Probing cut(within);
    osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
    clip->addClipPlane(new osg::ClipPlane(0, osg::Vec4d(0, 0, 1, -20)));
    clip->addChild(cut.root);
    const FloatImage clipped = support::renderScene(clip, front());
    EXPECT_LT(glm::length(glm::vec3(at(clipped, within)) - BLUE), 1e-3f);
    EXPECT_EQ(at(clipped, {18, 12, 12}).a, 0.0f);
    EXPECT_GT(at(clipped, {18, 12, 22}).a, 0.9f);
}

TEST(VolumeHandles, AreFoundThroughVolumesAndWalls)
{
    Probing scene(MIDDLE);
    scene.root->addChild(
        makeQuad({osg::Vec3(0, -5, 0), {24, -5, 0}, {24, -5, 24}, {0, -5, 24}}, {1, 1, 0, 1}));
    osgViewer::Viewer viewer;
    lookWithoutWindow(viewer, scene.root, front());
    Pointer pointer(viewer);
    EXPECT_FALSE(pointer.dragFromTo({18, 12, 12}, {18, 12, 14}));
    EXPECT_EQ(scene.handles->getStart(), MIDDLE);
    EXPECT_TRUE(pointer.dragFromTo({12, 12, 12}, {15, 12, 10}));
    EXPECT_LT((scene.handles->getStart() - osg::Vec3d(15, 12, 10)).length(), 1e-3);
    // Hidden handles are not there.
    scene.handles->setNodeMask(0);
    EXPECT_FALSE(pointer.press({15, 12, 10}));
}

// Events of a window come in pixels, and OSG says of which camera.
TEST(VolumeHandles, TakeEventsOfWindows)
{
    Probing scene(MIDDLE);
    osgViewer::Viewer viewer;
    lookWithoutWindow(viewer, scene.root, front());
    osgViewer::Viewer::Windows windows;
    viewer.getWindows(windows);
    ASSERT_EQ(windows.size(), 1u);
    osgGA::EventQueue& queue = *windows[0]->getEventQueue();
    queue.setMouseInputRange(0.0f, 0.0f, 120.0f, 120.0f);
    const auto frame = [&viewer] {
        viewer.advance();
        viewer.eventTraversal();
        viewer.updateTraversal();
    };
    // OSG's y runs downwards here; 119 pixels are 30 units.
    const float middle = 59.5f, unit = 119.0f / 30.0f;
    queue.mouseButtonPress(middle, middle, 1, 0.0);
    frame();
    EXPECT_TRUE(scene.handles->isDragged());
    queue.mouseMotion(middle + 3 * unit, middle, 0.0);
    frame();
    queue.mouseButtonRelease(middle + 3 * unit, middle, 1, 0.0);
    frame();
    EXPECT_FALSE(scene.handles->isDragged());
    EXPECT_LT((scene.handles->getStart() - osg::Vec3d(15, 12, 12)).length(), 0.2);
}

TEST(ProbeDraggers, TellWhatIsThere)
{
    const osg::ref_ptr<VolumeAppearance> volume = makeVolume(makeVoxels(glm::ivec3(SIZE), bumps));
    const VolumeGeometry& geometry = geometryBelow(*volume);
    osg::ref_ptr<ProbeDragger> line =
        new ProbeDragger(&geometry, volume, osg::Vec3d(3, 5, -4), osg::Vec3d(3, 5, 30), 0.5);
    std::vector<VoxelProbe> found;
    line->setCallback([&found](const Result<VoxelProbe>& probe) {
        ASSERT_TRUE(probe.ok()) << probe.status.text;
        found.push_back(*probe);
    });
    const osg::ref_ptr<DragHistory> history = new DragHistory;
    line->setHistory(history);
    // The middle moves both ends, an end only itself.
    translate(*line->getDragger(2), osg::Vec3d(4, 0, 0)); // radii
    EXPECT_LT((line->getStart() - osg::Vec3d(5, 5, -4)).length(), 1e-12);
    EXPECT_LT((line->getEnd() - osg::Vec3d(5, 5, 30)).length(), 1e-12);
    translate(*line->getDragger(1), osg::Vec3d(0, 0, -32)); // to z = 14
    ASSERT_EQ(found.size(), 2u);
    EXPECT_EQ(found[0].voxels.size(), std::size_t(SIZE));
    EXPECT_EQ(found[0].voxels[7].index, osg::Vec3i(5, 5, 7));
    EXPECT_NEAR(found[0].voxels[7].raw, bumps({5, 5, 7}), 1e-6);
    EXPECT_EQ(found[1].voxels.size(), 15u);
    EXPECT_TRUE(history->undo());
    EXPECT_TRUE(history->undo());
    EXPECT_EQ(line->getStart(), osg::Vec3d(3, 5, -4));
    EXPECT_EQ(found.size(), 4u);
    EXPECT_EQ(found[3].voxels[7].index, osg::Vec3i(3, 5, 7));
}

TEST(ProbeDraggers, ProbeAPoint)
{
    const support::Reports reports;
    const osg::ref_ptr<VolumeAppearance> volume = makeVolume(makeVoxels(glm::ivec3(SIZE), bumps));
    const auto grid = gridOf(*volume->getVoxels());
    osg::ref_ptr<ProbeDragger> point =
        new ProbeDragger(&geometryBelow(*volume), volume, osg::Vec3d(7.2, 9.9, 11.3), 1.0);
    const auto found = point->probeNow();
    ASSERT_TRUE(found.ok()) << found.status.text;
    ASSERT_EQ(found->voxels.size(), 1u);
    EXPECT_EQ(found->voxels[0].index, osg::Vec3i(7, 10, 11));
    EXPECT_NEAR(found->voxels[0].filtered, grid->value({7.2, 9.9, 11.3}), 1e-6);
    EXPECT_TRUE(point->isPoint());
    EXPECT_EQ(point->setSegment({1, 1, 1}, {2, 1, 1}).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(point->setSegment({NAN, 1, 1}, {NAN, 1, 1}).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(point->getStart(), osg::Vec3d(7.2, 9.9, 11.3));
    EXPECT_EQ(reports.all(), 2u);
    ASSERT_TRUE(point->setSegment({40, 1, 1}, {40, 1, 1}));
    EXPECT_TRUE(point->probeNow()->voxels.empty());
    osg::ref_ptr<ProbeDragger> line =
        new ProbeDragger(&geometryBelow(*volume), volume, osg::Vec3d(), osg::Vec3d(1, 1, 1), 1.0);
    EXPECT_EQ(line->setSegment({1, 1, 1}, {1, 1, 1}).code, ErrorCode::VALUE_INVALID);
}

// Skull and jaw: two parts of one volume, one below a transform of its own.
TEST_F(HandlePictures, PartsMoveByTheirTransforms)
{
    const osg::ref_ptr<VolumeAppearance> head = makeVolume(makeVoxels(glm::ivec3(SIZE), bumps));
    head->setLookupTable(makeTable(smoothPoints(0.4)));
    head->removeChildren(0, 1);
    const osg::BoundingBoxd upper(0, 0, 10, 24, 24, 24), lower(0, 0, 0, 24, 24, 10);
    head->addChild(VolumeGeometry::createBox(upper));
    osg::ref_ptr<osg::MatrixTransform> jaw = new osg::MatrixTransform;
    jaw->addChild(VolumeGeometry::createBox(lower));
    head->addChild(jaw);
    osg::ref_ptr<PartDragger> handles = new PartDragger(jaw);
    const osg::ref_ptr<DragHistory> history = new DragHistory;
    handles->setHistory(history);
    head->addChild(handles);
    RenderOptions options =
        front().size(160, 160).orthographic(22.0).lookAt({50, -60, 40}, {12, 12, 8}, {0, 0, 1});
    const auto picture = [&] {
        handles->setNodeMask(0);
        const FloatImage image = support::renderScene(head, options);
        handles->setNodeMask(~0u);
        return image;
    };
    const FloatImage closed = picture();
    const double radius = handles->getDragger(0)->getMatrix()(0, 0);
    translate(*handles->getDragger(0), osg::Vec3d(0, 0, -5.0 / radius));
    EXPECT_LT((jaw->getMatrix().getTrans() - osg::Vec3d(0, 0, -5)).length(), 1e-9);
    osg::ref_ptr<osgManipulator::Rotate3DCommand> turn = new osgManipulator::Rotate3DCommand;
    turn->setRotation(osg::Quat(0.3, osg::Vec3d(0, 1, 0)));
    command(*handles->getDragger(0), *turn);
    const osg::Matrixd open = jaw->getMatrix();
    EXPECT_NEAR(osg::Vec3d(open(0, 0), open(0, 1), open(0, 2)) * osg::Vec3d(1, 0, 0), std::cos(0.3),
                1e-9);
    // About the middle of the part, which stays.
    EXPECT_LT((osg::Vec3d(12, 12, 5) * open - osg::Vec3d(12, 12, 0)).length(), 1e-4);
    // The same by two volumes, of which one is moved as a whole.
    const osg::ref_ptr<VolumeAppearance> skull = new VolumeAppearance(*head),
                                         moved = new VolumeAppearance(*head);
    for (const auto& part : {skull, moved})
        part->removeChildren(0, part->getNumChildren());
    skull->addChild(VolumeGeometry::createBox(upper));
    moved->addChild(VolumeGeometry::createBox(lower));
    osg::ref_ptr<osg::MatrixTransform> above = new osg::MatrixTransform(open);
    above->addChild(moved);
    osg::ref_ptr<osg::Group> both = new osg::Group;
    both->addChild(skull);
    both->addChild(above);
    const FloatImage opened = picture();
    EXPECT_LT(support::compare(opened, support::renderScene(both, options)).rmse, 1e-3);
    EXPECT_GT(support::compare(opened, closed).rmse, 5e-2);
    support::savePicture(support::renderScene(head, options.size(400, 400)), "handles_part");
    options.size(160, 160);
    EXPECT_TRUE(history->undo());
    EXPECT_TRUE(history->undo());
    EXPECT_TRUE(jaw->getMatrix().isIdentity());
    EXPECT_EQ(support::compare(picture(), closed).maximum, 0.0);
    EXPECT_TRUE(history->redo());
    EXPECT_TRUE(history->redo());
    EXPECT_EQ(jaw->getMatrix(), open);
}

// While other threads cull and draw the frame before.
TEST_F(HandlePictures, MoveInEveryThreadingModel)
{
    using Viewer = osgViewer::ViewerBase;
    FloatImage first;
    for (const auto model :
         {Viewer::SingleThreaded, Viewer::CullDrawThreadPerContext, Viewer::DrawThreadPerContext,
          Viewer::CullThreadPerCameraDrawThreadPerContext}) {
        Probing scene(MIDDLE, 0.05);
        scene.volume->setCut(new VolumeCut);
        ASSERT_TRUE(scene.volume->getCut()->addRegion(CutRegion::halfSpace({0, 0, 1, -1})));
        const auto cut = CutDragger::create(scene.volume->getCut(), 0, {0, 0, 0, 24, 24, 24});
        scene.root->addChild(*cut);
        RenderOptions options = front();
        options.threading = model;
        support::SceneRenderer renderer(scene.root, options);
        ASSERT_TRUE(renderer.status().ok());
        renderer.render();
        Pointer pointer(renderer.viewer());
        ASSERT_TRUE(pointer.press({12, 12, 1 + 9}));
        for (int i = 0; i < 10; ++i) {
            pointer.drag({12, 12, 10 + 0.5 * i});
            renderer.render();
        }
        pointer.release({12, 12, 14.5});
        EXPECT_NEAR(scene.volume->getCut()->getRegion(0).getPlane().w(), -5.5, 1e-3);
        const FloatImage last = renderer.render();
        EXPECT_EQ(renderer.glError(), 0u);
        if (first.width == 0) first = last;
        EXPECT_LT(support::compare(last, first).maximum, 1e-6) << model;
    }
}

TEST(VolumeHandles, AreLeftOutOfFiles)
{
    Probing scene(MIDDLE);
    scene.root->removeChild(scene.volume);
    scene.root->setName("everything");
    scene.root->addChild(new osg::MatrixTransform(osg::Matrixd::translate(1, 2, 3)));
    for (const char* const extension : {".osgt", ".osgb"}) {
        const std::string file =
            std::string(OSGVOLUMIZER_BINARY_DIR) + "/handles_left_out" + extension;
        ASSERT_TRUE(osgDB::writeNodeFile(*scene.root, file));
        const osg::ref_ptr<osg::Node> read = osgDB::readRefNodeFile(file);
        std::remove(file.c_str());
        ASSERT_TRUE(read && read->asGroup());
        EXPECT_EQ(read->getName(), "everything");
        ASSERT_EQ(read->asGroup()->getNumChildren(), 1u) << extension;
        EXPECT_TRUE(read->asGroup()->getChild(0)->asTransform());
    }
}

TEST(VolumeHandles, AreLeftAloneByTheOptimizer)
{
    const osg::ref_ptr<VolumeCut> cut = new VolumeCut;
    ASSERT_TRUE(cut->addRegion(CutRegion::sphere(MIDDLE, 8.0)));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    const auto handles = CutDragger::create(cut, 0, {0, 0, 0, 24, 24, 24});
    root->addChild(*handles);
    const osg::ref_ptr<VolumeAppearance> volume = dense(0.5);
    osg::ref_ptr<ProbeDragger> line = new ProbeDragger(
        &geometryBelow(*volume), volume, osg::Vec3d(-9, 3, 3), osg::Vec3d(-9, 9, 9), 0.5);
    root->addChild(line);
    const osg::BoundingSphere bound = line->getBound();
    osgUtil::Optimizer().optimize(root, osgUtil::Optimizer::ALL_OPTIMIZATIONS);
    osgViewer::Viewer viewer;
    lookWithoutWindow(viewer, root, front());
    // The line is still where it was, and follows.
    ASSERT_TRUE(line->setSegment({-9, 3, 6}, {-9, 9, 12}));
    line->follow();
    EXPECT_LT((line->getBound().center() - bound.center() - osg::Vec3(0, 0, 3)).length(), 1e-3f);
    // The boxes on the x and z axes.
    EXPECT_TRUE(Pointer(viewer).dragFromTo({20, 12, 12}, {22, 12, 12}));
    EXPECT_NEAR(cut->getRegion(0).getRadius(), 10.0, 0.1);
    EXPECT_TRUE(Pointer(viewer).dragFromTo({12, 12, 22}, {12, 12, 20}));
    EXPECT_NEAR(cut->getRegion(0).getRadius(), 8.0, 0.1);
}

// An application may keep a dragger longer than its group.
TEST(VolumeHandles, LeaveTheirDraggersAlone)
{
    osg::ref_ptr<osgManipulator::Dragger> dragger;
    osg::ref_ptr<VolumeCut> cut = new VolumeCut;
    ASSERT_TRUE(cut->addRegion(CutRegion::halfSpace({0, 0, 1, -1})));
    {
        const auto handles = CutDragger::create(cut, 0, {0, 0, 0, 24, 24, 24});
        EXPECT_EQ(handles.value->getNumDraggers(), 1u);
        EXPECT_EQ(handles.value->getDragger(1), nullptr);
        dragger = handles.value->getDragger(0);
        EXPECT_EQ(dragger->getDraggerCallbacks().size(), 1u);
    }
    EXPECT_TRUE(dragger->getDraggerCallbacks().empty());
    translate(*dragger, osg::Vec3d(0, 1, 0));
    EXPECT_EQ(cut->getRegion(0).getPlane(), osg::Vec4d(0, 0, 1, -1));
}

} // namespace VolumeHandlesTest
