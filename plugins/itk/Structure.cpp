#include "Structure.h"

#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>

namespace osgVolumizer {
namespace medical {

namespace {

constexpr std::uint32_t UNDEFINED = 0xffffffffu, ITEM = 0xfffee000u, ITEM_END = 0xfffee00du,
                        SEQUENCE_END = 0xfffee0ddu, PIXELS = 0x7fe00010u, KIND = 0x00020002u,
                        SYNTAX = 0x00020010u;
constexpr int MOST_NESTED = 64;

/// How an element begins.
struct ElementHead
{
    std::uint32_t tag = 0, length = 0;
    char type[2] = {};
};

class Walker
{
public:
    enum Outcome
    {
        WHOLE,
        CUT,
        ODD ///< of a form that is not known here
    };

    explicit Walker(const std::string& path) : _file(path, std::ios::binary)
    {
        _file.seekg(0, std::ios::end);
        _end = static_cast<std::int64_t>(_file.tellg());
    }
    Outcome walk()
    {
        char word[4] = {};
        seek(128);
        if (!take(word, 4) || std::memcmp(word, "DICM", 4) != 0) return ODD;
        std::string syntax;
        for (_explicit = true;;) {
            const std::int64_t before = _at;
            ElementHead head;
            if (_at == _end) return CUT; // nothing behind the meta information
            const Outcome outcome = readHead(head);
            if (outcome != CUT && head.tag >> 16 != 2) { // perhaps of implicit form
                seek(before);
                break;
            }
            if (outcome != WHOLE) return outcome;
            if (head.length > _end - _at) return CUT;
            if ((head.tag == SYNTAX || head.tag == KIND) && head.length <= 64) {
                std::string& uid = head.tag == SYNTAX ? syntax : _kind;
                uid.resize(head.length);
                take(uid.data(), head.length);
            } else {
                seek(_at + head.length);
            }
        }
        for (std::string* uid : {&syntax, &_kind})
            while (!uid->empty() && (uid->back() == '\0' || uid->back() == ' '))
                uid->pop_back();
        if (syntax.empty() || syntax == "1.2.840.10008.1.2.1.99") return ODD; // deflated
        _big = syntax == "1.2.840.10008.1.2.2";
        _explicit = syntax != "1.2.840.10008.1.2";
        return elements(_end, 0);
    }
    /// Once walked: the UID of the kind of file that it says to be.
    const std::string& kind() const { return _kind; }

private:
    void seek(std::int64_t to)
    {
        _at = to;
        _file.clear();
        _file.seekg(to);
    }
    bool take(char* to, std::int64_t count)
    {
        if (count > _end - _at) return false;
        _file.read(to, count);
        _at += count;
        return static_cast<bool>(_file);
    }
    std::uint32_t number(const char* bytes, int count) const
    {
        std::uint32_t value = 0;
        for (int i = 0; i < count; ++i) {
            const int from = _big ? i : count - 1 - i;
            value = value << 8 | static_cast<unsigned char>(bytes[from]);
        }
        return value;
    }
    Outcome readHead(ElementHead& head)
    {
        char bytes[8];
        if (!take(bytes, 8)) return CUT;
        head.tag = number(bytes, 2) << 16 | number(bytes + 2, 2);
        head.length = number(bytes + 4, 4);
        if (!_explicit || head.tag >> 16 == 0xfffe) return WHOLE;
        if (!std::isupper(static_cast<unsigned char>(bytes[4])) ||
            !std::isupper(static_cast<unsigned char>(bytes[5])))
            return ODD;
        std::memcpy(head.type, bytes + 4, 2);
        head.length = number(bytes + 6, 2);
        for (const char* wide :
             {"OB", "OW", "OF", "OD", "OL", "OV", "SQ", "UN", "UT", "UC", "UR", "SV", "UV"}) {
            if (std::memcmp(head.type, wide, 2) != 0) continue;
            if (!take(bytes, 4)) return CUT;
            head.length = number(bytes, 4);
        }
        return WHOLE;
    }
    // Up to `end`, or the end of an item, where that is of undefined length.
    Outcome elements(std::int64_t end, int depth)
    {
        while (_at < end) {
            ElementHead head;
            if (const Outcome outcome = readHead(head); outcome != WHOLE) return outcome;
            if (head.tag == ITEM_END) return WHOLE;
            if (depth == 0 && head.tag == PIXELS)
                return head.length == UNDEFINED && !isItemNext() ? CUT : WHOLE;
            if (head.length == UNDEFINED) {
                if (const Outcome outcome = items(depth); outcome != WHOLE) return outcome;
            } else if (head.length > end - _at) {
                return CUT;
            } else {
                seek(_at + head.length);
            }
        }
        return WHOLE;
    }
    // Compressed pixels begin with a table of where their fragments are.
    bool isItemNext()
    {
        ElementHead head;
        return readHead(head) == WHOLE && head.tag == ITEM && head.length <= _end - _at;
    }
    // Of a sequence of undefined length.
    Outcome items(int depth)
    {
        if (depth > MOST_NESTED) return ODD;
        while (_at < _end) {
            ElementHead head;
            if (const Outcome outcome = readHead(head); outcome != WHOLE) return outcome;
            if (head.tag == SEQUENCE_END) return WHOLE;
            if (head.tag != ITEM) return ODD;
            if (head.length == UNDEFINED) {
                if (const Outcome outcome = elements(_end, depth + 1); outcome != WHOLE)
                    return outcome;
            } else if (head.length > _end - _at) {
                return CUT;
            } else {
                seek(_at + head.length);
            }
        }
        return CUT;
    }

    std::ifstream _file;
    std::string _kind;
    std::int64_t _at = 0, _end = 0;
    bool _explicit = true, _big = false;
};

} // namespace

Status checkStructure(const std::string& path)
{
    Walker walker(path);
    const Walker::Outcome outcome = walker.walk();
    if (walker.kind() == "1.2.840.10008.1.3.10")
        return {ErrorCode::NOT_SUPPORTED,
                path + " has no image: it is a directory of DICOM files: open its folder"};
    if (outcome != Walker::CUT) return {};
    return {ErrorCode::FILE_UNREADABLE, path + " is cut short or damaged within its elements"};
}

} // namespace medical
} // namespace osgVolumizer
