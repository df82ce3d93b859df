#pragma once

#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Numbers for pairs of vertices, in either order: a hash table with open addressing that keeps its
/// memory when cleared.
class EdgeMap
{
public:
    static constexpr std::uint32_t NONE = 0xffffffffu;

    void clear()
    {
        _keys.assign(_keys.size(), EMPTY);
        _count = 0;
    }
    std::size_t size() const { return _count; }
    /// The value of the pair, created as NONE.
    std::uint32_t& operator()(std::uint32_t a, std::uint32_t b)
    {
        if (2 * (_count + 1) > _keys.size()) grow();
        const std::uint64_t key = a < b ? pack(a, b) : pack(b, a);
        const std::size_t slot = find(key);
        if (_keys[slot] == EMPTY) {
            _keys[slot] = key;
            _values[slot] = NONE;
            ++_count;
        }
        return _values[slot];
    }

private:
    static constexpr std::uint64_t EMPTY = ~std::uint64_t(0);

    static std::uint64_t pack(std::uint32_t a, std::uint32_t b)
    {
        return (std::uint64_t(a) << 32) | b;
    }
    /// Slot of the key, or the free one where it belongs. Fibonacci hashing (Knuth, vol. 3, 6.4).
    std::size_t find(std::uint64_t key) const
    {
        const std::size_t mask = _keys.size() - 1;
        std::size_t slot = static_cast<std::size_t>((key * 0x9e3779b97f4a7c15ull) >> 20) & mask;
        while (_keys[slot] != EMPTY && _keys[slot] != key)
            slot = (slot + 1) & mask;
        return slot;
    }
    void grow()
    {
        std::vector<std::uint64_t> keys(_keys.empty() ? 64 : 2 * _keys.size(), EMPTY);
        std::vector<std::uint32_t> values(keys.size(), NONE);
        keys.swap(_keys);
        values.swap(_values);
        for (std::size_t i = 0; i < keys.size(); ++i) {
            if (keys[i] == EMPTY) continue;
            const std::size_t slot = find(keys[i]);
            _keys[slot] = keys[i];
            _values[slot] = values[i];
        }
    }

    std::vector<std::uint64_t> _keys;
    std::vector<std::uint32_t> _values;
    std::size_t _count = 0;
};

} // namespace core
} // namespace osgVolumizer
