// The files that are shipped: each has an origin, and is what it says it is.
#include "SourceTree.h"

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace DataTest {

namespace {

namespace fs = std::filesystem;

TEST(Data, EveryFileHasItsOriginInSources)
{
    const std::string sources = textOf(source / "data" / "SOURCES.md");
    ASSERT_FALSE(sources.empty());
    for (const auto& entry : fs::directory_iterator(source / "data")) {
        const std::string name = entry.path().filename().string();
        if (name == "SOURCES.md") continue;
        EXPECT_NE(sources.find(name), std::string::npos) << name << " is not in data/SOURCES.md";
    }
}

/// The sum over bytes that Debian's brainsmall.den has after its header, weighted with the position
/// so that a swapped slice, row or axis shows.
TEST(Data, HeadHoldsTheVoxelsOfTheScan)
{
    const auto file = OIIO::ImageInput::open((source / "data" / "head.tif").string());
    ASSERT_TRUE(file) << OIIO::geterror();
    std::uint64_t sum = 0, weighted = 0, position = 0;
    int pages = 0;
    for (; file->seek_subimage(pages, 0); ++pages) {
        const OIIO::ImageSpec& spec = file->spec();
        ASSERT_EQ(spec.width, 128);
        ASSERT_EQ(spec.height, 128);
        ASSERT_EQ(spec.nchannels, 1);
        ASSERT_EQ(spec.format, OIIO::TypeDesc::UINT8);
        std::vector<std::uint8_t> pixels(128 * 128);
        ASSERT_TRUE(file->read_image(pages, 0, 0, 1, OIIO::TypeDesc::UINT8, pixels.data()));
        for (const std::uint8_t value : pixels) {
            sum += value;
            weighted += value * ++position;
        }
    }
    EXPECT_EQ(pages, 84);
    EXPECT_EQ(sum, 19284185u);
    EXPECT_EQ(weighted, 13586282929906u);
}

TEST(Documents, RelativeLinksLeadSomewhere)
{
    static const std::regex link(R"(\]\(([^)#]+)[^)]*\))");
    for (const char* name : {"README.md", "data/SOURCES.md"}) {
        const std::string text = textOf(source / name);
        ASSERT_FALSE(text.empty()) << name;
        for (std::sregex_iterator i(text.begin(), text.end(), link), end; i != end; ++i) {
            const std::string target = (*i)[1];
            if (target.find("://") != std::string::npos) continue;
            EXPECT_TRUE(fs::exists((source / name).parent_path() / target))
                << name << " links to " << target;
        }
    }
}

} // namespace

} // namespace DataTest
