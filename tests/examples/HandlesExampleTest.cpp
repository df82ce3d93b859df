// osgvolumizerhandles, run as a program.
#include "RunProgram.h"

#include "../support/FolderTest.h"

#include <support/PictureFile.h>

#include <filesystem>

namespace HandlesExampleTest {

using namespace osgVolumizer;

namespace {

const std::string HEAD = OSGVOLUMIZER_SOURCE_DIR "/data/head.osgt ";

class HandlesExample : public support::FolderTest
{
};

} // namespace

TEST_F(HandlesExample, DrawsTheHandlesOfEachTool)
{
    for (const std::string tool : {"sphere", "part"}) {
        const std::string picture = path(tool + ".png");
        const Outcome outcome = runProgram("osgvolumizerhandles", HEAD + tool + " " + picture);
        ASSERT_EQ(outcome.code, 0) << outcome.text;
        const auto image = support::readFloatPicture(picture);
        ASSERT_TRUE(image.ok()) << image.status.text;
        // Blue as no part of the scan is.
        std::size_t blue = 0;
        for (const glm::vec4& pixel : image->pixels)
            blue += pixel.b > 0.7f && pixel.r < 0.3f;
        EXPECT_GT(blue, 50u) << tool;
    }
}

TEST_F(HandlesExample, RefusesInOneSentence)
{
    const std::string picture = path("picture.png");
    Outcome outcome = runProgram("osgvolumizerhandles", HEAD + "spoon " + picture);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.text, "osgvolumizerhandles: there is no tool 'spoon'\n");
    outcome = runProgram("osgvolumizerhandles", path("missing.osgt") + " box " + picture);
    EXPECT_EQ(outcome.code, 1);
    EXPECT_NE(outcome.text.find("missing.osgt"), std::string::npos) << outcome.text;
    EXPECT_FALSE(std::filesystem::exists(picture));
}

} // namespace HandlesExampleTest
