#pragma once

#include <cstdint>
#include <cstdlib>
#include <string>

namespace osgVolumizer {
namespace vtk {

/// Integers of a legacy file, one after another: text, or big-endian of 4 or 8 bytes.
class LegacyNumbers
{
public:
    /// \param bytes of each; 0: text. Keeps a reference to the content.
    LegacyNumbers(const std::string& content, std::size_t at, int bytes)
        : _content(content), _at(at), _bytes(bytes)
    {
    }
    /// False where there is none.
    bool operator()(std::int64_t& value)
    {
        if (_bytes == 0) return parse(value);
        const auto size = static_cast<std::size_t>(_bytes);
        if (_at > _content.size() || _content.size() - _at < size) return false;
        std::uint64_t bits = 0;
        for (std::size_t i = 0; i < size; ++i)
            bits = bits << 8 | static_cast<unsigned char>(_content[_at++]);
        value = _bytes == 4 ? static_cast<std::int32_t>(static_cast<std::uint32_t>(bits))
                            : static_cast<std::int64_t>(bits);
        return true;
    }
    bool skip(std::int64_t count)
    {
        for (std::int64_t i = 0, ignored = 0; i < count; ++i)
            if (!(*this)(ignored)) return false;
        return true;
    }
    /// Behind what was read.
    std::size_t place() const { return _at; }

private:
    bool parse(std::int64_t& value)
    {
        if (_at >= _content.size()) return false;
        char* end = nullptr;
        value = std::strtoll(_content.c_str() + _at, &end, 10);
        if (end == _content.c_str() + _at) return false;
        _at = static_cast<std::size_t>(end - _content.c_str());
        return true;
    }

    const std::string& _content;
    std::size_t _at;
    int _bytes;
};

} // namespace vtk
} // namespace osgVolumizer
