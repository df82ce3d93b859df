// Rules about who calls what that a compiler does not check.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace SourceRulesTest {

namespace {

namespace fs = std::filesystem;

// The renderer's files in which an expression is found.
std::set<std::string> renderFilesWith(const std::regex& expression)
{
    std::set<std::string> files;
    const fs::path folder = fs::path(OSGVOLUMIZER_SOURCE_DIR) / "osgVolumizer" / "render";
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string extension = entry.path().extension().string();
        if (extension != ".h" && extension != ".cpp") continue;
        std::stringstream text;
        text << std::ifstream(entry.path()).rdbuf();
        if (std::regex_search(text.str(), expression))
            files.insert(entry.path().filename().string());
    }
    return files;
}

// Paging decides in one place what is read and when.
TEST(SourceRules, OnlyBrickResidencyAsksForSamples)
{
    EXPECT_EQ(renderFilesWith(std::regex("\\bgetBrick\\s*\\(")),
              std::set<std::string>{"BrickResidency.cpp"});
}

} // namespace

} // namespace SourceRulesTest
