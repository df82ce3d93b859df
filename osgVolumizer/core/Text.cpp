#include "Text.h"

#include <algorithm>
#include <charconv>

namespace osgVolumizer {
namespace core {

namespace {

constexpr std::string_view BLANKS = " \t\r\n\v\f";

template <class T>
bool parseWhole(std::string_view text, T& value)
{
    if (text.size() > 1 && text.front() == '+' && text[1] != '-') text.remove_prefix(1);
    T parsed{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), parsed);
    if (error != std::errc() || end != text.data() + text.size()) return false;
    value = parsed;
    return true;
}

} // namespace

bool parseNumber(std::string_view text, double& value)
{
    return parseWhole(text, value);
}

bool parseInteger(std::string_view text, std::int64_t& value)
{
    return parseWhole(text, value);
}

bool parseNumbers(std::string_view text, double* values, int count)
{
    const std::vector<std::string_view> pieces = splitText(text, ',');
    if (pieces.size() != static_cast<std::size_t>(count)) return false;
    for (std::size_t i = 0; i < pieces.size(); ++i)
        if (!parseNumber(pieces[i], values[i])) return false;
    return true;
}

std::vector<std::string_view> splitText(std::string_view text, char separator)
{
    std::vector<std::string_view> pieces;
    for (;;) {
        const std::size_t end = text.find(separator);
        pieces.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return pieces;
        text.remove_prefix(end + 1);
    }
}

std::vector<std::string_view> splitBlanks(std::string_view text)
{
    std::vector<std::string_view> pieces;
    for (;;) {
        const std::size_t start = text.find_first_not_of(BLANKS);
        if (start == std::string_view::npos) return pieces;
        text.remove_prefix(start);
        const std::size_t end = text.find_first_of(BLANKS);
        pieces.push_back(text.substr(0, end));
        if (end == std::string_view::npos) return pieces;
        text.remove_prefix(end);
    }
}

namespace {

// Takes what is quoted, or all up to one of `ends`, off the front of a text.
std::string takeWord(std::string_view& text, const std::string& ends, bool& closed)
{
    std::size_t first = 0, length = 0;
    if (!text.empty() && (text[0] == '"' || text[0] == '\'')) {
        const std::size_t end = text.find(text[0], 1);
        closed = end != std::string_view::npos;
        first = 1;
        length = closed ? end - 1 : text.size() - 1;
    } else {
        length = std::min(text.find_first_of(ends), text.size());
    }
    std::string word(text.substr(first, length));
    text.remove_prefix(std::min(text.size(), length + 2 * first));
    return word;
}

} // namespace

std::vector<Option> splitOptions(std::string_view text)
{
    std::vector<Option> options;
    while (true) {
        text.remove_prefix(std::min(text.find_first_not_of(BLANKS), text.size()));
        if (text.empty()) return options;
        Option option;
        const bool quoted = text[0] == '"' || text[0] == '\'';
        option.name = takeWord(text, std::string(BLANKS) + '=', option.closed);
        if (quoted) {
            const std::size_t equals = option.name.find('=');
            option.hasValue = equals != std::string::npos;
            if (option.hasValue) option.value = option.name.substr(equals + 1);
            option.name.resize(std::min(equals, option.name.size()));
        } else if (!text.empty() && text[0] == '=') {
            text.remove_prefix(1);
            option.hasValue = true;
            option.value = takeWord(text, std::string(BLANKS), option.closed);
        }
        options.push_back(std::move(option));
    }
}

std::string formatNumber(double value)
{
    char buffer[32];
    const auto result = std::to_chars(buffer, buffer + sizeof(buffer), value);
    return std::string(buffer, result.ptr);
}

std::string formatNumbers(const double* values, int count)
{
    std::string text;
    for (int i = 0; i < count; ++i)
        text += (i ? "," : "") + formatNumber(values[i]);
    return text;
}

std::string formatTriple(const glm::ivec3& v)
{
    return std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z);
}

std::string formatTriple(const glm::dvec3& v)
{
    return formatNumber(v.x) + "," + formatNumber(v.y) + "," + formatNumber(v.z);
}

} // namespace core
} // namespace osgVolumizer
