#include "Report.h"

#include <osgVolumizer/Error.h>

namespace osgVolumizer {
namespace serializers {

void reportReadError(const osgDB::InputStream& is, const osg::Object& object, const Status& status)
{
    if (status.ok()) return;
    std::string where = "Scene file";
    const osgDB::Options* options = is.getOptions();
    if (options && !options->getDatabasePathList().empty() &&
        !options->getDatabasePathList().front().empty())
        where += " in '" + options->getDatabasePathList().front() + "'";
    where += std::string(", ") + object.libraryName() + "::" + object.className();
    if (!object.getName().empty()) where += " '" + object.getName() + "'";
    const bool sentence = !status.text.empty() && status.text.back() == '.';
    reportError(
        Status(status.code, where + ": " + status.text + (sentence ? "" : "."), status.index));
}

} // namespace serializers
} // namespace osgVolumizer
