// Programs that are linked with the library find its plugins, wherever both are installed.
#include <osg/Version>
#include <osgDB/FileUtils>
#include <osgDB/Registry>

#include <algorithm>
#include <dlfcn.h>
#include <filesystem>

namespace osgVolumizer {

namespace {

namespace fs = std::filesystem;

/// The folder that this library was loaded from; empty where that is not known.
fs::path libraryFolder()
{
    static const char inThisLibrary = 0;
    Dl_info info;
    if (dladdr(&inThisLibrary, &info) == 0 || !info.dli_fname) return {};
    std::error_code failed;
    const fs::path file = fs::canonical(info.dli_fname, failed);
    return failed ? fs::path() : file.parent_path();
}

/// Behind what OSG_LIBRARY_PATH names, so that the user has the last word, and before the system's
/// folders, where another version's plugins may lie.
void findPluginsBeside(const fs::path& folder)
{
    std::error_code failed;
    if (folder.empty() ||
        !fs::is_directory(folder / (std::string("osgPlugins-") + osgGetVersion()), failed))
        return;
    osgDB::FilePathList& paths = osgDB::Registry::instance()->getLibraryFilePathList();
    // Where the library came with a plugin, as in a stock viewer, the folder is there already, and
    // threads that load other plugins may be reading the list.
    for (const std::string& path : paths)
        if (fs::equivalent(path, folder, failed)) return;
    osgDB::FilePathList ofSystem;
    osgDB::appendPlatformSpecificLibraryFilePaths(ofSystem);
    paths.insert(std::search(paths.begin(), paths.end(), ofSystem.begin(), ofSystem.end()),
                 folder.string());
}

// While the library is loaded: before any scene is read, and without a call of the program's. The
// registry exists by then, since libosgDB itself fills it while it is loaded.
[[maybe_unused]] const bool found = [] {
    findPluginsBeside(libraryFolder());
    return true;
}();

} // namespace

} // namespace osgVolumizer
