// Scenes of which a part cannot be read, in the programs that show scenes.
#include "RunProgram.h"

#include <osgVolumizer/Version.h>

#include <support/ReadScene.h>

#include <osg/Group>
#include <osg/Notify>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>

namespace ReadSceneTest {

namespace {

namespace fs = std::filesystem;
using osgVolumizer::support::readScene;

constexpr const char* data = OSGVOLUMIZER_SOURCE_DIR "/data/";

class ReadScene : public testing::Test
{
protected:
    void SetUp() override
    {
        folder = fs::path(testing::TempDir()) /
                 (std::string("ReadScene") +
                  testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder);
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }
    std::string file(const std::string& name) const { return (folder / name).string(); }

    /// Two groups of classes that no plugin knows, in a group.
    std::string sceneOfUnknownClasses() const
    {
        std::ofstream(file("unknown.osgt"))
            << "#Ascii Scene\n#Version 161\n#Generator OpenSceneGraph 3.6.5\n\n"
               "osg::Group {\n  UniqueID 1\n  Children 2 {\n"
               "    nowhere::Nothing {\n      UniqueID 2\n    }\n"
               "    nowhere::Neither {\n      UniqueID 3\n    }\n  }\n}\n";
        return file("unknown.osgt");
    }
    /// The scan's scene without the scan.
    std::string sceneWithoutItsVoxels() const
    {
        fs::copy_file(std::string(data) + "head.osgt", file("head.osgt"));
        fs::copy_file(std::string(data) + "head.lut", file("head.lut"));
        return file("head.osgt");
    }
    /// One sentence of the program's on one line, exit code 1, and no picture.
    void expectRefused(const std::string& scene, const std::string& mentions) const
    {
        const std::string picture = file("picture.png");
        for (const auto& [program, options] :
             {std::pair<std::string, std::string>{"osgvolumizerrender", " --output "},
              {"osgvolumizermirror", " "}}) {
            const Outcome outcome = runProgram(program, scene + options + picture);
            EXPECT_EQ(outcome.code, 1) << program << ": " << outcome.text;
            EXPECT_NE(outcome.text.find(scene), std::string::npos) << outcome.text;
            const std::regex own(program + ": [^\n]*" + mentions + "[^\n]*\\.\n");
            const std::sregex_iterator found(outcome.text.begin(), outcome.text.end(), own), end;
            EXPECT_EQ(std::distance(found, end), 1) << outcome.text;
            EXPECT_EQ(outcome.text.find("Warning"), std::string::npos) << outcome.text;
            EXPECT_FALSE(fs::exists(picture)) << program;
        }
    }

    fs::path folder;
};

/// Counts what is printed.
struct Printed : osg::NotifyHandler
{
    void notify(osg::NotifySeverity, const char* message) override { count += *message != 0; }
    int count = 0;
};

TEST_F(ReadScene, OfAnUnknownClassIsRefused)
{
    expectRefused(sceneOfUnknownClasses(), "nowhere::Nothing");
}

TEST_F(ReadScene, WithoutItsVoxelsIsRefused)
{
    expectRefused(sceneWithoutItsVoxels(), "head.tif");
}

TEST_F(ReadScene, ThatIsNoneIsRefused)
{
    std::ofstream(file("none.osgt")) << "#Ascii Scene\nnonsense";
    expectRefused(file("none.osgt"), "Cannot read a scene");
    expectRefused(file("missing.osgt"), "not found");
}

TEST_F(ReadScene, TellsHowManyPartsAreMissing)
{
    const auto scene = readScene(sceneOfUnknownClasses());
    EXPECT_EQ(scene.status.code, osgVolumizer::ErrorCode::FILE_UNREADABLE);
    EXPECT_NE(scene.status.text.find("(and 1 more)."), std::string::npos) << scene.status.text;
}

TEST_F(ReadScene, ReadsWholeScenesWithTheirOptions)
{
    for (const char* name : {"head.osgt", "mixed.osgt", "mesh.osgt"}) {
        const auto scene = readScene(std::string(data) + name);
        EXPECT_TRUE(scene.ok() && scene->valid()) << scene.status.text;
    }
    const std::string scan = std::string(data) + "head.tif.volume";
    EXPECT_TRUE(readScene(scan, "spacing=1,1,2").ok());
    const auto refused = readScene(scan, "spacing=0,1,2");
    EXPECT_NE(refused.status.text.find("spacing"), std::string::npos) << refused.status.text;
}

TEST_F(ReadScene, KeepsTheHandlerAndTheLevelOfOthers)
{
    const osg::ref_ptr<osg::NotifyHandler> before = osg::getNotifyHandler();
    const osg::NotifySeverity level = osg::getNotifyLevel();
    const osg::ref_ptr<Printed> printed = new Printed;
    osg::setNotifyHandler(printed);
    osg::setNotifyLevel(osg::FATAL);
    EXPECT_FALSE(readScene(sceneOfUnknownClasses()).ok()); // heard all the same
    EXPECT_EQ(printed->count, 0);
    EXPECT_EQ(osg::getNotifyHandler(), printed.get());
    EXPECT_EQ(osg::getNotifyLevel(), osg::FATAL);
    osg::setNotifyLevel(osg::INFO);
    EXPECT_TRUE(readScene(std::string(data) + "head.osgt").ok());
    EXPECT_GT(printed->count, 0);
    osg::setNotifyLevel(level);
    osg::setNotifyHandler(before);
}

TEST(Programs, TellTheLibrarysVersion)
{
    for (const std::string program : {"osgvolumizerrender", "osgvolumizertool"}) {
        const Outcome outcome = runProgram(program, "--version");
        EXPECT_EQ(outcome.code, 0) << outcome.text;
        EXPECT_EQ(outcome.text, program + " " + osgVolumizer::getVersion() + "\n");
    }
}

} // namespace

} // namespace ReadSceneTest
