// Strokes under the mouse, and the README's sample of sculpting: as it stands there, and that it
// does what it says.
#include "PickOracle.h"

#include <osgVolumizer/interact/SculptHandler.h>

#include <osg/MatrixTransform>
#include <osgViewer/Viewer>

#include <fstream>
#include <iterator>

namespace SculptHandlerTest {

using namespace osgVolumizer::test;
using osgVolumizer::SculptHandler;
using osgVolumizer::Sculptor;
using osgVolumizer::VolumeAppearance;
using osgVolumizer::Voxels;
using Event = osgGA::GUIEventAdapter;

namespace {

// clang-format off
bool sculpt(VolumeAppearance* head, const osg::Vec3d& from, const osg::Vec3d& to)
{
osgVolumizer::Sculptor sculptor(head->getVoxels());
osgVolumizer::Sculptor::Tool tool;
tool.operation = osgVolumizer::Sculptor::Operation::PERLIN_SUB;
tool.radius = osg::Vec3d(8.0, 8.0, 8.0);                         // voxels; or tool.unit = Sculptor::OBJECT
tool.strength = 0.5;
sculptor.setTool(tool);
if (!sculptor.stroke({from, to}).ok()) return false;              // points in the object frame
return sculptor.undo().ok() && sculptor.redo().ok();
} // end
// clang-format on

std::string textOf(const std::string& file)
{
    std::ifstream stream(OSGVOLUMIZER_SOURCE_DIR "/" + file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

float valueAt(const Voxels& voxels, const glm::ivec3& p)
{
    float value = -1.0f;
    EXPECT_TRUE(voxels.getSource()->read({p, p + 1}, &value).ok());
    return value;
}

TEST(ReadmeSculptSample, IsThisOne)
{
    const std::string own = textOf("tests/interact/SculptHandlerTest.cpp");
    const std::size_t begin = own.find("osgVolumizer::Sculptor sculptor(head"),
                      end = own.find("} // end");
    ASSERT_LT(begin, end);
    EXPECT_NE(textOf("README.md").find(own.substr(begin, end - begin)), std::string::npos);
}

TEST(ReadmeSculptSample, TakesAway)
{
    const auto voxels = makeBlob(glm::ivec3(32), 6.0);
    const float before = valueAt(*voxels, {16, 15, 15});
    ASSERT_TRUE(sculpt(makeVolume(voxels), {5, 15, 15}, {25, 15, 15}));
    EXPECT_LT(valueAt(*voxels, {16, 15, 15}), 0.3f * before);
    EXPECT_EQ(valueAt(*voxels, {1, 1, 1}), valueAt(*makeBlob(glm::ivec3(32), 6.0), {1, 1, 1}));
}

// A viewer that looks along y at the middle of a ball, which is moved and turned.
class Handler : public ::testing::Test
{
protected:
    void SetUp() override
    {
        _voxels = makeBlob(glm::ivec3(64), 12.0);
        _volume = makeVolume(_voxels);
        _volume->setLookupTable(makeTable({{0.5, {1, 1, 1, 0.0}}, {0.6, {1, 1, 1, 0.95}}}));
        osg::ref_ptr<osg::MatrixTransform> moved =
            new osg::MatrixTransform(osg::Matrixd::translate(-31.5, -31.5, -31.5) *
                                     osg::Matrixd::rotate(osg::PI_2, osg::Vec3d(0, 0, 1)) *
                                     osg::Matrixd::translate(1000.0, 0.0, 0.0));
        moved->addChild(_volume);
        _viewer.setSceneData(moved);
        _viewer.getCamera()->setViewport(0, 0, 200, 200);
        _viewer.getCamera()->setProjectionMatrixAsOrtho(-32, 32, -32, 32, 10, 300);
        _viewer.getCamera()->setViewMatrixAsLookAt({1000, -100, 0}, {1000, 0, 0}, {0, 0, 1});
        _handler = new SculptHandler(_voxels);
        Sculptor::Tool tool;
        tool.operation = Sculptor::Operation::ERASE;
        tool.radius = osg::Vec3d(4, 4, 4);
        ASSERT_TRUE(_handler->getSculptor().setTool(tool).ok());
    }
    // At world x and z from the middle.
    bool send(Event::EventType type, double x, double z, int modifiers = Event::MODKEY_LEFT_SHIFT)
    {
        osg::ref_ptr<Event> event = new Event;
        event->setEventType(type);
        event->setButton(Event::LEFT_MOUSE_BUTTON);
        event->setModKeyMask(modifiers);
        event->setInputRange(-32, -32, 32, 32);
        event->setX(float(x));
        event->setY(float(z));
        return _handler->handle(*event, _viewer);
    }
    bool press(int key, int modifiers)
    {
        osg::ref_ptr<Event> event = new Event;
        event->setEventType(Event::KEYDOWN);
        event->setKey(key);
        event->setUnmodifiedKey(key);
        event->setModKeyMask(modifiers);
        return _handler->handle(*event, _viewer);
    }

    osg::ref_ptr<Voxels> _voxels;
    osg::ref_ptr<VolumeAppearance> _volume;
    osgViewer::Viewer _viewer;
    osg::ref_ptr<SculptHandler> _handler;
};

TEST_F(Handler, DrawsAStrokeOnWhatIsSeen)
{
    // World -y is the volume's -x: the nearest point of the surface is at x = 31.5 - 14 or so.
    const auto hit = pickLine(*_volume, {{-50, 31.5, 31.5}, {100, 31.5, 31.5}});
    ASSERT_TRUE(hit);
    const glm::ivec3 surface(hit->point.x() + 0.5, 31, 31);
    const float before = valueAt(*_voxels, surface);
    EXPECT_FALSE(send(Event::PUSH, 0, 0, 0)); // without the key
    EXPECT_FALSE(send(Event::DRAG, 0, 0));
    EXPECT_EQ(valueAt(*_voxels, surface), before);
    EXPECT_TRUE(send(Event::PUSH, 0, 0));
    EXPECT_EQ(valueAt(*_voxels, surface), 0.0f);
    EXPECT_TRUE(send(Event::DRAG, 3, 6));
    EXPECT_TRUE(send(Event::DRAG, 31, 31)); // nothing there
    EXPECT_TRUE(send(Event::RELEASE, 31, 31));
    EXPECT_FALSE(send(Event::DRAG, 0, 0));
    const auto deeper = pickLine(*_volume, {{-50, 31.5, 31.5}, {100, 31.5, 31.5}});
    ASSERT_TRUE(deeper);
    EXPECT_GT(deeper->point.x(), hit->point.x() + 2.0);

    EXPECT_FALSE(press('z', 0));
    EXPECT_TRUE(press('z', Event::MODKEY_LEFT_CTRL));
    EXPECT_EQ(valueAt(*_voxels, surface), before);
    EXPECT_FALSE(press('z', Event::MODKEY_LEFT_CTRL)); // one stroke it was
    EXPECT_TRUE(press('y', Event::MODKEY_LEFT_CTRL));
    EXPECT_EQ(valueAt(*_voxels, surface), 0.0f);
}

TEST_F(Handler, LeavesOthersAlone)
{
    const float middle = valueAt(*_voxels, {20, 31, 31});
    EXPECT_FALSE(send(Event::PUSH, 31, 31)); // beside the volume
    const auto other = makeBlob(glm::ivec3(64), 12.0);
    _volume->setVoxels(other);
    EXPECT_FALSE(send(Event::PUSH, 0, 0));
    EXPECT_EQ(valueAt(*_voxels, {20, 31, 31}), middle);
    EXPECT_FALSE(_handler->getSculptor().canUndo());
    _handler = new SculptHandler(nullptr);
    EXPECT_FALSE(send(Event::PUSH, 0, 0));
}

} // namespace
} // namespace SculptHandlerTest
