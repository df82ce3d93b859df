// Planes, boxes and spheres that cut and crop, dragged by events and by commands.
#include "Drags.h"
#include "PickOracle.h"

#include <osgVolumizer/interact/ClipPlaneDragger.h>
#include <osgVolumizer/interact/CropDragger.h>
#include <osgVolumizer/interact/CutDragger.h>

#include <osg/ClipNode>
#include <osg/MatrixTransform>

#include <support/GLTest.h>
#include <support/Reports.h>

namespace CutDraggerTest {

using namespace osgVolumizer;
using namespace osgVolumizer::test;
using support::FloatImage;
using support::RenderOptions;

namespace {

constexpr int SIZE = 25;
const osg::BoundingBoxd VOLUME(0, 0, 0, 24, 24, 24);
const osg::Vec3d MIDDLE(12, 12, 12);
const osg::Vec4d PLANE(1, 0, 0, -10); // x >= 10

RenderOptions view()
{
    return RenderOptions().size(300, 240).perspective(40.0).lookAt({40, -45, 42}, {12, 12, 12},
                                                                   {0, 0, 1});
}

/// A volume with a cut, its handles beside it, and a viewer without a window.
struct Scene
{
    explicit Scene(const CutRegion& region, double opacity = 0.3)
    {
        static const osg::ref_ptr<Voxels> voxels = makeVoxels(glm::ivec3(SIZE), bumps);
        volume = makeVolume(voxels);
        volume->setLookupTable(makeTable(smoothPoints(opacity)));
        volume->setCut(new VolumeCut);
        EXPECT_TRUE(volume->getCut()->addRegion(region));
        root->addChild(volume);
        auto made = CutDragger::create(volume->getCut(), 0, VOLUME);
        EXPECT_TRUE(made.ok()) << made.status.text;
        handles = *made;
        handles->setHistory(history);
        root->addChild(handles);
        lookWithoutWindow(viewer, root, view());
    }
    const CutRegion& region() const { return volume->getCut()->getRegion(0); }
    osgManipulator::Dragger& dragger() const { return *handles->getDragger(0); }
    FloatImage picture(bool withHandles) const
    {
        handles->setNodeMask(withHandles ? ~0u : 0u);
        const FloatImage image = support::renderScene(root, view());
        handles->setNodeMask(~0u);
        return image;
    }

