#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace serializers {

/// Text without blanks, quotes, brackets and dashes: everything but ASCII letters, digits and
/// "_./,:;=+*#" goes as %XX.
std::string escaped(const std::string& text);
/// The other way round; false where a % is not followed by two hexadecimal digits.
bool unescape(const std::string& token, std::string& text);

/// Base64 (RFC 4648) with padding.
std::string base64(const unsigned char* data, std::size_t size);
/// Appends the bytes of a token; false where it is no base64.
bool appendBase64(const std::string& token, std::vector<unsigned char>& data);

/// A whole token as a number, exactly rounded, whatever the locale; "inf" and "nan" are numbers
/// here.
bool parseNumber(const std::string& token, double& value);
bool parseNumber(const std::string& token, std::int64_t& value);
bool parseNumber(const std::string& token, std::uint32_t& value);

} // namespace serializers
} // namespace osgVolumizer
