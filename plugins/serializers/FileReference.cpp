#include "FileReference.h"

#include <osgDB/Options>

#include <filesystem>

namespace osgVolumizer {
namespace serializers {

bool isEmbedding(const osgDB::OutputStream& os)
{
    const auto hint = os.getWriteImageHint();
    return hint == osgDB::OutputStream::WRITE_INLINE_DATA ||
           hint == osgDB::OutputStream::WRITE_INLINE_FILE;
}

std::string referenceFrom(const osgDB::OutputStream& os, const std::string& name,
                          const std::string& path)
{
    namespace fs = std::filesystem;
    const osgDB::Options* options = os.getOptions();
    // OSG's writers put the folder of the file that they write in front.
    if (path.empty() || fs::path(name).is_absolute() || !options ||
        options->getDatabasePathList().empty())
        return name;
    std::error_code error;
    const fs::path folder = fs::absolute(options->getDatabasePathList().front(), error);
    if (error || (folder / name).lexically_normal() == fs::path(path).lexically_normal())
        return name;
    const fs::path way =
        fs::path(path).lexically_normal().lexically_relative(folder.lexically_normal());
    return way.empty() ? path : way.string();
}

} // namespace serializers
} // namespace osgVolumizer
