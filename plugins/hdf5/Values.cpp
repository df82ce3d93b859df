#include "Values.h"

#include <algorithm>

namespace osgVolumizer {
namespace hdf5 {

namespace {

constexpr std::size_t MAXIMUM_TEXT_BYTES = 4096;
constexpr hsize_t MAXIMUM_TRIPLES = 64;

bool isNumber(hid_t type)
{
    const H5T_class_t kind = H5Tget_class(type);
    return kind == H5T_INTEGER || kind == H5T_FLOAT;
}

} // namespace

bool exists(hid_t file, const std::string& path)
{
    for (std::size_t end = path.find('/', 1);; end = path.find('/', end + 1)) {
        if (H5Lexists(file, path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
        if (end == std::string::npos) return true;
    }
}

std::optional<std::string> textAttribute(hid_t object, const char* name)
{
    if (H5Aexists(object, name) <= 0) return std::nullopt;
    const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
    if (!type.ok() || !space.ok() || H5Tget_class(type) != H5T_STRING) return std::nullopt;
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    if (H5Tis_variable_str(type) > 0) {
        char* text = nullptr;
        if (count != 1 || H5Aread(attribute, type, &text) < 0 || !text) return std::nullopt;
        std::string copy(text);
        H5free_memory(text);
        return copy;
    }
    // Imaris writes a string for each character.
    const std::size_t bytes = H5Tget_size(type);
    if (count < 1 || std::size_t(count) > MAXIMUM_TEXT_BYTES || bytes > MAXIMUM_TEXT_BYTES)
        return std::nullopt;
    std::string text(std::size_t(count) * bytes, '\0');
    if (H5Aread(attribute, type, text.data()) < 0) return std::nullopt;
    text.erase(std::remove(text.begin(), text.end(), '\0'), text.end());
    return text;
}

std::optional<glm::dvec3> tripleAttribute(hid_t object, const char* name)
{
    if (H5Aexists(object, name) <= 0) return std::nullopt;
    const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    const Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
    glm::dvec3 values(0.0);
    if (!type.ok() || !space.ok() || !isNumber(type) || H5Sget_simple_extent_npoints(space) != 3 ||
        H5Aread(attribute, H5T_NATIVE_DOUBLE, &values.x) < 0)
        return std::nullopt;
    return values;
}

std::vector<glm::dvec3> triplesOf(hid_t file, const std::string& path)
{
    if (!exists(file, path)) return {};
    const Handle id(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
    const Handle type(H5Dget_type(id), H5Tclose), space(H5Dget_space(id), H5Sclose);
    if (!type.ok() || !isNumber(type) || H5Sget_simple_extent_ndims(space) != 2) return {};
    hsize_t size[2] = {};
    H5Sget_simple_extent_dims(space, size, nullptr);
    if (size[0] > MAXIMUM_TRIPLES || size[1] != 3) return {};
    std::vector<glm::dvec3> rows(size[0]);
    if (H5Dread(id, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()) < 0) return {};
    return rows;
}

} // namespace hdf5
} // namespace osgVolumizer
