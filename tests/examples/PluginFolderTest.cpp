// Plugins are found beside the library, without a call and whatever the environment says.
#include <osgVolumizer/Version.h>

#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

namespace PluginFolderTest {

namespace {

namespace fs = std::filesystem;

std::ptrdiff_t positionOf(const osgDB::FilePathList& paths, const std::string& folder)
{
    const auto found = std::find_if(paths.begin(), paths.end(), [&](const std::string& path) {
        std::error_code failed;
        return fs::equivalent(path, folder, failed);
    });
    return found == paths.end() ? -1 : found - paths.begin();
}

TEST(PluginFolder, LiesBeforeTheSystemsFolders)
{
    ASSERT_STRNE(osgVolumizer::getVersion(), "");
    const osgDB::FilePathList& paths = osgDB::Registry::instance()->getLibraryFilePathList();
    const std::ptrdiff_t own = positionOf(paths, OSGVOLUMIZER_BINARY_DIR "/lib");
    ASSERT_GE(own, 0) << "not in the list";
    osgDB::FilePathList ofSystem;
    osgDB::appendPlatformSpecificLibraryFilePaths(ofSystem);
    ASSERT_FALSE(ofSystem.empty());
    const auto first = std::search(paths.begin(), paths.end(), ofSystem.begin(), ofSystem.end());
    ASSERT_NE(first, paths.end());
    if (positionOf(ofSystem, OSGVOLUMIZER_BINARY_DIR "/lib") < 0) {
        EXPECT_EQ(own, first - paths.begin() - 1);
    }
}

TEST(PluginFolder, IsNamedOnce)
{
    const osgDB::FilePathList& paths = osgDB::Registry::instance()->getLibraryFilePathList();
    const std::ptrdiff_t own = positionOf(paths, OSGVOLUMIZER_BINARY_DIR "/lib");
    ASSERT_GE(own, 0);
    const osgDB::FilePathList behind(paths.begin() + own + 1, paths.end());
    EXPECT_EQ(positionOf(behind, OSGVOLUMIZER_BINARY_DIR "/lib"), -1);
}

TEST(PluginFolder, HasThePluginThatScenesNeed)
{
    const std::string plugin = osgDB::findLibraryFile(
        osgDB::Registry::instance()->createLibraryNameForExtension("serializers_osgvolumizer"));
    ASSERT_FALSE(plugin.empty());
    EXPECT_TRUE(fs::equivalent(fs::path(plugin).parent_path().parent_path(),
                               OSGVOLUMIZER_BINARY_DIR "/lib"))
        << plugin;
}

} // namespace

} // namespace PluginFolderTest
