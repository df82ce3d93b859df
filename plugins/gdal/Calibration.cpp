#include "Calibration.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace gdal {

namespace {

// Whether any number of the array's type can be one of the calibration's.
bool canBe(const GDALMDArray& array, double value)
{
    double low = 0.0, high = 0.0;
    const VoxelType type = typeOf(array);
    if (type >= VoxelType::HALF) return !std::isnan(value);
    voxelTypeRange(type, low, high);
    return value >= low && value <= high && value == std::floor(value);
}

void addMissing(const GDALMDArray& array, const std::vector<double>& values, Calibration& c)
{
    for (const double value : values)
        if (canBe(array, value)) c.missing.push_back(value);
}

void findValid(const GDALMDArray& array, Calibration& c)
{
    const std::vector<double> range = numberAttribute(array, "valid_range"),
                              low = numberAttribute(array, "valid_min"),
                              high = numberAttribute(array, "valid_max");
    if (range.size() == 2) {
        c.low = range[0];
        c.high = range[1];
    }
    if (low.size() == 1) c.low = low[0];
    if (high.size() == 1) c.high = high[0];
    // What holds for every number says nothing.
    const VoxelType type = typeOf(array);
    double least = 0.0, most = 0.0;
    voxelTypeRange(type, least, most);
    if (type < VoxelType::HALF && c.low <= least) c.low = -std::numeric_limits<double>::infinity();
    if (type < VoxelType::HALF && c.high >= most) c.high = std::numeric_limits<double>::infinity();
    if (!(c.low <= c.high)) {
        c.low = -std::numeric_limits<double>::infinity();
        c.high = std::numeric_limits<double>::infinity();
    }
}

// NC_FILL_SHORT and the like, unless the file itself says what is missing.
std::optional<double> fillingOf(const GDALMDArray& array)
{
    bool said = false;
    array.GetNoDataValueAsDouble(&said);
    for (const char* name :
         {"_FillValue", "missing_value", "valid_range", "valid_min", "valid_max"})
        said = said || array.GetAttribute(name);
    if (said) return std::nullopt;
    switch (array.GetDataType().GetNumericDataType()) {
    case GDT_Int16:
        return -32767.0;
    case GDT_UInt16:
        return 65535.0;
    case GDT_Int32:
        return -2147483647.0;
    case GDT_UInt32:
        return 4294967295.0;
    default:
        return std::nullopt;
    }
}

} // namespace

bool Calibration::hasHoles() const
{
    return !missing.empty() || std::isfinite(low) || std::isfinite(high);
}

void Calibration::apply(double* values, std::size_t count) const
{
    for (double* v = values; v != values + count; ++v) {
        const bool hole = !(*v >= low && *v <= high) ||
                          std::find(missing.begin(), missing.end(), *v) != missing.end();
        *v = hole ? std::numeric_limits<double>::quiet_NaN() : *v * scale + offset;
    }
}

Calibration calibrationOf(const GDALMDArray& array, const std::string& driver)
{
    constexpr double NETCDF_FILL = 9.9692099683868690e+36; // of floats, NC_FILL_FLOAT
    Calibration c;
    bool known = false;
    const auto number = [&array](const char* name, double otherwise) {
        const std::vector<double> values = numberAttribute(array, name);
        return values.size() == 1 && std::isfinite(values[0]) ? values[0] : otherwise;
    };
    const double scale = array.GetScale(&known);
    c.scale = known && std::isfinite(scale) ? scale : number("scale_factor", 1.0);
    const double offset = array.GetOffset(&known);
    c.offset = known && std::isfinite(offset) ? offset : number("add_offset", 0.0);
    const double fill = array.GetNoDataValueAsDouble(&known);
    if (known && !(driver == "Zarr" && fill == 0.0)) addMissing(array, {fill}, c);
    addMissing(array, numberAttribute(array, "_FillValue"), c);
    addMissing(array, numberAttribute(array, "missing_value"), c);
    const GDALDataType type = array.GetDataType().GetNumericDataType();
    const bool floats = type == GDT_Float32 || type == GDT_Float64;
    if (driver == "netCDF" && floats && c.missing.empty()) addMissing(array, {NETCDF_FILL}, c);
    c.asFloat = typeOf(array) == VoxelType::FLOAT32;
    if (c.asFloat)
        for (double& value : c.missing)
            value = static_cast<float>(value);
    std::sort(c.missing.begin(), c.missing.end());
    c.missing.erase(std::unique(c.missing.begin(), c.missing.end()), c.missing.end());
    findValid(array, c);
    if (driver != "netCDF" || c.hasHoles()) return c;
    // Values that are floats anyway have room for holes.
    if (c.isPlain())
        c.filling = fillingOf(array);
    else if (const auto filling = fillingOf(array))
        c.missing.push_back(*filling);
    return c;
}

VoxelType typeOf(const GDALMDArray& array)
{
    switch (array.GetDataType().GetNumericDataType()) {
    case GDT_Byte:
        return VoxelType::UINT8;
#if GDAL_VERSION_NUM >= 3070000
    case GDT_Int8:
        return VoxelType::INT8;
#endif
    case GDT_UInt16:
        return VoxelType::UINT16;
    case GDT_Int16:
        return VoxelType::INT16;
    case GDT_UInt32:
        return VoxelType::UINT32;
    case GDT_Int32:
        return VoxelType::INT32;
    case GDT_Float32:
        return VoxelType::FLOAT32;
    default:
        return VoxelType::FLOAT64;
    }
}

GDALDataType gdalType(VoxelType type)
{
    switch (type) {
#if GDAL_VERSION_NUM >= 3070000
    case VoxelType::INT8:
        return GDT_Int8;
#endif
    case VoxelType::UINT8:
        return GDT_Byte;
    case VoxelType::UINT16:
        return GDT_UInt16;
    case VoxelType::INT16:
        return GDT_Int16;
    case VoxelType::UINT32:
        return GDT_UInt32;
    case VoxelType::INT32:
        return GDT_Int32;
    case VoxelType::FLOAT32:
        return GDT_Float32;
    default:
        return GDT_Float64;
    }
}

VoxelType valueType(VoxelType numbers, const Calibration& calibration, bool interpolated)
{
    if (calibration.isPlain() && !interpolated) return numbers;
    const bool scaled = calibration.scale != 1.0 || calibration.offset != 0.0 || interpolated;
    const bool wide = numbers == VoxelType::INT32 || numbers == VoxelType::UINT32;
    if (numbers == VoxelType::FLOAT64 || (wide && !scaled)) return VoxelType::FLOAT64;
    return VoxelType::FLOAT32;
}

} // namespace gdal
} // namespace osgVolumizer
