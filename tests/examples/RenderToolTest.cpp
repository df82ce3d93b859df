#include "RunProgram.h"

#include <oracles/ClosedForms.h>
#include <support/GLTest.h>
#include <support/PictureFile.h>
#include <support/Shapes.h>

#include <osgVolumizer/AppearanceProperties.h>
#include <osgVolumizer/ReadVolume.h>
#include <osgVolumizer/VolumeGeometry.h>

#include <osg/Texture2D>
#include <osgDB/WriteFile>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

namespace RenderToolTest {

using namespace osgVolumizer::support;

namespace {

Outcome runTool(const std::string& arguments)
{
    return runProgram("osgvolumizerrender", arguments);
}

class RenderToolGLTest : public GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        folder = std::filesystem::path(testing::TempDir()) /
                 testing::UnitTest::GetInstance()->current_test_info()->name();
        std::filesystem::create_directories(folder);
    }
    std::string file(const std::string& name) const { return (folder / name).string(); }

    /// The square |x|, |z| <= 1 in the plane y = 0, unlit, in its own colour.
    std::string writeSquare(const osg::Vec4& color) const
    {
        osg::ref_ptr<osg::Geometry> square =
            makeQuad({osg::Vec3(-1, 0, -1), {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}}, color);
        square->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
        const std::string name = file("square.osgb");
        EXPECT_TRUE(osgDB::writeNodeFile(*square, name));
        return name;
    }

    std::filesystem::path folder;
};

std::string readText(const std::string& name)
{
    std::ostringstream text;
    text << std::ifstream(name).rdbuf();
    return text.str();
}

// The view of a square from the front, two units high.
const std::string frontal = " --size 16 8 --eye 0 -5 0 --center 0 0 0 --ortho 2 ";

// A square that faces the front, its lower left corner at (x, z).
osg::ref_ptr<osg::Geometry> squareAt(float x, float z, float size, const osg::Vec4& color)
{
    return makeQuad(
        {osg::Vec3(x, 0, z), {x + size, 0, z}, {x + size, 0, z + size}, {x, 0, z + size}}, color);
}

osg::ref_ptr<osg::Camera> cameraOf(osg::Camera::RenderOrder order, osg::Node* child)
{
    osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    camera->setRenderOrder(order);
    camera->setClearMask(GL_DEPTH_BUFFER_BIT);
    camera->addChild(child);
    return camera;
}

// Left a texture that is drawn to first: blue, and red in a quarter. Right a head-up display,
// green, above what a nested camera shows, yellow.
osg::ref_ptr<osg::Group> sceneWithCameras()
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D;
    texture->setTextureSize(16, 16);
    texture->setInternalFormat(GL_RGBA);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    const osg::ref_ptr<osg::Camera> drawn =
        cameraOf(osg::Camera::PRE_RENDER, squareAt(-2, -2, 2, osg::Vec4(1, 0, 0, 1)));
    drawn->setClearMask(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    drawn->setClearColor(osg::Vec4(0, 0, 1, 1));
    drawn->setRenderTargetImplementation(osg::Camera::FRAME_BUFFER_OBJECT);
    drawn->setViewport(0, 0, 16, 16);
    drawn->attach(osg::Camera::COLOR_BUFFER, texture);
    const osg::ref_ptr<osg::Geometry> screen =
        osg::createTexturedQuadGeometry({-2, 0, -1}, {2, 0, 0}, {0, 0, 2});
    screen->getOrCreateStateSet()->setTextureAttributeAndModes(0, texture);
    osg::ref_ptr<osg::Group> scene = new osg::Group;
    scene->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    scene->addChild(drawn);
    scene->addChild(screen);
    scene->addChild(cameraOf(osg::Camera::POST_RENDER, squareAt(1, 0, 1, osg::Vec4(0, 1, 0, 1))));
    scene->addChild(
        cameraOf(osg::Camera::NESTED_RENDER, squareAt(1, -1, 1, osg::Vec4(1, 1, 0, 1))));
    return scene;
}

} // namespace

