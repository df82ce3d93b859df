// What README.md says of the library's own lists.
#include <osgVolumizer/ReadVolume.h>

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

namespace ReadmeTest {

using namespace osgVolumizer;

TEST(Readme, ListsEveryOptionOfTheLoader)
{
    std::ifstream stream(OSGVOLUMIZER_SOURCE_DIR "/README.md");
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    ASSERT_FALSE(text.empty());
    std::string table;
    for (const VolumeOption& option : volumeOptions())
        table += "| `" + option.name + "=` " + option.values + " | " + option.help + " |\n";
    EXPECT_NE(text.find(table), std::string::npos) << "README.md should have:\n" << table;
}

} // namespace ReadmeTest
