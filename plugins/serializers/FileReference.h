#pragma once

#include <osgDB/OutputStream>

#include <string>

namespace osgVolumizer {
namespace serializers {

/// Whether a scene file is to hold what it could refer to by name: OSG's own option for images,
/// WriteImageHint=IncludeData or IncludeFile.
bool isEmbedding(const osgDB::OutputStream& os);

/// What a scene file calls another one. \param name that the file was read by \param path where it
/// was found; empty where that is not known. The name itself, where a reader of the scene finds the
/// file by it beside the scene; else the way from the scene's folder to the file.
std::string referenceFrom(const osgDB::OutputStream& os, const std::string& name,
                          const std::string& path);

} // namespace serializers
} // namespace osgVolumizer