TEST_F(RenderToolGLTest, WritesFloatsAsTheyAre)
{
    const std::string scene = writeSquare(osg::Vec4(0.1f, 0.2f, 1e-5f, 1.0f));
    const Outcome outcome =
        runTool(scene + frontal + "--background 2.5 -1 0 0.25 --output " + file("picture.exr"));
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    const auto image = readFloatPicture(file("picture.exr"));
    ASSERT_TRUE(image.ok()) << image.status.text;
    ASSERT_EQ(image->width, 16);
    ASSERT_EQ(image->height, 8);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) {
            const bool inside = x >= 6 && x < 10 && y >= 2 && y < 6;
            EXPECT_EQ(image->at(x, y), inside ? glm::vec4(0.1f, 0.2f, 1e-5f, 1.0f)
                                              : glm::vec4(2.5f, -1.0f, 0.0f, 0.25f));
        }
}

TEST_F(RenderToolGLTest, WritesStraightBytesForPeople)
{
    const std::string scene = writeSquare(osg::Vec4(0.4f, 0.2f, 0.0f, 1.0f));
    const Outcome outcome =
        runTool(scene + frontal + "--background 0.1 0.2 0 0.2 --output " + file("picture.png"));
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    const auto image = readFloatPicture(file("picture.png"));
    ASSERT_TRUE(image.ok()) << image.status.text;
    EXPECT_NEAR(image->at(8, 4).r, 102.0f / 255.0f, 1e-6f);
    EXPECT_NEAR(image->at(8, 4).g, 51.0f / 255.0f, 1e-6f);
    EXPECT_EQ(image->at(8, 4).a, 1.0f);
    // Readers give premultiplied values; the file has (0.5, 1, 0) at alpha 51/255.
    EXPECT_NEAR(image->at(0, 0).g, 0.2f, 1e-6f);
    EXPECT_NEAR(image->at(0, 0).a, 0.2f, 1e-6f);
}

TEST_F(RenderToolGLTest, WritesStatistics)
{
    const std::string scene = writeSquare(osg::Vec4(1, 1, 1, 1));
    const Outcome outcome = runTool(scene + frontal + "--frames 5 --stats " + file("stats.json"));
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    const std::string text = readText(file("stats.json"));
    EXPECT_TRUE(std::regex_search(text, std::regex("\"frames\": 5,"))) << text;
    EXPECT_TRUE(std::regex_search(text, std::regex("\"milliseconds\": [0-9.e-]+,"))) << text;
    EXPECT_TRUE(std::regex_search(
        text, std::regex("\"millisecondsPerFrame\": \\[([0-9.e-]+, ){4}[0-9.e-]+\\]")))
        << text;
    EXPECT_NE(text.find("\"counters\": {"), std::string::npos) << text;
}

TEST_F(RenderToolGLTest, SaysWhichDeviceDrew)
{
    const std::string scene = writeSquare(osg::Vec4(0.5f, 1, 1, 1)) + frontal;
    const auto statistics = [&](const std::string& options) {
        const Outcome outcome = runTool(scene + options + " --stats " + file("stats.json") +
                                        " --output " + file("picture.exr"));
        EXPECT_EQ(outcome.code, 0) << outcome.text;
        return readText(file("stats.json"));
    };
    const std::regex any("\"device\": \\{\\s*\"renderer\": \"([^\"]+)\",\\s*\"platform\": "
                         "\"EGL_[A-Za-z_]+\",\\s*\"number\": (null|[0-9]+)\\s*\\}");
    EXPECT_TRUE(std::regex_search(statistics(""), any)) << readText(file("stats.json"));

    // The list has a line for each device, with what draws or why nothing does.
    const Outcome list = runTool("--device list");
    EXPECT_EQ(list.code, 0) << list.text;
    std::istringstream lines(list.text);
    std::string line;
    for (int i = 0; std::getline(lines, line); ++i) {
        const std::string number = std::to_string(i);
        ASSERT_EQ(line.compare(0, number.size() + 2, number + "  "), 0) << line;
        if (!OffscreenDisplay::open(i).ok()) continue;
        std::smatch match;
        const std::string text = statistics("--device " + number);
        ASSERT_TRUE(std::regex_search(text, match, any)) << text;
        EXPECT_EQ(match[1], line.substr(number.size() + 2));
        EXPECT_EQ(match[2], number);
        EXPECT_NE(text.find("\"EGL_EXT_platform_device\""), std::string::npos) << text;
        const auto image = readFloatPicture(file("picture.exr"));
        EXPECT_TRUE(image.ok() && image->at(8, 4) == glm::vec4(0.5f, 1, 1, 1));
    }
    const auto count = std::count(list.text.begin(), list.text.end(), '\n');
    EXPECT_EQ(count, OffscreenDisplay::deviceCount());
    EXPECT_GT(count, 0);
}

