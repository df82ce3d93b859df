#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

/// A DICOM file that a test writes, element by element.
class DicomFile
{
public:
    using Tag = std::uint32_t; ///< group in the upper half
    using Elements = std::map<Tag, std::pair<std::string, std::string>>; ///< type and value

    static constexpr const char *EXPLICIT_LITTLE = "1.2.840.10008.1.2.1",
                                *IMPLICIT_LITTLE = "1.2.840.10008.1.2",
                                *EXPLICIT_BIG = "1.2.840.10008.1.2.2";

    std::string syntax = EXPLICIT_LITTLE;
    Elements elements;

    /// 16 bits, unsigned, of no place.
    DicomFile()
    {
        setSize(4, 3);
        setBits(16, 16, 15, false);
        word(0x00280002, 1);
        text(0x00280004, "CS", "MONOCHROME2");
        text(0x00080060, "CS", "CT");
        text(0x0020000e, "UI", "1.2.3");
    }
    /// An empty value removes the element.
    void text(Tag tag, const std::string& type, const std::string& value)
    {
        if (value.empty())
            elements.erase(tag);
        else
            elements[tag] = {type, value};
    }
    void word(Tag tag, int value) { elements[tag] = {"US", number16(value)}; }
    void words(Tag tag, const std::string& type, const std::vector<int>& values)
    {
        std::string bytes;
        for (const int v : values)
            bytes += number16(v);
        elements[tag] = {type, bytes};
    }
    void setSize(int columns, int rows)
    {
        word(0x00280010, rows);
        word(0x00280011, columns);
    }
    void setBits(int allocated, int stored, int highBit, bool isSigned)
    {
        _allocated = allocated;
        word(0x00280100, allocated);
        word(0x00280101, stored);
        word(0x00280102, highBit);
        word(0x00280103, isSigned);
    }
    void setValues(const std::vector<int>& values)
    {
        std::string pixels;
        for (const int v : values)
            pixels += _allocated == 8    ? std::string(1, static_cast<char>(v))
                      : _allocated == 16 ? number16(v)
                                         : number32(static_cast<std::uint32_t>(v));
        elements[0x7fe00010] = {"OW", pixels};
    }
    /// The middle of the first pixel, and where columns and rows go, as DICOM's text.
    void setPlace(const std::string& position, const std::string& orientation = "1\\0\\0\\0\\1\\0")
    {
        text(0x00200032, "DS", position);
        text(0x00200037, "DS", orientation);
    }
    /// A sequence of items.
    void sequence(Tag tag, const std::vector<Elements>& items)
    {
        elements[tag] = {"SQ", encodeItems(items)};
    }
    static std::string encodeItems(const std::vector<Elements>& items)
    {
        std::string bytes;
        for (const Elements& one : items) {
            const std::string inner = encode(one, false, false);
            bytes += number16(0xfffe) + number16(0xe000) +
                     number32(static_cast<std::uint32_t>(inner.size())) + inner;
        }
        return bytes;
    }
    std::string bytes() const
    {
        Elements meta = {{0x00020001, {"OB", std::string("\0\1", 2)}},
                         {0x00020010, {"UI", syntax}}};
        if (const auto kind = elements.find(0x00080016); kind != elements.end())
            meta[0x00020002] = {"UI", kind->second.second};
        const std::string head = encode(meta, false, false);
        return std::string(128, '\0') + "DICM" +
               element(0x00020000, "UL", number32(static_cast<std::uint32_t>(head.size())), false,
                       false) +
               head + encode(elements, syntax == IMPLICIT_LITTLE, syntax == EXPLICIT_BIG);
    }

    static std::string number16(int v)
    {
        return {static_cast<char>(v & 255), static_cast<char>(v >> 8 & 255)};
    }
    static std::string number32(std::uint32_t v)
    {
        return number16(static_cast<int>(v & 0xffff)) + number16(static_cast<int>(v >> 16));
    }

private:
    static std::string encode(const Elements& all, bool implicit, bool big)
    {
        std::string bytes;
        for (const auto& [tag, value] : all)
            bytes += element(tag, value.first, value.second, implicit, big);
        return bytes;
    }
    static std::string turned(std::string bytes, std::size_t size, bool big)
    {
        if (big)
            for (std::size_t i = 0; i + size <= bytes.size(); i += size)
                for (std::size_t j = 0; j < size / 2; ++j)
                    std::swap(bytes[i + j], bytes[i + size - 1 - j]);
        return bytes;
    }
    static std::string element(Tag tag, const std::string& type, std::string value, bool implicit,
                               bool big)
    {
        if (value.size() % 2) value += type == "UI" || type[0] == 'O' ? '\0' : ' ';
        if (type == "US" || type == "OW") value = turned(value, 2, big);
        const std::string head = turned(number16(static_cast<int>(tag >> 16)), 2, big) +
                                 turned(number16(static_cast<int>(tag & 0xffff)), 2, big);
        const auto length = static_cast<std::uint32_t>(value.size());
        if (implicit) return head + number32(length) + value;
        if (type == "SQ" || type[0] == 'O' || type == "UN")
            return head + type + number16(0) + turned(number32(length), 4, big) + value;
        return head + type + turned(number16(static_cast<int>(length)), 2, big) + value;
    }

    int _allocated = 16;
};
