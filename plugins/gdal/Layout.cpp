#include "Layout.h"

#include "Session.h"

#include <osgVolumizer/core/Text.h>
#include <osgVolumizer/io/Placement.h>

#include <osgDB/FileNameUtils>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

namespace osgVolumizer {
namespace gdal {

namespace {

constexpr double METRES_PER_DEGREE = 111195.0;  // of a sphere with a radius of 6371 km
constexpr double MOST_PER_PIECE = 4294967296.0; // bytes
constexpr std::int64_t MOST_INTERPOLATED = std::int64_t(1) << 36; // bytes

bool isDegrees(const std::string& unit)
{
    return osgDB::convertToLowerCase(unit).rfind("degree", 0) == 0;
}

std::optional<double> metresOf(const std::string& unit)
{
    const std::string lower = osgDB::convertToLowerCase(unit);
    for (const char* name : {"m", "metre", "metres", "meter", "meters"})
        if (lower == name) return 1.0;
    for (const char* name : {"km", "kilometre", "kilometres", "kilometer", "kilometers"})
        if (lower == name) return 1000.0;
    return std::nullopt;
}

void scale(Axis& axis, double factor)
{
    axis.first *= factor;
    axis.step *= factor;
}

double extent(const Axis& axis)
{
    return std::fabs(axis.step) * (axis.size - 1);
}

// Kilometres beside metres; true where all three are lengths, and nothing is left to do.
bool matchLengths(Layout& layout)
{
    double metres[3];
    for (int axis = 0; axis < 3; ++axis) {
        const auto length = metresOf(layout.axes[axis].unit);
        if (!length) return false;
        metres[axis] = *length;
    }
    if (metres[0] == metres[1] && metres[1] == metres[2]) return true;
    std::string units;
    for (int axis = 0; axis < 3; ++axis) {
        scale(layout.axes[axis], metres[axis]);
        units += (axis ? ", " : "") + layout.axes[axis].unit;
    }
    layout.notices.push_back("coordinates in " + units +
                             " become metres along all axes; spacing= says otherwise");
    return true;
}

// Degrees beside metres, or either beside a pressure, make a volume that nobody sees.
void matchUnits(Layout& layout)
{
    Axis &x = layout.axes[0], &y = layout.axes[1], &z = layout.axes[2];
    if (!x.known || !y.known || !z.known || matchLengths(layout)) return;
    const bool degrees = isDegrees(x.unit) && isDegrees(y.unit);
    const bool lengths = metresOf(x.unit) && metresOf(x.unit) == metresOf(y.unit);
    if ((!degrees && !lengths) || isDegrees(z.unit)) return;
    if (const auto metres = metresOf(z.unit)) {
        const double latitude = (y.first + 0.5 * y.step * (y.size - 1)) * std::acos(-1.0) / 180.0;
        scale(x, METRES_PER_DEGREE * std::max(std::cos(latitude), 0.01));
        scale(y, METRES_PER_DEGREE);
        scale(z, *metres);
        layout.notices.push_back(
            "degrees become metres along the axes, as at latitude " +
            core::formatNumber(y.first / METRES_PER_DEGREE +
                               0.5 * y.step / METRES_PER_DEGREE * (y.size - 1)) +
            ", to go with " + z.name + "; spacing= says otherwise");
        return;
    }
    constexpr double FLAT = 20.0, SHAPELY = 0.25; // to the longer of the others
    const double across = std::max(extent(x), extent(y)), up = extent(z);
    if (!(up > 0.0) || !(across > 0.0) || (up * FLAT > across && up < across * FLAT)) return;
    const double factor = SHAPELY * across / up;
    scale(z, factor);
    layout.notices.push_back(z.name + (z.unit.empty() ? "" : " (" + z.unit + ")") + " is drawn " +
                             core::formatNumber(factor) + " times as long, to go with " +
                             (degrees ? "degrees" : x.unit) + "; spacing= says otherwise");
}

// As it says itself, or as pressures and depths are.
bool isPositiveDown(const GDALMDArray& coordinates)
{
    const auto lower = [](const std::string& text) { return osgDB::convertToLowerCase(text); };
    const std::string positive = lower(textAttribute(coordinates, "positive"));
    if (positive == "down" || positive == "up") return positive == "down";
    const std::string unit = lower(unitOf(coordinates));
    for (const char* name :
         {"pa", "hpa", "mbar", "mb", "millibar", "millibars", "bar", "dbar", "kpa"})
        if (unit == name) return true;
    return lower(textAttribute(coordinates, "standard_name")) == "depth" ||
           lower(coordinates.GetName()) == "depth";
}

// How exactly the file holds coordinates: doubles may have been floats before.
double precisionOf(const GDALMDArray& coordinates, const std::vector<double>& values)
{
    constexpr double OF_FLOATS = std::numeric_limits<float>::epsilon();
    if (typeOf(coordinates) == VoxelType::FLOAT32) return OF_FLOATS;
    bool whole = true, floats = true;
    for (const double value : values) {
        whole = whole && value == std::floor(value);
        floats = floats && value == double(static_cast<float>(value));
    }
    return floats && !whole ? OF_FLOATS : std::numeric_limits<double>::epsilon();
}

Axis axisOf(const Variable& variable, int dimension, bool upright, double samplesOfOthers,
            std::vector<std::string>& notices)
{
    Axis axis;
    if (dimension < 0) return axis;
    const GDALDimension& d = *variable.array->GetDimensions()[std::size_t(dimension)];
    axis.dimension = dimension;
    axis.samples = axis.size = int(d.GetSize());
    axis.name = oneLine(d.GetName());
    const Array coordinates = coordinateArray(*variable.group, d);
    if (!coordinates) return axis;
    axis.unit = oneLine(unitOf(*coordinates));
    const double most = double(MOST_INTERPOLATED) / 8.0 / std::max(samplesOfOthers, 1.0);
    std::vector<double> values = coordinateValues(*coordinates);
    const double precision = precisionOf(*coordinates, values);
    if (!upright && isDegrees(axis.unit)) unwrapDegrees(values);
    placeSamples(axis, values, precision,
                 int(std::min(most, double(std::numeric_limits<int>::max()))), notices);
    if (upright && isPositiveDown(*coordinates)) scale(axis, -1.0);
    return axis;
}

Status checkSizes(const Variable& variable)
{
    for (const Dimension& d : variable.array->GetDimensions())
        if (d->GetSize() > GUInt64(std::numeric_limits<int>::max()))
            return {ErrorCode::TOO_LARGE, variable.path + " has " + std::to_string(d->GetSize()) +
                                              " samples along " + oneLine(d->GetName()) +
                                              ", more than 2147483647"};
    double piece = double(variable.array->GetDataType().GetSize());
    for (const GUInt64 length : variable.array->GetBlockSize())
        piece *= double(std::max<GUInt64>(length, 1));
    if (piece > MOST_PER_PIECE)
        return {ErrorCode::TOO_LARGE, variable.path + " is stored in pieces of " +
                                          core::formatNumber(piece) +
                                          " bytes, each of which has to be in memory"};
    return {};
}

void placeAxes(const Variable& variable, const Roles& roles, Layout& layout)
{
    double samples = 1.0;
    const auto& dimensions = variable.array->GetDimensions();
    for (int axis = 0; axis < 3; ++axis)
        if (const int i = roles.of[std::size_t(axis)]; i >= 0)
            samples *= double(dimensions[std::size_t(i)]->GetSize());
    for (int axis = 0; axis < 3; ++axis) {
        const int i = roles.of[std::size_t(axis)];
        const double own = i < 0 ? 1.0 : double(dimensions[std::size_t(i)]->GetSize());
        layout.axes[axis] = axisOf(variable, i, axis == 2, samples / own, layout.notices);
    }
    matchUnits(layout);
    if (!layout.axes[0].known && !layout.axes[1].known &&
        !textAttribute(*variable.array, "coordinates").empty())
        layout.notices.push_back("coordinates that are no axes (a curvilinear grid) are not used");
}

// An axis of one sample is as thick as the others' steps.
Status placeVoxels(Layout& layout)
{
    double shortest = std::numeric_limits<double>::infinity();
    for (const Axis& axis : layout.axes)
        if (axis.size > 1) shortest = std::min(shortest, std::fabs(axis.step));
    glm::dmat3 steps(0.0);
    glm::dvec3 first(0.0);
    for (int i = 0; i < 3; ++i) {
        const Axis& axis = layout.axes[i];
        layout.description.size[i] = axis.size;
        steps[i][i] = axis.size > 1 ? axis.step : shortest;
        first[i] = axis.first;
    }
    return io::place(layout.description, steps, first);
}

void findTime(const Variable& variable, const Roles& roles, Layout& layout)
{
    const auto& dimensions = variable.array->GetDimensions();
    for (int i = 0; i < int(dimensions.size()); ++i) {
        const GDALDimension& d = *dimensions[std::size_t(i)];
        if (!roles.has(i) && d.GetSize() > 1)
            layout.notices.push_back("of the " + std::to_string(d.GetSize()) + " along " +
                                     oneLine(d.GetName()) + " the first is read");
    }
    const int time = roles.of[3];
    if (time < 0 || dimensions[std::size_t(time)]->GetSize() < 2) return;
    layout.time = time;
    layout.steps = int(dimensions[std::size_t(time)]->GetSize());
}

} // namespace

Result<Layout> layoutOf(const Variable& variable, const std::string& dimensions,
                        const std::string& driver)
{
    if (Status status = checkSizes(variable); !status.ok()) return status;
    const Result<Roles> roles =
        dimensions.empty() ? Result<Roles>(rolesOf(variable)) : rolesOf(variable, dimensions);
    if (!roles.ok()) return roles.status;
    Layout layout;
    findTime(variable, *roles, layout);
    placeAxes(variable, *roles, layout);
    if (Status status = placeVoxels(layout); !status.ok()) return status;
    layout.numbers = typeOf(*variable.array);
    layout.calibration = calibrationOf(*variable.array, driver);
    bool interpolated = false;
    for (const Axis& axis : layout.axes)
        interpolated = interpolated || !axis.places.empty();
    if (interpolated && layout.calibration.filling) {
        layout.calibration.missing = {*layout.calibration.filling};
        layout.calibration.filling.reset();
    }
    layout.description.type = valueType(layout.numbers, layout.calibration, interpolated);
    if (Status status = layout.description.validate(); !status.ok()) return status;
    return layout;
}

} // namespace gdal
} // namespace osgVolumizer
