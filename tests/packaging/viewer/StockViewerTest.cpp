// Scenes of data/ in stock osgviewer, a program that knows nothing of volumes, on a virtual
// display: its window shows what the library renders off screen, to the last bits of the 8 that it
// has.
#include "VirtualDisplay.h"

#include <examples/RunProgram.h>
#include <support/GLTest.h>
#include <support/PictureFile.h>

#include <osgDB/ReadFile>
#include <osgUtil/Optimizer>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

namespace StockViewerTest {

using namespace osgVolumizer::support;

namespace {

namespace fs = std::filesystem;

constexpr int WIDTH = 400, HEIGHT = 300;

std::size_t colourCount(const FloatImage& image)
{
    std::set<std::tuple<float, float, float>> colours;
    for (const glm::vec4& p : image.pixels)
        colours.insert({p.x, p.y, p.z});
    return colours.size();
}

std::string textOf(const std::string& file)
{
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

class StockViewer : public GLTest
{
protected:
    void SetUp() override
    {
        GLTest::SetUp();
        folder = fs::path(testing::TempDir()) /
                 (std::string("osgviewer_") +
                  testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder);
        fs::create_directories(folder);
    }

    /// The window once it shows something and has stopped changing; empty if that never happens.
    FloatImage window(const std::string& scene)
    {
        VirtualDisplay display(folder.string(), WIDTH, HEIGHT);
        if (!display.ready()) return {};
        const std::string log = (folder / "osgviewer.log").string();
        Child viewer(
            {OSGVIEWER, "--window", "0", "0", std::to_string(WIDTH), std::to_string(HEIGHT), scene},
            {{"DISPLAY", display.name()},
             {"LIBGL_ALWAYS_SOFTWARE", "1"},
             {"LD_PRELOAD", PRELOAD},
             {"ASAN_OPTIONS", "detect_leaks=0"}},
            log);
        // A frame may take longer than the time between two looks, and the first ones may have
        // fewer samples, as of a view that moves.
        constexpr int LOOKS = 8;
        int same = 0;
        FloatImage last;
        for (int halfSeconds = 0; halfSeconds < 400 && viewer.running(); ++halfSeconds) {
            usleep(500000);
            auto now = display.read();
            if (!now) continue;
            same = last.pixels == now->pixels ? same + 1 : 0;
            if (same >= LOOKS && colourCount(*now) > 16) {
                const std::string text = textOf(log);
                EXPECT_EQ(text.find("osgVolumizer"), std::string::npos) << text;
                EXPECT_EQ(text.find("error"), std::string::npos) << text;
                return last;
            }
            last = std::move(*now);
        }
        ADD_FAILURE() << "osgviewer showed nothing:\n" << textOf(log);
        return {};
    }

    static FloatImage offScreen(const std::string& name)
    {
        osg::ref_ptr<osg::Node> scene = osgDB::readRefNodeFile(name);
        if (!scene) return {};
        osgUtil::Optimizer().optimize(scene.get());
        RenderOptions options;
        options.size(WIDTH, HEIGHT)
            .perspective(fieldOfViewOfViewers())
            .frameScene(scene->getBound());
        options.background.set(0.2f, 0.2f, 0.4f, 1.0f); // osgviewer's
        options.light = true;
        FloatImage image = renderScene(scene.get(), options);
        for (glm::vec4& pixel : image.pixels)
            pixel = glm::vec4(glm::clamp(glm::vec3(pixel), 0.0f, 1.0f), 1.0f);
        return image;
    }

    /// What osgvolumizerrender writes over osgviewer's background; empty if it fails.
    FloatImage written(const std::string& scene) const
    {
        const std::string file = (folder / "written.png").string();
        const Outcome outcome =
            runProgram("osgvolumizerrender", scene + " --size " + std::to_string(WIDTH) + " " +
                                                 std::to_string(HEIGHT) + " --fovy " +
                                                 std::to_string(fieldOfViewOfViewers()) +
                                                 " --background 0.2 0.2 0.4 1 --output " + file);
        EXPECT_EQ(outcome.code, 0) << outcome.text;
        const auto image = readFloatPicture(file);
        return image.ok() ? *image : FloatImage();
    }

    /// The window against the library's own picture, and against the tool's.
    void check(const std::string& scene)
    {
        const std::string file = OSGVOLUMIZER_SOURCE_DIR "/data/" + scene;
        const FloatImage shown = window(file);
        const FloatImage expected = offScreen(file);
        ASSERT_FALSE(shown.empty());
        ASSERT_FALSE(expected.empty());
        expectAlike(shown, expected);
        const FloatImage picture = written(file);
        ASSERT_FALSE(picture.empty());
        expectAlike(shown, picture);
        EXPECT_TRUE(std::all_of(picture.pixels.begin(), picture.pixels.end(),
                                [](const glm::vec4& pixel) { return pixel.a == 1.0f; }));
        if (HasFailure()) {
            savePicture(shown, "osgviewer_" + scene);
            savePicture(expected, "expected_" + scene);
            savePicture(picture, "written_" + scene);
        }
    }

    static void expectAlike(const FloatImage& shown, const FloatImage& expected)
    {
        Mask all{WIDTH, HEIGHT, std::vector<unsigned char>(shown.pixels.size(), 1)};
        const Difference difference = compare(shown, expected, all);
        // The window has 8 bits, and the opaque scene is rounded before the volume is blended with
        // it.
        EXPECT_LE(difference.rmse, 0.5 / 255.0);
        EXPECT_LE(std::abs(difference.bias), 1e-3);
    }

    fs::path folder;
};

TEST_F(StockViewer, ShowsTheScan)
{
    check("head.osgt");
}

TEST_F(StockViewer, ShowsTheScanWithOpaqueAndTranslucentGeometry)
{
    check("mixed.osgt");
}

TEST_F(StockViewer, ShowsTheUnstructuredMesh)
{
    check("mesh.osgt");
}

TEST_F(StockViewer, ShowsAVolumeFileWithoutAScene)
{
    check("head.tif.volume");
}

} // namespace

} // namespace StockViewerTest
