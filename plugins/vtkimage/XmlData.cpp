#include "XmlData.h"

#include <osgVolumizer/core/Text.h>

#include <vtkBase64Utilities.h>
#include <vtkType.h>

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

std::string textOf(vtkXMLDataElement& element, const char* name)
{
    const char* value = element.GetAttribute(name);
    return value ? value : "";
}

// Of base64, with padding.
std::int64_t lettersOf(std::int64_t bytes)
{
    return (bytes + 2) / 3 * 4;
}

bool isLetter(int c)
{
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '+' ||
           c == '/';
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
    _packed = !textOf(root, "compressor").empty();
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

bool XmlData::isEncoded(vtkXMLDataElement& array) const
{
    return textOf(array, "format") != "appended" || _encoded;
}

bool XmlData::readWords(std::int64_t position, bool encoded, std::int64_t count,
                        std::vector<std::uint64_t>& words)
{
    const std::int64_t word = _wide ? 8 : 4, bytes = count * word;
    std::vector<unsigned char> text, raw(static_cast<std::size_t>(lettersOf(bytes)));
    if (position < 0 || position + (encoded ? lettersOf(bytes) : bytes) > _bytes) return false;
    _stream.clear();
    _stream.seekg(position);
    if (encoded) text.resize(raw.size());
    _stream.read(reinterpret_cast<char*>(encoded ? text.data() : raw.data()),
                 static_cast<std::streamsize>(encoded ? lettersOf(bytes) : bytes));
    if (!_stream) return false;
    if (encoded && vtkBase64Utilities::DecodeSafely(text.data(), text.size(), raw.data(),
                                                    raw.size()) < std::size_t(bytes))
        return false;
    words.assign(static_cast<std::size_t>(count), 0);
    for (std::int64_t i = 0; i < bytes; ++i) {
        const std::int64_t at = i % word, shift = 8 * (_bigEndian ? word - 1 - at : at);
        words[std::size_t(i / word)] |= static_cast<std::uint64_t>(raw[std::size_t(i)]) << shift;
    }
    return true;
}

bool XmlData::isThere(std::int64_t position, bool encoded, std::int64_t bytes)
{
    if (bytes > _bytes || position < 0) return false;
    if (!encoded) return position + bytes <= _bytes;
    const std::int64_t padding = (3 - bytes % 3) % 3;
    _stream.clear();
    _stream.seekg(position);
    std::streambuf& buffer = *_stream.rdbuf();
    for (std::int64_t i = lettersOf(bytes); i > 0; --i) {
        const int c = buffer.sbumpc();
        if (i <= padding ? c != '=' : !isLetter(c)) return false;
    }
    return true;
}

// The number of blocks, the size of each, that of the last where it is another, and then how many
// bytes each has when packed.
bool XmlData::arePackedBlocks(std::int64_t position, bool encoded, std::int64_t bytes)
{
    std::vector<std::uint64_t> head;
    const auto most = static_cast<std::uint64_t>(_bytes);
    const std::int64_t word = _wide ? 8 : 4;
    if (!readWords(position, encoded, 3, head)) return false;
    const std::uint64_t blocks = head[0], size = head[1], last = head[2];
    if (blocks < 1 || blocks > most / std::uint64_t(word) || size > most << 14 || last > size)
        return false;
    const std::uint64_t whole = blocks - (last > 0 ? 1 : 0);
    if (whole > 0 && size > (std::uint64_t(1) << 62) / whole) return false;
    if (size * whole + last < static_cast<std::uint64_t>(bytes)) return false;
    const std::int64_t words = 3 + static_cast<std::int64_t>(blocks);
    if (!readWords(position, encoded, words, head)) return false;
    std::uint64_t packed = 0;
    for (std::size_t i = 3; i < head.size(); ++i) {
        if (head[i] > most - packed) return false;
        packed += head[i];
    }
    const std::int64_t headBytes = words * word;
    return isThere(position, encoded, headBytes) &&
           isThere(position + (encoded ? lettersOf(headBytes) : headBytes), encoded,
                   static_cast<std::int64_t>(packed));
}

bool XmlData::areBytes(std::int64_t position, bool encoded, std::int64_t bytes)
{
    std::vector<std::uint64_t> head;
    const std::int64_t word = _wide ? 8 : 4;
    if (!readWords(position, encoded, 1, head)) return false;
    return head[0] >= static_cast<std::uint64_t>(bytes) &&
           head[0] <= static_cast<std::uint64_t>(_bytes) &&
           isThere(position, encoded, word + static_cast<std::int64_t>(head[0]));
}

Status XmlData::check(vtkXMLDataElement& array, const XmlType& type, std::int64_t count)
{
    const bool ascii = textOf(array, "format") == "ascii";
    const std::int64_t words = type.bytes > 0 || ascii ? count : (count + 7) / 8;
    if (words < 1 || !type.isNumber()) return {};
    bool good = false;
    if (ascii) {
        double number = 0.0; // of any type
        _stream.clear();
        good =
            _parser.ReadInlineData(&array, 1, &number, vtkTypeUInt64(words - 1), 1, type.word) == 1;
    } else {
        const std::int64_t bytes = words * std::max(type.bytes, 1), position = positionOf(array);
        good = _packed ? arePackedBlocks(position, isEncoded(array), bytes)
                       : areBytes(position, isEncoded(array), bytes);
    }
    if (good) return {};
    return {ErrorCode::FILE_UNREADABLE, "array \"" + textOf(array, "Name") + "\" has fewer than " +
                                            std::to_string(count) + " numbers, or is damaged"};
}

} // namespace vtkimage
} // namespace osgVolumizer
