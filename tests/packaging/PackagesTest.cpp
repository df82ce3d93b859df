// Which packages of Debian are needed is said in one place, .ci/packages.sh.
#include "SourceTree.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

namespace PackagesTest {

namespace {

namespace fs = std::filesystem;

/// A variable of .ci/packages.sh, as a shell sees it.
std::string packages(const std::string& variable)
{
    const std::string command = "bash -c '. \"" + (source / ".ci/packages.sh").string() +
                                "\"; printf %s \"$" + variable + "\"'";
    FILE* pipe = popen(command.c_str(), "r");
    if (!pipe) return {};
    std::string text;
    std::array<char, 256> buffer;
    while (std::fgets(buffer.data(), buffer.size(), pipe))
        text += buffer.data();
    return pclose(pipe) == 0 ? text : "";
}

TEST(Packages, OfTheReadmeAreThoseOfTheScripts)
{
    const std::string needed = packages("BUILD_PACKAGES");
    ASSERT_NE(needed.find("libopenscenegraph-dev"), std::string::npos) << needed;
    const std::string readme = textOf(source / "README.md");
    static const std::regex line("\n(sudo )?apt-get install -y --no-install-recommends ([^\n]*)\n");
    std::smatch match;
    ASSERT_TRUE(std::regex_search(readme, match, line));
    EXPECT_EQ(match[2], needed);
}

TEST(Packages, AreNamedInNoScriptItself)
{
    static const std::regex call("install_missing([^\n]*)");
    static const std::regex variables("( \\$[A-Za-z_0-9]*)+( \\|\\|.*)?");
    for (const char* script : {"tests/run.sh", "tests/bench/charting.sh", "tests/bench/chart.sh",
                               "examples/demo.sh", "examples/pictures.sh"}) {
        const std::string text = textOf(source / script);
        int calls = 0;
        for (std::sregex_iterator i(text.begin(), text.end(), call), end; i != end; ++i, ++calls)
            EXPECT_TRUE(std::regex_match((*i)[1].str(), variables)) << script << ":" << (*i)[1];
        EXPECT_GT(calls, 0) << script;
    }
}

TEST(Packages, OfEveryScriptAreListed)
{
    for (const char* list :
         {"TEST_PACKAGES", "DEMO_PACKAGES", "HEADLESS_DEMO_PACKAGES", "CHART_PACKAGES",
          "CHART_VOLPACK_PACKAGES", "VTK_PACKAGES", "HDF5_PACKAGES", "TIFF_PACKAGES",
          "GDAL_PACKAGES", "OPENVDB_PACKAGES", "ITK_PACKAGES", "ITK_TEST_PACKAGES"}) {
        EXPECT_FALSE(packages(list).empty()) << list;
    }
}

} // namespace

} // namespace PackagesTest
