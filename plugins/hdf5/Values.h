#pragma once

#include "Session.h"

#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace hdf5 {

// All functions here expect a Session.

/// True where all of a path exists.
bool exists(hid_t file, const std::string& path);
/// Attributes of an object: none where it is missing or something else.
std::optional<std::string> textAttribute(hid_t object, const char* name);
std::optional<glm::dvec3> tripleAttribute(hid_t object, const char* name);
/// The rows of a dataset of three numbers each; none where it is missing or something else.
std::vector<glm::dvec3> triplesOf(hid_t file, const std::string& path);

} // namespace hdf5
} // namespace osgVolumizer
