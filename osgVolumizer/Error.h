#pragma once

#include "core/Export.h"
#include "core/Status.h"

#include <osg/Referenced>

namespace osgVolumizer {

/// Called with every error that the library reports, from whichever thread met it.
class OSGVOLUMIZER_EXPORT ErrorHandler : public osg::Referenced
{
public:
    virtual void operator()(const Status& status) = 0;

protected:
    ~ErrorHandler() override = default;
};

/// Installs the handler of the process; null restores the default. Whatever the handler, errors
/// also go to osg::notify(osg::WARN), each text at most once in a row.
OSGVOLUMIZER_EXPORT void setErrorHandler(ErrorHandler* handler);
/// The last error of any thread; code NONE when there was none since clearLastError().
OSGVOLUMIZER_EXPORT Status getLastError();
OSGVOLUMIZER_EXPORT void clearLastError();
/// Sends a failed status to the handler and to OSG's notify; a status that is ok() does nothing.
OSGVOLUMIZER_EXPORT void reportError(const Status& status);

} // namespace osgVolumizer
