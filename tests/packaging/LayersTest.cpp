// Which part of the sources may include which: an arrow points down a list of layers only, and core
// knows neither OSG nor GL.
#include "Layers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace LayersTest {

using namespace osgVolumizer;

namespace {

namespace fs = std::filesystem;

const fs::path library = fs::path(OSGVOLUMIZER_SOURCE_DIR) / "osgVolumizer";

// From the top down: what may include all below it.
const test::Layers PROJECT{{"plugins"},
                           {"osgVolumizer/interact"},
                           {"osgVolumizer/render"},
                           {"osgVolumizer", "osgVolumizer/io"},
                           {"osgVolumizer/core"}};
const test::Layers RENDERING{{"osgVolumizer/render/cull"},     {"osgVolumizer/render/merge"},
                             {"osgVolumizer/render/volume"},   {"osgVolumizer/render/draw"},
                             {"osgVolumizer/render/textures"}, {"osgVolumizer/render/context"}};

struct Include
{
    fs::path file;
    std::string target; ///< as written
    bool quoted = false;
};

bool isCode(const fs::path& path)
{
    return path.extension() == ".h" || path.extension() == ".cpp";
}

std::vector<fs::path> codeBelow(const fs::path& folder)
{
    std::vector<fs::path> files;
    if (!fs::exists(folder)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (isCode(entry.path())) files.push_back(entry.path());
    return files;
}

/// The sources of the nodes: those directly in the library's folder, and their private ones.
std::vector<fs::path> nodeFiles()
{
    std::vector<fs::path> files = codeBelow(library / "private");
    for (const auto& entry : fs::directory_iterator(library))
        if (isCode(entry.path())) files.push_back(entry.path());
    return files;
}

std::vector<Include> includesOf(const std::vector<fs::path>& files)
{
    static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
    std::vector<Include> includes;
    for (const fs::path& file : files) {
        std::ifstream stream(file);
        std::smatch match;
        for (std::string line; std::getline(stream, line);)
            if (std::regex_search(line, match, pattern))
                includes.push_back({file, match[2], match[1] == "\""});
    }
    return includes;
}

/// The folder, relative to the library, that a quoted or <osgVolumizer/...> include lies in; ".."
/// for anything else.
std::string layerOf(const Include& include)
{
    fs::path path = include.file.parent_path() / include.target;
    if (!include.quoted) path = library.parent_path() / include.target;
    const fs::path relative = path.lexically_normal().lexically_relative(library);
    if (!fs::exists(path)) return "..";
    return relative.has_parent_path() ? relative.begin()->string() : "nodes";
}

/// What is included within the project, by quotes or as <osgVolumizer/...>.
std::vector<test::Include> projectIncludes()
{
    const fs::path project = library.parent_path();
    auto files = codeBelow(library);
    for (const fs::path& file : codeBelow(project / "plugins"))
        files.push_back(file);
    std::vector<test::Include> includes;
    for (const Include& include : includesOf(files)) {
        const fs::path folder = include.quoted ? include.file.parent_path() : project;
        const fs::path target = (folder / include.target).lexically_normal();
        if (fs::exists(target))
            includes.push_back({include.file.lexically_relative(project).generic_string(),
                                target.lexically_relative(project).generic_string()});
    }
    return includes;
}

void expectDownwards(const test::Layers& layers)
{
    for (const test::Include& include : test::upwardIncludes(projectIncludes(), layers))
        ADD_FAILURE() << include.file << " includes " << include.target;
}

/// Every include between two layers must be found when it is turned round, and no other.
void expectFoundTurnedRound(const test::Layers& layers, std::size_t atLeast)
{
    std::vector<test::Include> turned, between;
    for (const test::Include& include : projectIncludes()) {
        const int from = test::layerOf(include.file, layers);
        const int to = test::layerOf(include.target, layers);
        if (from < 0 || to < 0 || from > to) continue;
        turned.push_back({include.target, include.file});
        if (from != to) between.push_back(turned.back());
    }
    EXPECT_GE(between.size(), atLeast);
    EXPECT_EQ(test::upwardIncludes(turned, layers), between);
}

bool startsWith(const std::string& text, const std::string& prefix)
{
    return text.compare(0, prefix.size(), prefix) == 0;
}

bool isGl(const std::string& target)
{
    return startsWith(target, "GL") || startsWith(target, "EGL") || startsWith(target, "osg/GL");
}

TEST(Layers, CoreIncludesNeitherOsgNorGl)
{
    const auto includes = includesOf(codeBelow(library / "core"));
    ASSERT_GT(includes.size(), 20u);
    static const std::regex osg("^(osg[A-Za-z]*|OpenThreads)/.*");
    for (const Include& include : includes) {
        EXPECT_FALSE(isGl(include.target)) << include.file << " includes " << include.target;
        const bool own = startsWith(include.target, "osgVolumizer/core/");
        EXPECT_TRUE(own || !std::regex_match(include.target, osg))
            << include.file << " includes " << include.target;
    }
}

TEST(Layers, CoreIncludesOnlyItself)
{
    for (const Include& include : includesOf(codeBelow(library / "core"))) {
        if (include.quoted) {
            EXPECT_EQ(layerOf(include), "core") << include.file << " includes " << include.target;
        }
    }
}

TEST(Layers, PublicHeadersIncludeOnlyPublicHeaders)
{
    auto headers = nodeFiles();
    for (const char* folder : {"core", "interact"})
        for (const fs::path& file : codeBelow(library / folder))
            headers.push_back(file);
    headers.erase(std::remove_if(headers.begin(), headers.end(),
                                 [](const fs::path& f) {
                                     return f.extension() != ".h" ||
                                            f.parent_path().filename() == "private";
                                 }),
                  headers.end());
    ASSERT_GE(headers.size(), 40u);
    for (const Include& include : includesOf(headers)) {
        const std::string layer = layerOf(include);
        EXPECT_TRUE(layer == "nodes" || layer == "core" || layer == "interact" || !include.quoted)
            << include.file << " includes " << include.target;
        EXPECT_EQ(include.target.find("private/"), std::string::npos)
            << include.file << " includes " << include.target;
    }
}

TEST(Layers, NodesDoNotIncludeRendering)
{
    const auto files = nodeFiles();
    ASSERT_GE(files.size(), 20u);
    for (const Include& include : includesOf(files)) {
        const std::string layer = layerOf(include);
        EXPECT_TRUE(layer != "render" && layer != "interact")
            << include.file << " includes " << include.target;
    }
}

TEST(Layers, OnlyRenderingIncludesGl)
{
    auto files = nodeFiles();
    for (const char* folder : {"io", "interact"})
        for (const fs::path& file : codeBelow(library / folder))
            files.push_back(file);
    for (const Include& include : includesOf(files))
        EXPECT_FALSE(isGl(include.target)) << include.file << " includes " << include.target;
}

TEST(Layers, RenderingDoesNotIncludeInteraction)
{
    const auto includes = includesOf(codeBelow(library / "render"));
    ASSERT_FALSE(includes.empty());
    for (const Include& include : includes)
        EXPECT_NE(layerOf(include), "interact") << include.file << " includes " << include.target;
}

TEST(Layers, LibrariesIncludeDownwardsOnly)
{
    expectDownwards(PROJECT);
}

TEST(Layers, StagesOfRenderingIncludeDownwardsOnly)
{
    expectDownwards(RENDERING);
}

TEST(Layers, EveryFileOfRenderingIsInAStage)
{
    for (const fs::path& file : codeBelow(library / "render")) {
        const fs::path relative = file.lexically_relative(library.parent_path());
        EXPECT_GE(test::layerOf(relative.generic_string(), RENDERING), 0) << relative;
    }
}

TEST(Layers, IncludesTurnedRoundAreFound)
{
    expectFoundTurnedRound(PROJECT, 100);
    expectFoundTurnedRound(RENDERING, 100);
}

TEST(Layers, AFileIsInTheInnermostFolderNamed)
{
    const test::Layers layers{{"a/inner"}, {"a", "a/other"}, {"a/inner/core"}};
    EXPECT_EQ(test::layerOf("a/inner/x.h", layers), 0);
    EXPECT_EQ(test::layerOf("a/x.h", layers), 1);
    EXPECT_EQ(test::layerOf("a/other/x.h", layers), 1);
    EXPECT_EQ(test::layerOf("a/unknown/x.h", layers), 1);
    EXPECT_EQ(test::layerOf("a/inner/core/x.h", layers), 2);
    EXPECT_EQ(test::layerOf("a/innermost/x.h", layers), 1); // another name
    EXPECT_EQ(test::layerOf("b/x.h", layers), -1);
}

TEST(Layers, OnlyUpwardIncludesAreFound)
{
    const test::Layers layers{{"top"}, {"middle"}, {"bottom"}};
    const std::vector<test::Include> fine{{"top/x.h", "middle/x.h"},
                                          {"top/x.h", "bottom/x.h"},
                                          {"middle/x.h", "middle/y.h"},
                                          {"middle/x.h", "elsewhere/y.h"},
                                          {"elsewhere/x.h", "top/y.h"}};
    EXPECT_TRUE(test::upwardIncludes(fine, layers).empty());
    const std::vector<test::Include> wrong{
        {"bottom/x.h", "middle/x.h"}, {"bottom/x.h", "top/x.h"}, {"middle/x.h", "top/x.h"}};
    auto both = fine;
    both.insert(both.begin() + 2, wrong.begin(), wrong.end());
    EXPECT_EQ(test::upwardIncludes(both, layers), wrong);
}

TEST(Layers, OwnIncludesExist)
{
    auto files = nodeFiles();
    for (const char* folder : {"core", "io", "render", "interact"})
        for (const fs::path& file : codeBelow(library / folder))
            files.push_back(file);
    for (const Include& include : includesOf(files)) {
        if (include.quoted) {
            EXPECT_NE(layerOf(include), "..") << include.file << " includes " << include.target;
        }
    }
}

} // namespace

} // namespace LayersTest
