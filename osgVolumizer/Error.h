#pragma once

#include "core/Export.h"
#include "core/Status.h"

#include <osg/Referenced>

/// Volumes in OpenSceneGraph scenes.
///
/// Errors. Nothing throws. A setter that refuses a value keeps the old one, reports the reason, and
/// returns it as a ReportedStatus. Whatever makes, reads or writes something returns the reason in
/// a Status or Result and reports nothing, since only its caller knows what was to become of it.
/// What is found out where nobody waits for an answer, in a frame or while OSG reads a scene file,
/// is reported.
///
/// Vectors. Objects of the scene graph have OSG's types (osg::Vec3d, osg::Vec3i,
/// osg::BoundingBoxd), as all around them in a program that has OSG. What core computes with, and
/// so what is handed to it (VoxelSource::Description, core::Box3i, core::TransferFunction::Point,
/// core::TetraSet), has GLM's, since core knows no OSG.
namespace osgVolumizer {

/// Called with every error that the library reports, from whichever thread met it.
class OSGVOLUMIZER_EXPORT ErrorHandler : public osg::Referenced
{
public:
    virtual void operator()(const Status& status) = 0;

protected:
    ~ErrorHandler() override = default;
};

class ReportedStatus;
/// For setters: reports a failed status, and returns it.
OSGVOLUMIZER_EXPORT ReportedStatus reported(Status status);

/// What a setter returns. Unlike any other Status it may be ignored, for a failure was reported.
class ReportedStatus : public Status
{
public:
    ReportedStatus() = default;

private:
    explicit ReportedStatus(Status status) : Status(std::move(status)) {}
    friend ReportedStatus reported(Status status);
};

/// Installs the handler of the process; null restores the default. Whatever the handler, errors
/// also go to osg::notify(osg::WARN), each text at most once in a row.
OSGVOLUMIZER_EXPORT void setErrorHandler(ErrorHandler* handler);
/// The last error of any thread; code NONE when there was none since clearLastError().
OSGVOLUMIZER_EXPORT Status getLastError();
OSGVOLUMIZER_EXPORT void clearLastError();
/// Sends a failed status to the handler and to OSG's notify; a status that is ok() does nothing.
OSGVOLUMIZER_EXPORT void reportError(const Status& status);

/// While one lives, setters called on its thread do not report what they refuse: whoever holds it
/// takes the status that they return, and returns or reports it with the name of the file that the
/// value is from.
class OSGVOLUMIZER_EXPORT CallerReports
{
public:
    CallerReports();
    ~CallerReports();
    CallerReports(const CallerReports&) = delete;
    CallerReports& operator=(const CallerReports&) = delete;
};

} // namespace osgVolumizer
