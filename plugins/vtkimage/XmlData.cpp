#include "XmlData.h"

#include <osgVolumizer/core/Text.h>

#include <vtkBase64Utilities.h>
#include <vtkLZ4DataCompressor.h>
#include <vtkLZMADataCompressor.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>
#include <vtkType.h>
#include <vtkZLibDataCompressor.h>

#include <algorithm>
#include <cctype>
#include <iterator>

namespace osgVolumizer {
namespace vtkimage {

namespace {

constexpr XmlType XML_TYPES[] = {
    {"Int8", 1, VTK_SIGNED_CHAR},  {"UInt8", 1, VTK_UNSIGNED_CHAR},
    {"Int16", 2, VTK_SHORT},       {"UInt16", 2, VTK_UNSIGNED_SHORT},
    {"Int32", 4, VTK_INT},         {"UInt32", 4, VTK_UNSIGNED_INT},
    {"Int64", 8, VTK_LONG_LONG},   {"UInt64", 8, VTK_UNSIGNED_LONG_LONG},
    {"Float32", 4, VTK_FLOAT},     {"Float64", 8, VTK_DOUBLE},
    {"Bit", 0, VTK_UNSIGNED_CHAR}, {"String", 1, 0}};

struct Compressor
{
    const char* name;
    std::int64_t density;
};
constexpr Compressor COMPRESSORS[] = {{"", 1},
                                      {"vtkZLibDataCompressor", 1 << 11},
                                      {"vtkLZ4DataCompressor", 1 << 9},
                                      {"vtkLZMADataCompressor", 1 << 14}};

vtkSmartPointer<vtkDataCompressor> compressorOf(const std::string& name)
{
    if (name == COMPRESSORS[1].name) return vtkSmartPointer<vtkZLibDataCompressor>::New();
    if (name == COMPRESSORS[2].name) return vtkSmartPointer<vtkLZ4DataCompressor>::New();
    if (name == COMPRESSORS[3].name) return vtkSmartPointer<vtkLZMADataCompressor>::New();
    return nullptr;
}

std::string textOf(vtkXMLDataElement& element, const char* name)
{
    const char* value = element.GetAttribute(name);
    return value ? value : "";
}

Status missing(vtkXMLDataElement& array, std::int64_t count)
{
    return {ErrorCode::FILE_UNREADABLE, "array \"" + textOf(array, "Name") + "\" has fewer than " +
                                            std::to_string(count) + " numbers"};
}

} // namespace

std::optional<XmlType> xmlTypeOf(const std::string& name)
{
    for (const XmlType& type : XML_TYPES)
        if (name == type.name) return type;
    return std::nullopt;
}

std::int64_t densityOf(const std::string& compressor)
{
    for (const Compressor& c : COMPRESSORS)
        if (compressor == c.name) return c.density;
    return 0;
}

XmlData::XmlData(vtkXMLDataParser& parser, std::ifstream& stream, std::int64_t fileBytes)
    : _parser(parser), _stream(stream), _bytes(fileBytes)
{
    vtkXMLDataElement& root = *parser.GetRootElement();
    _wide = textOf(root, "header_type") == "UInt64";
    _bigEndian = textOf(root, "byte_order") == "BigEndian";
    if (vtkXMLDataElement* appended = root.FindNestedElementWithName("AppendedData"))
        _encoded = textOf(*appended, "encoding") != "raw";
    parser.SetCompressor(compressorOf(textOf(root, "compressor")));
}

// Where its data begin; -1 where there are none.
std::int64_t XmlData::positionOf(vtkXMLDataElement& array)
{
    _stream.clear();
    std::int64_t offset = 0;
    if (textOf(array, "format") == "appended") {
        if (!core::parseInteger(textOf(array, "offset"), offset) || offset < 0 || offset > _bytes)
            return -1;
        return _parser.GetAppendedDataPosition() + offset;
    }
    char c = 0;
    _stream.seekg(array.GetXMLByteIndex());
    while (_stream.get(c) && c != '>') {
    }
    while (_stream.get(c) && std::isspace(static_cast<unsigned char>(c))) {
    }
    return _stream ? static_cast<std::int64_t>(_stream.tellg()) - 1 : -1;
}

// Their number, the size of each, the size of the last where that is another.
Status XmlData::checkBlocks(vtkXMLDataElement& array, std::int64_t bytes)
{
    const Status damaged(ErrorCode::FILE_UNREADABLE, "the compressed blocks of array \"" +
                                                         textOf(array, "Name") +
                                                         "\" do not add up");
    const std::int64_t position = positionOf(array);
    const std::size_t word = _wide ? 8 : 4;
    unsigned char text[32] = {}, raw[24] = {};
    const bool encoded = textOf(array, "format") != "appended" || _encoded;
    _stream.clear();
    _stream.seekg(position);
    _stream.read(reinterpret_cast<char*>(encoded ? text : raw),
                 static_cast<std::streamsize>(encoded ? 4 * word : 3 * word));
    if (position < 0 || !_stream) return damaged;
    if (encoded && vtkBase64Utilities::DecodeSafely(text, 4 * word, raw, 3 * word) != 3 * word)
        return damaged;
    std::uint64_t head[3] = {};
    for (std::size_t i = 0; i < 3 * word; ++i) {
        const std::size_t at = i % word, shift = 8 * (_bigEndian ? word - 1 - at : at);
        head[i / word] |= static_cast<std::uint64_t>(raw[i]) << shift;
    }
    const auto most = static_cast<std::uint64_t>(_bytes);
    if (head[0] < 1 || head[0] > most / word || head[1] > most << 14 || head[2] > head[1])
        return damaged;
    const std::uint64_t whole = head[0] - (head[2] > 0 ? 1 : 0);
    if (whole > 0 && head[1] > (std::uint64_t(1) << 62) / whole) return damaged;
    return head[1] * whole + head[2] < static_cast<std::uint64_t>(bytes) ? damaged : Status();
}

Status XmlData::check(vtkXMLDataElement& array, const XmlType& type, std::int64_t count)
{
    const std::string format = textOf(array, "format");
    const bool ascii = format == "ascii";
    const std::int64_t words = type.bytes > 0 || ascii ? count : (count + 7) / 8;
    if (words < 1 || !type.isNumber()) return {};
    if (_parser.GetCompressor() && !ascii)
        if (Status status = checkBlocks(array, words * std::max(type.bytes, 1)); !status.ok())
            return status;
    _stream.clear();
    double number = 0.0; // of any type
    const auto last = static_cast<vtkTypeUInt64>(words - 1);
    std::int64_t offset = 0;
    if (format != "appended")
        return _parser.ReadInlineData(&array, ascii, &number, last, 1, type.word) == 1
                   ? Status()
                   : missing(array, count);
    return core::parseInteger(textOf(array, "offset"), offset) && offset >= 0 && offset <= _bytes &&
                   _parser.ReadAppendedData(offset, &number, last, 1, type.word) == 1
               ? Status()
               : missing(array, count);
}

} // namespace vtkimage
} // namespace osgVolumizer
