#pragma once

#include "Export.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace osgVolumizer {
namespace core {

/// The whole of `text` as a number, '.' as decimal point whatever the locale; false (and `value`
/// untouched) for anything else, as also for a number that overflows. "nan" and "inf" are numbers.
OSGVOLUMIZER_CORE_EXPORT bool parseNumber(std::string_view text, double& value);
OSGVOLUMIZER_CORE_EXPORT bool parseInteger(std::string_view text, std::int64_t& value);
/// Exactly `count` numbers between commas.
OSGVOLUMIZER_CORE_EXPORT bool parseNumbers(std::string_view text, double* values, int count);

/// The pieces between separators; an empty text has one empty piece.
OSGVOLUMIZER_CORE_EXPORT std::vector<std::string_view> splitText(std::string_view text,
                                                                 char separator);
/// The pieces between blanks (blank, tabulator, line ends), none of them empty.
OSGVOLUMIZER_CORE_EXPORT std::vector<std::string_view> splitBlanks(std::string_view text);
/// An option as in "name=value": between blanks, unless the value (or all of it) is quoted.
struct Option
{
    std::string name, value; ///< without quotation marks; the value of a mere name is empty
    bool hasValue = false;
    bool closed = true; ///< the quotation has an end
};
/// The options of a string, in order. Quotation marks, single or double, count where a word or a
/// value begins; all up to the next of the kind belongs to the value.
OSGVOLUMIZER_CORE_EXPORT std::vector<Option> splitOptions(std::string_view text);
/// Writes as few digits as read back to the same number.
OSGVOLUMIZER_CORE_EXPORT std::string formatNumber(double value);
/// Between commas, as parseNumbers() reads them.
OSGVOLUMIZER_CORE_EXPORT std::string formatNumbers(const double* values, int count);
/// "x,y,z"
OSGVOLUMIZER_CORE_EXPORT std::string formatTriple(const glm::ivec3& v);
OSGVOLUMIZER_CORE_EXPORT std::string formatTriple(const glm::dvec3& v);

} // namespace core
} // namespace osgVolumizer
