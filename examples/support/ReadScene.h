#pragma once

#include <osgVolumizer/core/Status.h>

#include <osg/Node>
#include <osg/ref_ptr>

#include <string>

namespace osgVolumizer {
namespace support {

/// The whole scene in a file. OSG's readers leave out what they cannot read (an object of a class
/// without a plugin, a volume whose file is missing), and warn; here that is a refusal, with what
/// they said, and so is a file without a scene (FILE_UNREADABLE). What they say below a warning
/// goes where it went before. \param readerOptions for osgDB's readers, e.g. those of .volume
Result<osg::ref_ptr<osg::Node>> readScene(const std::string& fileName,
                                          const std::string& readerOptions = {});

} // namespace support
} // namespace osgVolumizer
