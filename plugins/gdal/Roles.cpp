#include "Roles.h"

#include "Session.h"

#include <osgVolumizer/core/Text.h>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <string_view>

namespace osgVolumizer {
namespace gdal {

namespace {

constexpr int X = 0, Y = 1, Z = 2, TIME = 3, UNKNOWN = -1;

struct Word
{
    std::string_view text; ///< in lower case
    int role;
};

template <std::size_t COUNT>
int lookUp(const Word (&words)[COUNT], const std::string& text)
{
    const auto* word = std::find_if(std::begin(words), std::end(words),
                                    [&](const Word& w) { return w.text == text; });
    return word == std::end(words) ? UNKNOWN : word->role;
}

constexpr Word TYPES[] = {
    {"horizontal_x", X}, {"horizontal_y", Y}, {"vertical", Z}, {"temporal", TIME}};
constexpr Word AXES[] = {{"x", X}, {"y", Y}, {"z", Z}, {"t", TIME}};
constexpr Word STANDARD_NAMES[] = {{"longitude", X},
                                   {"grid_longitude", X},
                                   {"projection_x_coordinate", X},
                                   {"latitude", Y},
                                   {"grid_latitude", Y},
                                   {"projection_y_coordinate", Y},
                                   {"depth", Z},
                                   {"height", Z},
                                   {"altitude", Z},
                                   {"air_pressure", Z},
                                   {"model_level_number", Z},
                                   {"time", TIME}};
constexpr Word UNITS[] = {{"degrees_east", X},  {"degree_east", X},  {"degrees_e", X},
                          {"degree_e", X},      {"degreese", X},     {"degreee", X},
                          {"degrees_north", Y}, {"degree_north", Y}, {"degrees_n", Y},
                          {"degree_n", Y},      {"degreesn", Y},     {"degreen", Y}};
constexpr Word NAMES[] = {{"x", X},       {"lon", X},      {"longitude", X}, {"rlon", X},
                          {"easting", X}, {"y", Y},        {"lat", Y},       {"latitude", Y},
                          {"rlat", Y},    {"northing", Y}, {"z", Z},         {"lev", Z},
                          {"level", Z},   {"depth", Z},    {"height", Z},    {"altitude", Z},
                          {"alt", Z},     {"plev", Z},     {"pressure", Z},  {"t", TIME},
                          {"time", TIME}};

int roleBySigns(const GDALMDArray& coordinates)
{
    const auto lower = [](const std::string& text) { return osgDB::convertToLowerCase(text); };
    if (const int role = lookUp(AXES, lower(textAttribute(coordinates, "axis"))); role != UNKNOWN)
        return role;
    const std::string name = lower(textAttribute(coordinates, "standard_name"));
    if (const int role = lookUp(STANDARD_NAMES, name); role != UNKNOWN) return role;
    if (name.rfind("atmosphere_", 0) == 0 || name.rfind("ocean_", 0) == 0) return Z;
    const std::string unit = lower(unitOf(coordinates));
    if (unit.find(" since ") != std::string::npos) return TIME;
    if (!textAttribute(coordinates, "positive").empty()) return Z;
    return lookUp(UNITS, unit);
}

int roleSaid(const Variable& variable, const GDALDimension& dimension)
{
    const Array coordinates = coordinateArray(*variable.group, dimension);
    if (coordinates)
        if (const int role = roleBySigns(*coordinates); role != UNKNOWN) return role;
    return lookUp(NAMES, osgDB::convertToLowerCase(dimension.GetName()));
}

// GDAL takes whatever has a length for upright: that says something of one dimension alone.
int roleByType(const std::vector<Dimension>& dimensions, const GDALDimension& dimension)
{
    const auto typed = [](const GDALDimension& d) {
        return lookUp(TYPES, osgDB::convertToLowerCase(d.GetType()));
    };
    const int role = typed(dimension);
    if (role != Z) return role;
    const auto upright = std::count_if(dimensions.begin(), dimensions.end(),
                                       [&](const Dimension& d) { return typed(*d) == Z; });
    return upright == 1 ? Z : UNKNOWN;
}

std::string namesOf(const std::vector<Dimension>& dimensions)
{
    std::string names;
    for (const Dimension& dimension : dimensions)
        names += (names.empty() ? "" : ", ") + dimension->GetName();
    return oneLine(names);
}

} // namespace

bool Roles::has(int dimension) const
{
    return std::find(of.begin(), of.end(), dimension) != of.end();
}

Roles rolesOf(const Variable& variable)
{
    const auto& dimensions = variable.array->GetDimensions();
    const auto sizeOf = [&](int i) { return dimensions[std::size_t(i)]->GetSize(); };
    Roles roles;
    const int count = int(dimensions.size());
    for (int i = 0; i < count; ++i) {
        const int role = roleSaid(variable, *dimensions[std::size_t(i)]);
        if (role == UNKNOWN) continue;
        int& taken = roles.of[std::size_t(role)];
        if (taken < 0 || sizeOf(i) > sizeOf(taken)) taken = i;
    }
    for (int i = 0; i < count; ++i) {
        if (roles.has(i)) continue;
        const int role = roleByType(dimensions, *dimensions[std::size_t(i)]);
        if (role != UNKNOWN && roles.of[std::size_t(role)] < 0) roles.of[std::size_t(role)] = i;
    }
    for (int i = count - 1; i >= 0; --i) {
        if (roles.has(i) || sizeOf(i) < 2) continue;
        const auto free = std::find(roles.of.begin(), roles.of.end(), -1);
        if (free != roles.of.end()) *free = i;
    }
    // A picture of a level over time is no volume of one row.
    const auto isLong = [&](int role) {
        const int i = roles.of[std::size_t(role)];
        return i >= 0 && sizeOf(i) > 1;
    };
    if (isLong(X) + isLong(Y) + isLong(Z) < 2 && isLong(TIME))
        for (const int role : {X, Y, Z})
            if (!isLong(role)) {
                std::swap(roles.of[std::size_t(role)], roles.of[TIME]);
                break;
            }
    return roles;
}

Result<Roles> rolesOf(const Variable& variable, const std::string& said)
{
    const auto& dimensions = variable.array->GetDimensions();
    Roles roles;
    std::size_t role = 0;
    for (const std::string_view name : core::splitText(said, ',')) {
        if (role >= roles.of.size())
            return Status(ErrorCode::VALUE_INVALID, "dimensions=" + said + " are more than four");
        if (name.empty()) {
            ++role;
            continue;
        }
        const auto found =
            std::find_if(dimensions.begin(), dimensions.end(), [&](const Dimension& d) {
                return d->GetName() == name || d->GetFullName() == name;
            });
        if (found == dimensions.end())
            return Status(ErrorCode::VALUE_INVALID, variable.path + " has no dimension \"" +
                                                        std::string(name) + "\": there are " +
                                                        namesOf(dimensions));
        const int index = int(found - dimensions.begin());
        if (roles.has(index))
            return Status(ErrorCode::VALUE_INVALID,
                          "dimensions=" + said + " says " + std::string(name) + " twice");
        roles.of[role++] = index;
    }
    return roles;
}

} // namespace gdal
} // namespace osgVolumizer