TEST_F(RenderToolGLTest, ScenesHaveCamerasOfTheirOwn)
{
    const osg::ref_ptr<osg::Group> scene = sceneWithCameras();
    for (const char* type : {"osgt", "osgb", "osgx"}) {
        const std::string name = file(std::string("cameras.") + type);
        ASSERT_TRUE(osgDB::writeNodeFile(*scene, name));
        const Outcome outcome = runTool(name + frontal + "--output " + file("picture.exr"));
        EXPECT_EQ(outcome.code, 0);
        EXPECT_EQ(outcome.text, "");
        const auto image = readFloatPicture(file("picture.exr"));
        ASSERT_TRUE(image.ok()) << image.status.text;
        EXPECT_EQ(image->at(14, 1), glm::vec4(0.0f)) << type;
        EXPECT_EQ(image->at(7, 5), glm::vec4(0, 0, 1, 1)) << type;
        EXPECT_EQ(image->at(5, 3), glm::vec4(1, 0, 0, 1)) << type;
        EXPECT_EQ(image->at(11, 5), glm::vec4(0, 1, 0, 1)) << type;
        EXPECT_EQ(image->at(11, 3), glm::vec4(1, 1, 0, 1)) << type;
    }
}

TEST_F(RenderToolGLTest, RendersVolumesAsAsked)
{
    // A cube of one colour, 8 units wide, in a scene file.
    osgVolumizer::VoxelSource::Description d;
    d.size = glm::ivec3(9);
    d.origin = glm::dvec3(-4.0);
    osg::ref_ptr<osgVolumizer::MemoryVoxelSource> source = new osgVolumizer::MemoryVoxelSource;
    ASSERT_TRUE(source->allocate(d).ok());
    osg::ref_ptr<osgVolumizer::VolumeAppearance> volume = new osgVolumizer::VolumeAppearance;
    volume->setVoxels(new osgVolumizer::Voxels(source.get()));
    const glm::dvec4 color(0.8, 0.4, 0.2, 0.1);
    ASSERT_TRUE(volume->getLookupTable()
                    ->setPoints({{0.0, color}}, osgVolumizer::LookupTable::RANGE_FRACTION)
                    .ok());
    volume->addChild(osgVolumizer::VolumeGeometry::createBox(*volume->getVoxels()));
    const std::string scene = file("cube.osgt");
    ASSERT_TRUE(osgDB::writeNodeFile(*volume, scene));

    const glm::dvec4 expected = osgVolumizer::oracle::constantSegment(color, 8.0);
    const auto faces = [&](const std::string& options) {
        const Outcome outcome =
            runTool(scene + " --size 16 16 --eye 0 -20 0 --ortho 5 " + options + " --output " +
                    file("cube.exr") + " --stats " + file("cube.json"));
        EXPECT_EQ(outcome.code, 0) << outcome.text;
        const auto image = readFloatPicture(file("cube.exr"));
        EXPECT_TRUE(image.ok()) << image.status.text;
        if (!image.ok()) return -1.0;
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(image->at(8, 8)[c], expected[c], 2e-3) << options;
        EXPECT_EQ(image->at(0, 0), glm::vec4(0.0f)) << options;
        const std::string text = readText(file("cube.json"));
        std::smatch match;
        const std::regex counter("\"counters\": \\{[^}]*\"faces\": ([0-9]+)");
        EXPECT_TRUE(std::regex_search(text, match, counter)) << text;
        return match.empty() ? -1.0 : std::stod(match[1]);
    };
    const double coarse = faces("--technique slices --period 0.5");
    const double fine = faces("--technique slices --period 0.25");
    EXPECT_GT(coarse, 10.0);
    EXPECT_NEAR(fine, 2.0 * coarse, 3.0);
    EXPECT_LT(faces("--technique slabs"), coarse);
    EXPECT_GT(faces("--technique auto"), 0.0);
}

