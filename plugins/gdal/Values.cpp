#include "Values.h"

namespace osgVolumizer {
namespace gdal {

namespace {

constexpr GUInt64 MOST_OF_ATTRIBUTE = 4096, MOST_COORDINATES = GUInt64(1) << 24;

bool isCoordinates(const Array& array, const GDALDimension& dimension)
{
    return array && isNumeric(*array) && array->GetDimensionCount() == 1 &&
           array->GetDimensions()[0]->GetSize() == dimension.GetSize();
}

} // namespace

std::string textAttribute(const GDALMDArray& array, const char* name)
{
    const auto attribute = array.GetAttribute(name);
    if (!attribute || attribute->GetDataType().GetClass() != GEDTC_STRING ||
        attribute->GetTotalElementsCount() != 1)
        return {};
    const char* text = attribute->ReadAsString();
    return text ? text : "";
}

std::vector<double> numberAttribute(const GDALMDArray& array, const char* name)
{
    const auto attribute = array.GetAttribute(name);
    if (!attribute || attribute->GetDataType().GetClass() != GEDTC_NUMERIC ||
        attribute->GetTotalElementsCount() > MOST_OF_ATTRIBUTE)
        return {};
    return attribute->ReadAsDoubleArray();
}

std::string unitOf(const GDALMDArray& array)
{
    const std::string& unit = array.GetUnit();
    return unit.empty() ? textAttribute(array, "units") : unit;
}

bool isNumeric(const GDALMDArray& array)
{
    const GDALExtendedDataType& type = array.GetDataType();
    return type.GetClass() == GEDTC_NUMERIC && type.GetNumericDataType() != GDT_Unknown &&
           !GDALDataTypeIsComplex(type.GetNumericDataType());
}

Array coordinateArray(const GDALGroup& group, const GDALDimension& dimension)
{
    if (Array array = dimension.GetIndexingVariable(); isCoordinates(array, dimension))
        return array;
    Array array = group.OpenMDArray(dimension.GetName());
    return isCoordinates(array, dimension) ? array : nullptr;
}

std::vector<double> coordinateValues(const GDALMDArray& array)
{
    const GUInt64 count = array.GetTotalElementsCount();
    if (count == 0 || count > MOST_COORDINATES) return {};
    std::vector<double> values(count);
    const GUInt64 start = 0;
    const size_t number = count;
    if (!array.Read(&start, &number, nullptr, nullptr, GDALExtendedDataType::Create(GDT_Float64),
                    values.data()))
        return {};
    const double scale = array.GetScale(), offset = array.GetOffset();
    for (double& value : values)
        value = value * scale + offset;
    return values;
}

} // namespace gdal
} // namespace osgVolumizer
