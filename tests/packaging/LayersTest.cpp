// Which part of the sources may include which: an arrow points down the list interact -> render ->
// nodes -> core only, and core knows neither OSG nor GL.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path library = fs::path(OSGVOLUMIZER_SOURCE_DIR) / "osgVolumizer";

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
    for (const fs::path& file : codeBelow(library / "core"))
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
        EXPECT_TRUE(layer == "nodes" || layer == "core" || !include.quoted)
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
