#include "Elements.h"

#include <osgVolumizer/core/Text.h>

#include <gdcmByteValue.h>
#include <gdcmSequenceOfItems.h>

#include <cmath>
#include <cstdint>
#include <cstring>

namespace osgVolumizer {
namespace medical {

bool Elements::has(const gdcm::Tag& tag) const
{
    return _set.FindDataElement(tag) && !_set.GetDataElement(tag).IsEmpty();
}

const gdcm::ByteValue* Elements::bytes(const gdcm::Tag& tag) const
{
    return _set.FindDataElement(tag) ? _set.GetDataElement(tag).GetByteValue() : nullptr;
}

std::string Elements::raw(const gdcm::Tag& tag) const
{
    const gdcm::ByteValue* value = bytes(tag);
    if (!value || !value->GetPointer()) return {};
    return {value->GetPointer(), std::size_t(value->GetLength())};
}

std::string Elements::text(const gdcm::Tag& tag) const
{
    std::string text = raw(tag);
    const auto blank = [](char c) { return c == ' ' || c == '\0' || c == '\n' || c == '\r'; };
    while (!text.empty() && blank(text.back()))
        text.pop_back();
    std::size_t first = 0;
    while (first < text.size() && blank(text[first]))
        ++first;
    return text.substr(first);
}

std::vector<double> Elements::decimals(const gdcm::Tag& tag) const
{
    std::vector<double> numbers;
    const std::string all = text(tag);
    if (all.empty()) return numbers;
    for (const std::string_view piece : core::splitText(all, '\\')) {
        const std::vector<std::string_view> words = core::splitBlanks(piece);
        double number = 0.0;
        std::string_view word = words.size() == 1 ? words.front() : std::string_view();
        if (!word.empty() && word.front() == '+') word.remove_prefix(1);
        if (!core::parseNumber(word, number) || !std::isfinite(number)) return {};
        numbers.push_back(number);
    }
    return numbers;
}

std::optional<double> Elements::decimal(const gdcm::Tag& tag) const
{
    const std::vector<double> numbers = decimals(tag);
    if (numbers.empty()) return std::nullopt;
    return numbers.front();
}

std::vector<unsigned> Elements::words(const gdcm::Tag& tag) const
{
    std::vector<unsigned> found;
    const gdcm::ByteValue* value = bytes(tag);
    if (!value || !value->GetPointer()) return found;
    for (std::size_t i = 0; i + 2 <= value->GetLength(); i += 2) {
        std::uint16_t word = 0;
        std::memcpy(&word, value->GetPointer() + i, 2);
        found.push_back(word);
    }
    return found;
}

std::optional<int> Elements::word(const gdcm::Tag& tag) const
{
    const std::vector<unsigned> found = words(tag);
    if (found.empty()) return std::nullopt;
    return static_cast<int>(found.front());
}

std::optional<unsigned> Elements::longWord(const gdcm::Tag& tag) const
{
    const gdcm::ByteValue* value = bytes(tag);
    if (!value || !value->GetPointer() || value->GetLength() < 4) return std::nullopt;
    std::uint32_t number = 0;
    std::memcpy(&number, value->GetPointer(), 4);
    return number;
}

std::vector<gdcm::DataSet> Elements::items(const gdcm::Tag& tag) const
{
    std::vector<gdcm::DataSet> found;
    if (!_set.FindDataElement(tag)) return found;
    const gdcm::SmartPointer<gdcm::SequenceOfItems> items = _set.GetDataElement(tag).GetValueAsSQ();
    if (!items) return found;
    for (gdcm::SequenceOfItems::SizeType i = 1; i <= items->GetNumberOfItems(); ++i)
        found.push_back(items->GetItem(i).GetNestedDataSet());
    return found;
}

std::optional<gdcm::DataSet> Elements::item(const gdcm::Tag& tag) const
{
    std::vector<gdcm::DataSet> all = items(tag);
    if (all.empty()) return std::nullopt;
    return all.front();
}

} // namespace medical
} // namespace osgVolumizer