    osg::ref_ptr<osg::Group> root = new osg::Group;
    osg::ref_ptr<VolumeAppearance> volume;
    osg::ref_ptr<CutDragger> handles;
    osg::ref_ptr<DragHistory> history = new DragHistory;
    osgViewer::Viewer viewer;
};

// The side of a plane's square, along whose middle its arrow goes.
const double SQUARE = 24.0;

void expectNear(const osg::Vec3d& a, const osg::Vec3d& b, double tolerance)
{
    EXPECT_LT((a - b).length(), tolerance) << a.x() << " " << a.y() << " " << a.z() << ", expected "
                                           << b.x() << " " << b.y() << " " << b.z();
}

class CutDraggerPictures : public support::GLTest
{
};

} // namespace

TEST(CutDraggers, APlaneMovesAsFarAsItsArrow)
{
    Scene scene(CutRegion::halfSpace(PLANE));
    Pointer pointer(scene.viewer);
    const osg::Vec3d tip(10 + 0.4 * SQUARE, 12, 12);
    EXPECT_TRUE(pointer.press(tip));
    EXPECT_TRUE(scene.handles->isDragged());
    pointer.drag(tip + osg::Vec3d(1, 0, 0));
    EXPECT_NEAR(scene.region().getPlane().w(), -11.0, 1e-3);
    pointer.drag(tip + osg::Vec3d(3, 0, 0));
    pointer.release(tip + osg::Vec3d(3, 0, 0));
    EXPECT_FALSE(scene.handles->isDragged());
    expectNear({scene.region().getPlane().x(), scene.region().getPlane().y(),
                scene.region().getPlane().z()},
               {1, 0, 0}, 1e-12);
    EXPECT_NEAR(scene.region().getPlane().w(), -13.0, 1e-3);
    EXPECT_EQ(scene.history->getUndoCount(), 1u);
    // Nothing is there any more, nor beside it.
    EXPECT_FALSE(pointer.press({-8, 2, 2}));
    // By a command it is exact.
    translate(scene.dragger(), osg::Vec3d(0, -3.0 / SQUARE, 0)); // its own frame: along y
    EXPECT_NEAR(scene.region().getPlane().w(), -10.0, 1e-3);
    scene.volume->getCut()->setRegion(0, CutRegion::halfSpace(PLANE));
    scene.handles->follow();
    translate(scene.dragger(), osg::Vec3d(0, 3.0 / SQUARE, 0));
    EXPECT_NEAR(scene.region().getPlane().w(), -13.0, 1e-12);
}

TEST(CutDraggers, UndoAndRedoRestoreExactly)
{
    const osg::Vec4d skew(0.3, -0.2, 0.9, -7.123); // not of length 1
    Scene scene(CutRegion::halfSpace(skew).complement());
    Pointer pointer(scene.viewer);
    for (const double shift : {0.1, -0.2, 0.05})
        translate(scene.dragger(), osg::Vec3d(0, shift, 0));
    EXPECT_TRUE(scene.region().isComplement());
    const osg::Vec4d last = scene.region().getPlane();
    EXPECT_EQ(scene.history->getUndoCount(), 3u);
    while (scene.history->undo()) {
    }
    EXPECT_EQ(scene.region().getPlane(), skew);
    EXPECT_TRUE(scene.region().isComplement());
    EXPECT_FALSE(scene.history->undo());
    while (scene.history->redo()) {
    }
    EXPECT_EQ(scene.region().getPlane(), last);
    EXPECT_FALSE(scene.history->redo());
    // What was undone is forgotten by the next step; a press that moves nothing is none.
    scene.history->undo();
    translate(scene.dragger(), osg::Vec3d());
    EXPECT_EQ(scene.history->getUndoCount(), 3u);
    EXPECT_EQ(scene.history->getRedoCount(), 0u);
    scene.history->setMaximumSteps(2);
    EXPECT_EQ(scene.history->getUndoCount(), 2u);
    scene.history->clear();
    EXPECT_FALSE(scene.history->undo());
}

TEST(CutDraggers, HandlesFollowWhoeverChangesTheCut)
{
    Scene scene(CutRegion::halfSpace(PLANE));
    Pointer pointer(scene.viewer);
    ASSERT_TRUE(scene.volume->getCut()->setRegion(0, CutRegion::halfSpace({0, 0, 2, -8})));
    scene.viewer.advance();
    scene.viewer.updateTraversal();
    // z >= 4, shown below the middle.
    expectNear(scene.dragger().getMatrix().getTrans(), {12, 12, 4}, 1e-12);
    EXPECT_TRUE(pointer.dragFromTo({12, 12, 4 + 0.4 * SQUARE}, {12, 12, 2 + 0.4 * SQUARE}));
    EXPECT_NEAR(scene.region().getPlane().w(), -2.0, 1e-3);
    // Of another kind, or gone: no handles, and nothing to drag.
    ASSERT_TRUE(scene.volume->getCut()->setRegion(0, CutRegion::sphere(MIDDLE, 9.0)));
    scene.handles->follow();
    EXPECT_EQ(scene.dragger().getNodeMask(), 0u);
    scene.volume->getCut()->clear();
    translate(scene.dragger(), osg::Vec3d(0, 0.1, 0));
    EXPECT_EQ(scene.volume->getCut()->getNumRegions(), 0u);
    ASSERT_TRUE(scene.volume->getCut()->addRegion(CutRegion::halfSpace(PLANE)));
    scene.handles->follow();
    EXPECT_NE(scene.dragger().getNodeMask(), 0u);
    expectNear(scene.dragger().getMatrix().getTrans(), {10, 12, 2}, 1e-2);
}

TEST(CutDraggers, ASphereMovesAndGrows)
{
    Scene scene(CutRegion::sphere(MIDDLE, 8.0));
    Pointer pointer(scene.viewer);
    // The box where the y axis leaves it, towards the eye and away: which is at +y.
    const osg::Vec3d handle(12, 20, 12);
    EXPECT_TRUE(pointer.dragFromTo(handle, handle + osg::Vec3d(0, 2, 0)));
    EXPECT_NEAR(scene.region().getRadius(), 10.0, 0.1); // where on the box it was taken
    expectNear(scene.region().getCenter(), MIDDLE, 1e-9);
    const osg::Matrixd m = scene.dragger().getMatrix();
    EXPECT_EQ(m(0, 0), m(1, 1));
    EXPECT_EQ(m(0, 0), m(2, 2));
    // And smaller, by a command along z.
    scene.volume->getCut()->setRegion(0, CutRegion::sphere(MIDDLE, 8.0));
    scene.handles->follow();
    osg::ref_ptr<osgManipulator::Scale1DCommand> shrink = new osgManipulator::Scale1DCommand;
    shrink->setScale(0.25);
    command(scene.dragger(), *shrink);
    EXPECT_NEAR(scene.region().getRadius(), 2.0, 1e-12);
    translate(scene.dragger(), osg::Vec3d(0.25, 0.5, 0)); // diameters
    expectNear(scene.region().getCenter(), {13, 14, 12}, 1e-12);
    EXPECT_NEAR(scene.region().getRadius(), 2.0, 1e-12);
    EXPECT_EQ(scene.history->getUndoCount(), 3u);
    while (scene.history->undo()) {
    }
    EXPECT_EQ(scene.region().getCenter(), MIDDLE);
    EXPECT_EQ(scene.region().getRadius(), 8.0);
}

TEST(CutDraggers, ABoxMovesAndGrows)
{
    const osg::BoundingBoxd box(6, 5, 7, 18, 19, 17);
    Scene scene(CutRegion::box(box));
    // Half as long along x, about its low end.
    osg::ref_ptr<osgManipulator::Scale1DCommand> scale = new osgManipulator::Scale1DCommand;
    scale->setScale(0.5);
    scale->setScaleCenter(-0.5);
    command(scene.dragger(), *scale);
    expectNear(scene.region().getBox()._min, box._min, 1e-12);
    expectNear(scene.region().getBox()._max, osg::Vec3d(12, 19, 17), 1e-12);
}

TEST(CutDraggers, ModifierKeysActivate)
{
    Scene scene(CutRegion::halfSpace(PLANE));
    Pointer pointer(scene.viewer);
    const osg::Vec3d tip(10 + 0.4 * SQUARE, 12, 12);
    scene.dragger().setActivationModKeyMask(osgGA::GUIEventAdapter::MODKEY_CTRL);
    EXPECT_FALSE(pointer.dragFromTo(tip, tip + osg::Vec3d(3, 0, 0)));
    EXPECT_EQ(scene.region().getPlane(), PLANE);
    EXPECT_TRUE(pointer.press(tip, osgGA::GUIEventAdapter::MODKEY_LEFT_CTRL));
    pointer.drag(tip + osg::Vec3d(3, 0, 0));
    pointer.release(tip + osg::Vec3d(3, 0, 0));
    EXPECT_NEAR(scene.region().getPlane().w(), -13.0, 1e-3);
}

// Of two groups that the pointer hits the nearer one is dragged, whatever their order.
TEST(CutDraggers, TheNearestHandleIsTaken)
{
    for (const bool first : {true, false}) {
        Scene scene(CutRegion::halfSpace({0, 1, 0, -12}));
        ASSERT_TRUE(scene.volume->getCut()->addRegion(CutRegion::halfSpace({0, 1, 0, -2})));
        const osg::ref_ptr<CutDragger> other =
            *CutDragger::create(scene.volume->getCut(), 1, VOLUME);
        scene.root->insertChild(first ? 0 : 2, other);
        // Seen along the arrows.
        scene.viewer.getCamera()->setViewMatrixAsLookAt({12.2, -60, 12}, {12.2, 12, 12}, {0, 0, 1});
        Pointer pointer(scene.viewer);
        EXPECT_TRUE(pointer.press({12.2, -5, 12.1}));
        EXPECT_TRUE(other->isDragged());
        EXPECT_FALSE(scene.handles->isDragged());
        EXPECT_TRUE(pointer.release({12.2, -5, 12.1}));
    }
}

TEST(CutDraggers, RefuseWhatTheyCannotCutBy)
{
    const support::Reports reports;
    const osg::ref_ptr<VolumeCut> cut = new VolumeCut;
    EXPECT_EQ(CutDragger::create(cut, 0, VOLUME).status.code, ErrorCode::INDEX_OUT_OF_RANGE);
    ASSERT_TRUE(cut->addRegion(CutRegion::mask(makeVoxels(glm::ivec3(4), bumps), 0.5)));
    EXPECT_EQ(CutDragger::create(cut, 0, VOLUME).status.code, ErrorCode::NOT_SUPPORTED);
    EXPECT_EQ(reports.all(), 0u);
    Scene scene(CutRegion::sphere(MIDDLE, 8.0));
    EXPECT_EQ(scene.handles->setThroughOpacity(1.5).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(scene.handles->setThroughOpacity(NAN).code, ErrorCode::VALUE_INVALID);
    EXPECT_EQ(scene.handles->getThroughOpacity(), 0.35);
    // A sphere without a radius: refused, reported, and the handle is back.
    osg::ref_ptr<osgManipulator::Scale1DCommand> away = new osgManipulator::Scale1DCommand;
    away->setScale(INFINITY);
    command(scene.dragger(), *away);
    EXPECT_EQ(scene.region().getRadius(), 8.0);
    EXPECT_EQ(scene.history->getUndoCount(), 0u);
    EXPECT_EQ(scene.dragger().getMatrix()(0, 0), 16.0);
    EXPECT_EQ(reports.count("radius"), 1);
}

TEST(CutDraggers, WorkBelowTransformsAndFarAway)
{
    // Turned, mirrored, and at 6400 km.
    const osg::Matrixd place = osg::Matrixd::scale(2, -2, 2) *
                               osg::Matrixd::rotate(0.7, osg::Vec3d(1, 2, 3)) *
                               osg::Matrixd::translate(6.4e6, -3.2e6, 1.6e6);
    Scene scene(CutRegion::halfSpace(PLANE));
    osg::ref_ptr<osg::MatrixTransform> transform = new osg::MatrixTransform(place);
    transform->addChild(scene.root);
    scene.viewer.setSceneData(transform);
    scene.viewer.getCamera()->setViewMatrixAsLookAt(MIDDLE * place + osg::Vec3d(90, -60, 80),
                                                    MIDDLE * place, {0, 0, 1});
    Pointer pointer(scene.viewer);
    const osg::Vec3d tip(10 + 0.4 * SQUARE, 12, 12), to = tip + osg::Vec3d(3, 0, 0);
    EXPECT_TRUE(pointer.dragFromTo(tip * place, to * place));
    EXPECT_NEAR(scene.region().getPlane().w(), -13.0, 1e-2);
    EXPECT_NEAR(scene.region().getPlane().x(), 1.0, 1e-6);
}

TEST(CropDraggers, CropAndUndo)
{
    const osg::ref_ptr<VolumeAppearance> volume = makeVolume(makeVoxels(glm::ivec3(SIZE), bumps));
    VolumeGeometry& geometry = geometryBelow(*volume);
    ASSERT_TRUE(geometry.setBox(VOLUME, VolumeGeometry::TWENTY_FOUR));
    const std::vector<double> before = geometry.getTetraSet()->vertices.values();
    osg::ref_ptr<CropDragger> crop = new CropDragger(&geometry);
    const osg::ref_ptr<DragHistory> history = new DragHistory;
    crop->setHistory(history);
    volume->addChild(crop);
    osg::ref_ptr<osgManipulator::Scale1DCommand> scale = new osgManipulator::Scale1DCommand;
    scale->setScale(0.75);
    scale->setScaleCenter(0.5);
    command(*crop->getDragger(0), *scale);
    core::Box3d box = geometry.getTetraSet()->bounds();
    EXPECT_NEAR(box.min.x, 6.0, 1e-12);
    EXPECT_NEAR(box.max.x, 24.0, 1e-12);
    EXPECT_NEAR(box.max.y, 24.0, 1e-12);
    EXPECT_EQ(geometry.getTetraSet()->tetraCount(), 5u);
    EXPECT_TRUE(history->undo());
    EXPECT_EQ(geometry.getTetraSet()->vertices.values(), before);
    EXPECT_EQ(geometry.getTetraSet()->tetraCount(), 24u);
    crop->follow();
    EXPECT_NEAR(crop->getDragger(0)->getMatrix()(0, 0), 24.0, 1e-12);
    EXPECT_TRUE(history->redo());
    EXPECT_NEAR(geometry.getTetraSet()->bounds().min.x, 6.0, 1e-12);
    // Another program crops: the handles follow.
    ASSERT_TRUE(geometry.setBox({1, 2, 3, 4, 6, 8}));
    crop->follow();
    expectNear(crop->getDragger(0)->getMatrix().getTrans(), {2.5, 4.0, 5.5}, 1e-12);
}

TEST(ClipPlaneDraggers, MoveThePlane)
{
    osg::ref_ptr<osg::ClipNode> clip = new osg::ClipNode;
    clip->addClipPlane(new osg::ClipPlane(1, PLANE));
    osg::ref_ptr<ClipPlaneDragger> handles = new ClipPlaneDragger(clip->getClipPlane(0), VOLUME);
    const osg::ref_ptr<DragHistory> history = new DragHistory;
    handles->setHistory(history);
    clip->addChild(handles);
    translate(*handles->getDragger(0), osg::Vec3d(0, 3.0 / SQUARE, 0));
    EXPECT_NEAR(clip->getClipPlane(0)->getClipPlane().w(), -13.0, 1e-12);
    // About its middle by a quarter turn.
    osg::ref_ptr<osgManipulator::Rotate3DCommand> turn = new osgManipulator::Rotate3DCommand;
    turn->setRotation(osg::Quat(osg::PI_2, osg::Vec3d(1, 0, 0)));
    command(*handles->getDragger(0), *turn);
    const osg::Vec4d turned = clip->getClipPlane(0)->getClipPlane();
    EXPECT_NEAR(std::fabs(turned.z()) + std::fabs(turned.y()), 1.0, 1e-9);
    EXPECT_NEAR(osg::Plane(turned).distance(osg::Vec3d(13, 12, 12)), 0.0, 1e-9);
    history->undo();
    history->undo();
    EXPECT_EQ(clip->getClipPlane(0)->getClipPlane(), PLANE);
}

// What is dragged is what is drawn.
TEST_F(CutDraggerPictures, APlaneCutsThreeUnitsFurther)
{
    Scene scene(CutRegion::halfSpace(PLANE)), expected(CutRegion::halfSpace({1, 0, 0, -13}));
    const FloatImage before = scene.picture(false);
    const osg::Vec3d tip(10 + 0.4 * SQUARE, 12, 12);
    ASSERT_TRUE(Pointer(scene.viewer).dragFromTo(tip, tip + osg::Vec3d(3, 0, 0)));
    const FloatImage after = scene.picture(false), truth = expected.picture(false);
    EXPECT_LT(support::compare(after, truth).rmse, 1e-3);
    EXPECT_GT(support::compare(after, before).rmse, 2e-2);
    ASSERT_TRUE(scene.history->undo());
    EXPECT_EQ(support::compare(scene.picture(false), before).maximum, 0.0);
}

// Tabs have a size in pixels, from the frame before.
TEST_F(CutDraggerPictures, ABoxIsDraggedByFacesAndTabs)
{
    const osg::BoundingBoxd box(6, 5, 7, 18, 19, 17);
    Scene scene(CutRegion::box(box));
    scene.viewer.setSceneData(nullptr);
    support::SceneRenderer renderer(scene.root, view());
    ASSERT_TRUE(renderer.status().ok());
    renderer.render();
    renderer.render();
    Pointer pointer(renderer.viewer());
    // A face slides in its plane, and the box with it: the top, here.
    EXPECT_TRUE(pointer.dragFromTo({12, 12, 17}, {14, 11, 17}));
    expectNear(scene.region().getBox()._min, osg::Vec3d(8, 4, 7), 1e-3);
    expectNear(scene.region().getBox()._max, osg::Vec3d(20, 18, 17), 1e-3);
    EXPECT_TRUE(scene.history->undo());
    EXPECT_EQ(scene.region().getBox()._max, box._max);
    renderer.render();
    // The tab in the middle of an edge of it moves the side there, and no other.
    EXPECT_TRUE(pointer.dragFromTo({17.9, 12, 17}, {19.9, 12, 17}));
    expectNear(scene.region().getBox()._min, box._min, 1e-9);
    expectNear(scene.region().getBox()._max, osg::Vec3d(20, 19, 17), 0.05);
    renderer.render();
    // And that in a corner two.
    const osg::Vec3d corner = scene.region().getBox()._max - osg::Vec3d(0.1, 0.1, 0);
    EXPECT_TRUE(pointer.dragFromTo(corner, corner - osg::Vec3d(3, 2, 0)));
    expectNear(scene.region().getBox()._max, osg::Vec3d(17, 17, 17), 0.1);
    expectNear(scene.region().getBox()._min, box._min, 1e-9);
    EXPECT_EQ(scene.history->getUndoCount(), 2u);
}

TEST_F(CutDraggerPictures, LookAsTheyShould)
{
    const std::pair<const char*, CutRegion> regions[] = {
        {"handles_plane", CutRegion::halfSpace({0.9, -0.2, 0.3, -10})},
        {"handles_box", CutRegion::box({6, 5, 7, 18, 19, 17})},
        {"handles_sphere", CutRegion::sphere(MIDDLE, 9.0)}};
    for (const auto& [name, region] : regions) {
        Scene scene(region);
        RenderOptions options = view().size(400, 320).perspective(28.0);
        options.frames = 2; // the tabs' size is that of the frame before
        const FloatImage picture = support::renderScene(scene.root, options);
        support::savePicture(picture, name);
        scene.handles->setNodeMask(0);
        EXPECT_GT(support::compare(picture, support::renderScene(scene.root, options)).rmse, 0.01)
            << name;
    }
}

} // namespace CutDraggerTest
