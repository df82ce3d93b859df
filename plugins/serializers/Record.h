#pragma once

#include <osgVolumizer/core/Status.h>

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace osgVolumizer {
namespace serializers {

/// Samples of `elementSize` bytes each, in native byte order.
struct Bytes
{
    std::vector<unsigned char> data;
    unsigned elementSize = 1; ///< 1, 2, 4 or 8

    /// To little-endian, as text has it, or back.
    void swapUnlessLittleEndian();
};

/// The state of one object as named fields: what a scene file holds of it, in whichever encoding.
/// The order of the alternatives is part of the binary format.
struct Field
{
    using Integers = std::vector<std::int64_t>;
    using Doubles = std::vector<double>;
    using Indices = std::vector<std::uint32_t>;
    using Value = std::variant<Integers, Doubles, Indices, std::string, Bytes>;

    std::string name;
    Value value;
    std::size_t valuesPerLine = 8; ///< in text
};

/// "Integers", "Doubles", "Indices", "Text", "Bytes": how text files call Field::value.index().
const char* kindName(std::size_t kind);
constexpr std::size_t kindCount = std::variant_size_v<Field::Value>;

class Record
{
public:
    /// The version of our format that every record is written with, and the newest that is read;
    /// records of an older one keep the defaults of what they lack. It is a field of the record,
    /// and so independent of the versions that OSG's wrappers count for a whole file. 2:
    /// VolumeAppearance has Lookup and ExactFiltering. 3: VolumeAppearance has RayFunction,
    /// IsoValue, Shading, Material, Gradients,
    ///    AccumulationBits, ErrorTolerance and TargetFrameTime.
    /// 4: VolumeAppearance has CombineRule, VolumeGeometry SlackAngle.
    /// 5: VolumeAppearance has TimeStep, TimeRate and TimeBlending, Voxels TextureBudget.
    /// 6: VolumeAppearance has PickOpacity.
    /// 7: VolumeAppearance has a Cut.
    static constexpr int version = 7;

    const std::vector<Field>& fields() const { return _fields; }
    void add(std::string name, Field::Value value, std::size_t valuesPerLine = 8)
    {
        _fields.push_back({std::move(name), std::move(value), valuesPerLine});
    }

    /// The field of a name, or null.
    const Field* find(const std::string& name) const;
    bool has(const std::string& name) const { return find(name) != nullptr; }

    /// Takes a field out of the record. Fails where it is missing or of another kind; so does each
    /// of the following where there are not `count` values.
    template <class T>
    Status take(const std::string& name, T& value);
    Status get(const std::string& name, std::size_t count, Field::Integers& values) const;
    Status get(const std::string& name, std::size_t count, Field::Doubles& values) const;
    /// One integer between low and high.
    Status getInteger(const std::string& name, std::int64_t low, std::int64_t high,
                      int& value) const;
    Status get(const std::string& name, std::string& text) const;
    /// One of `count` names; `index` is which. The error lists them.
    Status getChoice(const std::string& name, const char* const* names, int count,
                     int& index) const;

private:
    Status wrongKind(const std::string& name) const;

    std::vector<Field> _fields;
};

template <class T>
Status Record::take(const std::string& name, T& value)
{
    auto* field = const_cast<Field*>(find(name));
    T* found = field ? std::get_if<T>(&field->value) : nullptr;
    if (!found) return wrongKind(name);
    value = std::move(*found);
    return Status();
}

} // namespace serializers
} // namespace osgVolumizer