// Translucent surfaces blend alpha as OSG's usual blend function does, which leaves no coverage.
TEST_F(RenderToolGLTest, AlphaIsCoverage)
{
    osg::ref_ptr<osg::Geometry> square =
        makeQuad({osg::Vec3(-1, 0, -1), {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}},
                 osg::Vec4(0.8f, 0.4f, 0, 0.25f), true);
    square->getOrCreateStateSet()->setMode(GL_LIGHTING, osg::StateAttribute::OFF);
    const std::string scene = file("glass.osgb");
    ASSERT_TRUE(osgDB::writeNodeFile(*square, scene));
    const auto picture = [&](const std::string& background) {
        const Outcome outcome = runTool(scene + frontal + "--background " + background +
                                        " --output " + file("picture.exr"));
        EXPECT_EQ(outcome.code, 0) << outcome.text;
        const auto image = readFloatPicture(file("picture.exr"));
        return image.ok() ? *image : FloatImage();
    };
    const auto near = [](const glm::vec4& a, const glm::vec4& b) {
        return glm::length(a - b) < 1e-6f;
    };
    const FloatImage clear = picture("0 0 0 0"), half = picture("0.1 0.2 0.3 0.5"),
                     opaque = picture("0.2 0.4 0.6 1");
    EXPECT_TRUE(near(clear.at(8, 4), glm::vec4(0.2f, 0.1f, 0.0f, 0.25f)));
    EXPECT_TRUE(near(half.at(8, 4), glm::vec4(0.275f, 0.25f, 0.225f, 0.625f)));
    EXPECT_TRUE(near(opaque.at(8, 4), glm::vec4(0.35f, 0.4f, 0.45f, 1.0f)));
    EXPECT_EQ(clear.at(0, 0), glm::vec4(0.0f));
    EXPECT_EQ(half.at(0, 0), glm::vec4(0.1f, 0.2f, 0.3f, 0.5f));
    EXPECT_EQ(opaque.at(0, 0), glm::vec4(0.2f, 0.4f, 0.6f, 1.0f));
}

TEST_F(RenderToolGLTest, WholeScenesOverOpaqueAndOverClear)
{
    const std::string scene = OSGVOLUMIZER_SOURCE_DIR "/data/mixed.osgt --size 96 72 ";
    ASSERT_EQ(runTool(scene + "--background 0.2 0.2 0.4 1 --output " + file("opaque.exr")).code, 0);
    ASSERT_EQ(runTool(scene + "--output " + file("clear.exr")).code, 0);
    const auto opaque = readFloatPicture(file("opaque.exr")),
               clear = readFloatPicture(file("clear.exr"));
    ASSERT_TRUE(opaque.ok() && clear.ok());
    EXPECT_GT(coveredPixels(*clear, 0.3f).count(), 1000u);
    for (std::size_t i = 0; i < opaque->pixels.size(); ++i) {
        const glm::vec4 over =
            clear->pixels[i] + (1.0f - clear->pixels[i].a) * glm::vec4(0.2f, 0.2f, 0.4f, 1.0f);
        ASSERT_LT(glm::length(over - opaque->pixels[i]), 1e-5f);
        ASSERT_EQ(opaque->pixels[i].a, 1.0f);
    }
}

TEST_F(RenderToolGLTest, GoesRoundTheScene)
{
    const std::string scene = OSGVOLUMIZER_SOURCE_DIR "/data/head.osgt --size 64 64 ";
    const Outcome outcome = runTool(scene + "--turn 10 --frames 4 --frametime 1e-9 --output " +
                                    file("turned.exr") + " --stats " + file("turned.json"));
    ASSERT_EQ(outcome.code, 0) << outcome.text;
    ASSERT_EQ(runTool(scene + "--output " + file("still.exr")).code, 0);
    const auto turned = readFloatPicture(file("turned.exr")),
               still = readFloatPicture(file("still.exr"));
    ASSERT_TRUE(turned.ok() && still.ok());
    EXPECT_EQ(turned->pixels, still->pixels); // back, and exact
    EXPECT_NE(readText(file("turned.json")).find("\"frames\": 4,"), std::string::npos);
}

TEST_F(RenderToolGLTest, EveryPropertyIsAnOption)
{
    const std::string scene = OSGVOLUMIZER_SOURCE_DIR "/data/head.osgt --size 48 48 ";
    const auto picture = [&](const std::string& options) {
        const Outcome outcome = runTool(scene + options + " --output " + file("picture.exr"));
        EXPECT_EQ(outcome.code, 0) << options << outcome.text;
        const auto image = readFloatPicture(file("picture.exr"));
        return image.ok() ? image->pixels : std::vector<glm::vec4>();
    };
    const auto plain = picture("");
    for (const char* options : {"--ray maximum", "--ray isosurface --iso 40", "--unit 0.2",
                                "--shading off", "--material 1,0,0,1", "--interpolation nearest"})
        EXPECT_TRUE(picture(options) != plain) << options;
    const std::string help = runTool("--help").text;
    for (const auto& property : osgVolumizer::appearanceProperties())
        EXPECT_NE(help.find(std::string("--") + property.option + " "), std::string::npos);
    for (const auto& option : osgVolumizer::volumeOptions())
        EXPECT_NE(help.find(option.name), std::string::npos);
}

