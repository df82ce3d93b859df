#include <osgVolumizer/Version.h>

namespace osgVolumizer {

const char* getVersion()
{
    return OSGVOLUMIZER_VERSION;
}

} // namespace osgVolumizer
