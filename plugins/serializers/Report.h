#pragma once

#include <osgVolumizer/core/Status.h>

#include <osg/Object>
#include <osgDB/InputStream>

namespace osgVolumizer {
namespace serializers {

/// Completes an error met while an object of a scene file was read (its folder, class and name
/// before the status's field and value), and sends it to the library's error channel. OSG does not
/// tell readers the name of the file.
void reportReadError(const osgDB::InputStream& is, const osg::Object& object, const Status& status);

} // namespace serializers
} // namespace osgVolumizer