TEST_F(RenderToolGLTest, FramesTheSceneByItself)
{
    const std::string scene = writeSquare(osg::Vec4(1, 1, 1, 1));
    for (const std::string view : {"", "--ortho 1.5", "--fovy 70"}) {
        const Outcome outcome =
            runTool(scene + " --size 64 64 " + view + " --output " + file("picture.exr"));
        EXPECT_EQ(outcome.code, 0) << outcome.text;
        const auto image = readFloatPicture(file("picture.exr"));
        ASSERT_TRUE(image.ok()) << image.status.text;
        const Mask covered = coveredPixels(*image);
        EXPECT_GT(covered.count(), 600u) << view;
        for (int x = 0; x < 64; ++x)
            EXPECT_FALSE(covered.set[x] || covered.set[63 * 64 + x]);
    }
}

// The mirror calls nothing of the library, and its volumes come with the scene file.
TEST_F(RenderToolGLTest, AProgramWithoutCallsShowsVolumes)
{
    const Outcome outcome = runProgram(
        "osgvolumizermirror", OSGVOLUMIZER_SOURCE_DIR "/data/head.osgt " + file("mirror.png"));
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    const auto image = readFloatPicture(file("mirror.png"));
    ASSERT_TRUE(image.ok()) << image.status.text;
    ASSERT_EQ(image->width, 640);
    ASSERT_EQ(image->height, 480);
    // The scan, in its table's colours, is all that is bright between the background and the
    // mirror.
    std::size_t bright = 0;
    for (const glm::vec4& pixel : image->pixels)
        bright += pixel.r > 0.5f;
    EXPECT_GT(bright, 1000u);
}

TEST_F(RenderToolGLTest, RefusesInOneSentence)
{
    const std::string scene = writeSquare(osg::Vec4(1, 1, 1, 1));
    const std::string output = " --output " + file("picture.exr");
    const struct
    {
        std::string arguments;
        int code;
        std::string mentions;
    } cases[] = {
        {file("missing.osgt") + output, 1, "missing.osgt"},
        {scene + " --output /nowhere/at/all.exr", 1, "/nowhere/at/all.exr"},
        {scene + " --output " + file("picture.unknown"), 1, "picture.unknown"},
        {scene + " --stats /nowhere/stats.json", 1, "/nowhere/stats.json"},
        {scene + " --eye 0 0 5 --center 0 0 0" + output, 1, "up"},
        {scene + " --device 999" + output, 1, "'999'"},
        {scene + " --device -1" + output, 1, "'-1'"},
        {scene + " --device second" + output, 1, "'second'"},
        {scene + " --device ''" + output, 1, "''"},
        {scene + output + " --device", 2, "--device"},
        {scene, 2, "--output"},
        {output, 2, "scene"},
        {scene + " --frobnicate" + output, 2, "--frobnicate"},
        {scene + " --size 0 10" + output, 2, "--size"},
        {scene + " --size 10" + output, 2, "--size"},
        {scene + " --size 1e9 1e9" + output, 2, "--size"},
        {scene + " --eye 1 2" + output, 2, "--eye"},
        {scene + " --eye nan 0 0" + output, 2, "nan"},
        {scene + " --up 0 0 1" + output, 2, "--up"},
        {scene + " --period 0" + output, 2, "--period"},
        {scene + " --technique magic" + output, 2, "magic"},
        {scene + " --frames 1.5" + output, 2, "--frames"},
        {scene + " --fovy 30 --ortho 1" + output, 2, "--ortho"},
        {scene + " " + scene + output, 2, "Two scenes"},
        {scene + " --output", 2, "--output"},
    };
    for (const auto& c : cases) {
        const Outcome outcome = runTool(c.arguments);
        EXPECT_EQ(outcome.code, c.code) << c.arguments << "\n" << outcome.text;
        EXPECT_NE(outcome.text.find(c.mentions), std::string::npos) << outcome.text;
        EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << outcome.text;
    }
    EXPECT_EQ(runTool("--help").code, 0);
}

} // namespace RenderToolTest
