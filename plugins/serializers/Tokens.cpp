#include "Tokens.h"

#include <charconv>
#include <cstring>

namespace osgVolumizer {
namespace serializers {
namespace {

const char alphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

bool plain(char c)
{
    const bool alphanumeric =
        (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    return alphanumeric || (c != '\0' && std::strchr("_./,:;=+*#", c));
}

int hexDigit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return -1;
}

// -1 for anything else.
int base64Digit(char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

template <class T>
bool parse(const std::string& token, T& value)
{
    const char* end = token.data() + token.size();
    const auto result = std::from_chars(token.data(), end, value);
    return !token.empty() && result.ec == std::errc() && result.ptr == end;
}

} // namespace

std::string escaped(const std::string& text)
{
    static const char digits[] = "0123456789ABCDEF";
    std::string result;
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (plain(c))
            result += c;
        else
            result += {'%', digits[byte >> 4], digits[byte & 15]};
    }
    return result;
}

bool unescape(const std::string& token, std::string& text)
{
    text.clear();
    for (std::size_t i = 0; i < token.size(); ++i) {
        if (token[i] != '%') {
            text += token[i];
            continue;
        }
        if (i + 2 >= token.size()) return false;
        const int high = hexDigit(token[i + 1]), low = hexDigit(token[i + 2]);
        if (high < 0 || low < 0) return false;
        text += static_cast<char>(16 * high + low);
        i += 2;
    }
    return true;
}

std::string base64(const unsigned char* data, std::size_t size)
{
    std::string result;
    result.reserve((size + 2) / 3 * 4);
    for (std::size_t i = 0; i < size; i += 3) {
        const std::size_t n = size - i < 3 ? size - i : 3;
        std::uint32_t bits = std::uint32_t(data[i]) << 16;
        if (n > 1) bits |= std::uint32_t(data[i + 1]) << 8;
        if (n > 2) bits |= data[i + 2];
        for (std::size_t d = 0; d < 4; ++d)
            result += d <= n ? alphabet[(bits >> (18 - 6 * d)) & 63] : '=';
    }
    return result;
}

bool appendBase64(const std::string& token, std::vector<unsigned char>& data)
{
    if (token.empty() || token.size() % 4 != 0) return false;
    for (std::size_t i = 0; i < token.size(); i += 4) {
        const bool last = i + 4 == token.size();
        const int padding = !last || token[i + 3] != '=' ? 0 : token[i + 2] == '=' ? 2 : 1;
        std::uint32_t bits = 0;
        for (int d = 0; d < 4; ++d) {
            const int digit = d >= 4 - padding ? 0 : base64Digit(token[i + std::size_t(d)]);
            if (digit < 0) return false;
            bits = bits << 6 | std::uint32_t(digit);
        }
        for (int b = 0; b < 3 - padding; ++b)
            data.push_back(static_cast<unsigned char>(bits >> (16 - 8 * b)));
    }
    return true;
}

bool parseNumber(const std::string& token, double& value)
{
    return parse(token, value);
}

bool parseNumber(const std::string& token, std::int64_t& value)
{
    return parse(token, value);
}

bool parseNumber(const std::string& token, std::uint32_t& value)
{
    return parse(token, value);
}

} // namespace serializers
} // namespace osgVolumizer
