#include "LegacyText.h"

#include <osgVolumizer/core/Text.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

namespace osgVolumizer {
namespace vtkimage {

namespace {

constexpr std::size_t LONGEST = 1024;
constexpr int END = std::filebuf::traits_type::eof();

bool isBlank(int c)
{
    return c == ' ' || (c >= '\t' && c <= '\r');
}

struct LegacyType
{
    const char* name;
    int bits;
};
constexpr LegacyType TYPES[] = {{"bit", 1},
                                {"char", 8},
                                {"signed_char", 8},
                                {"unsigned_char", 8},
                                {"short", 16},
                                {"unsigned_short", 16},
                                {"int", 32},
                                {"unsigned_int", 32},
                                {"long", 8 * sizeof(long)},
                                {"unsigned_long", 8 * sizeof(long)},
                                {"vtktypeint64", 64},
                                {"vtktypeuint64", 64},
                                {"vtkidtype", 32},
                                {"float", 32},
                                {"double", 64},
                                {"string", -1},
                                {"utf8_string", -1}};

} // namespace

LegacyText::LegacyText(const std::string& path)
{
    if (!_file.open(path, std::ios::in | std::ios::binary)) return;
    _bytes = std::max<std::int64_t>(_file.pubseekoff(0, std::ios::end), 0);
    _file.pubseekpos(0);
}

int LegacyText::bitsOf(const std::string& type)
{
    for (const LegacyType& t : TYPES)
        if (type == t.name) return t.bits;
    return 0;
}

std::int64_t LegacyText::left()
{
    return _bytes - static_cast<std::int64_t>(_file.pubseekoff(0, std::ios::cur, std::ios::in));
}

std::string LegacyText::word()
{
    std::string text;
    while (isBlank(_file.sgetc()))
        _file.sbumpc();
    for (int c = _file.sgetc(); c != END && !isBlank(c) && text.size() < LONGEST;
         c = _file.snextc())
        text += static_cast<char>(c);
    return text;
}

std::string LegacyText::keyword()
{
    std::string text = word();
    for (char& c : text)
        c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

bool LegacyText::number(std::int64_t& value)
{
    return core::parseInteger(word(), value);
}

bool LegacyText::line(std::string& text)
{
    text.clear();
    if (_file.sgetc() == END) return false;
    for (int c = _file.sbumpc(); c != END && c != '\n' && text.size() < LONGEST; c = _file.sbumpc())
        if (c != '\r') text += static_cast<char>(c);
    return true;
}

bool LegacyText::skipWords(std::int64_t count)
{
    if (count > (left() + 1) / 2) return false; // a digit and a blank each
    for (std::int64_t i = 0; i < count; ++i) {
        const std::string text = word();
        double value = 0.0;
        const bool sign = text.size() > 1 && text[0] == '+';
        if (text.empty()) return false;
        if (core::parseNumber(std::string_view(text).substr(sign ? 1 : 0), value) &&
            std::isfinite(value))
            continue;
        _noNumber = text;
        return false;
    }
    return true;
}

bool LegacyText::skipBytes(std::int64_t count)
{
    if (count > left()) return false;
    _file.pubseekoff(count, std::ios::cur, std::ios::in);
    return true;
}

// As text a line each; else each behind its length, whose first two bits say how long that is.
bool LegacyText::skipTexts(std::int64_t count, bool binary)
{
    if (count > left()) return false;
    std::string text;
    for (std::int64_t i = 0; i < count; ++i) {
        if (!binary) {
            if (!line(text)) return false;
            continue;
        }
        const int first = _file.sbumpc();
        if (first == END) return false;
        std::int64_t length = first & 63;
        constexpr int MORE[] = {7, 3, 1, 0};
        for (int b = 0; b < MORE[first >> 6]; ++b)
            length = length << 8 | (_file.sbumpc() & 255);
        if (!skipBytes(length)) return false;
    }
    return true;
}

bool LegacyText::skip(const std::string& type, std::int64_t count, bool binary)
{
    const int bits = bitsOf(type);
    if (count < 0 || bits == 0 || count / 8 > _bytes) return false;
    std::string rest;
    if (binary || bits < 0) line(rest);
    if (bits < 0) return skipTexts(count, binary);
    return binary ? skipBytes((count * bits + 7) / 8) : skipWords(count);
}

} // namespace vtkimage
} // namespace osgVolumizer
