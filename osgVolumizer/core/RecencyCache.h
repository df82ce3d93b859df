#pragma once

#include <algorithm>
#include <cstddef>
#include <list>
#include <utility>

namespace osgVolumizer {
namespace core {

/// The last few values that were asked for, each under a key. When there is no room for another,
/// the one that has not been asked for longest is forgotten. Keys are compared one after another
/// with ==, so it is for caches of a few entries; references to values stay valid until they are
/// forgotten. Not thread safe.
template <class Key, class Value>
class RecencyCache
{
public:
    struct Entry
    {
        Key key;
        Value value;
    };
    using const_iterator = typename std::list<Entry>::const_iterator;

    /// \param capacity of entries, > 0
    explicit RecencyCache(std::size_t capacity) : _capacity(capacity) {}

    /// Null where the key is unknown; else its value, which then is the most recent one.
    Value* find(const Key& key)
    {
        const auto found = std::find_if(_entries.begin(), _entries.end(),
                                        [&key](const Entry& entry) { return entry.key == key; });
        if (found == _entries.end()) return nullptr;
        _entries.splice(_entries.begin(), _entries, found);
        return &found->value;
    }
    /// Makes a value the most recent one. Replaces what the key had.
    Value& add(Key key, Value value)
    {
        if (Value* known = find(key)) return *known = std::move(value);
        // Before there is one more: what is forgotten may be large.
        while (!_entries.empty() && _entries.size() >= _capacity)
            _entries.pop_back();
        _entries.push_front({std::move(key), std::move(value)});
        return _entries.front().value;
    }
    /// Forgets the entries for which the predicate holds.
    template <class Predicate>
    void removeIf(Predicate predicate)
    {
        _entries.remove_if(predicate);
    }
    void clear() { _entries.clear(); }

    std::size_t size() const { return _entries.size(); }
    /// Most recent first.
    const_iterator begin() const { return _entries.begin(); }
    const_iterator end() const { return _entries.end(); }

private:
    std::size_t _capacity;
    std::list<Entry> _entries; ///< most recent first
};

} // namespace core
} // namespace osgVolumizer
