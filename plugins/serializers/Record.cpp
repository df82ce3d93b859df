#include "Record.h"

#include <osg/Endian>

namespace osgVolumizer {
namespace serializers {
namespace {

template <class T>
Status checkCount(const std::string& name, std::size_t count, const std::vector<T>& values)
{
    if (values.size() == count) return Status();
    return Status(ErrorCode::SIZE_MISMATCH, "field " + name + " has " +
                                                std::to_string(values.size()) +
                                                " values instead of " + std::to_string(count));
}

} // namespace

void Bytes::swapUnlessLittleEndian()
{
    if (osg::getCpuByteOrder() == osg::LittleEndian) return;
    for (std::size_t i = 0; i + elementSize <= data.size(); i += elementSize)
        osg::swapBytes(reinterpret_cast<char*>(data.data() + i), elementSize);
}

const char* kindName(std::size_t kind)
{
    static const char* const names[kindCount] = {"Integers", "Doubles", "Indices", "Text", "Bytes"};
    return kind < kindCount ? names[kind] : "";
}

const Field* Record::find(const std::string& name) const
{
    for (const Field& field : _fields)
        if (field.name == name) return &field;
    return nullptr;
}

Status Record::wrongKind(const std::string& name) const
{
    const Field* field = find(name);
    if (!field) return Status(ErrorCode::FILE_UNREADABLE, "field " + name + " is missing");
    return Status(ErrorCode::VALUE_INVALID,
                  "field " + name + " cannot be " + kindName(field->value.index()));
}

Status Record::get(const std::string& name, std::size_t count, Field::Integers& values) const
{
    const Field* field = find(name);
    const auto* found = field ? std::get_if<Field::Integers>(&field->value) : nullptr;
    if (!found) return wrongKind(name);
    values = *found;
    return checkCount(name, count, values);
}

Status Record::get(const std::string& name, std::size_t count, Field::Doubles& values) const
{
    const Field* field = find(name);
    const auto* found = field ? std::get_if<Field::Doubles>(&field->value) : nullptr;
    if (!found) return wrongKind(name);
    values = *found;
    return checkCount(name, count, values);
}

Status Record::getInteger(const std::string& name, std::int64_t low, std::int64_t high,
                          int& value) const
{
    Field::Integers values;
    const Status status = get(name, 1, values);
    if (!status.ok()) return status;
    if (values[0] < low || values[0] > high)
        return Status(ErrorCode::VALUE_INVALID,
                      "field " + name + " is " + std::to_string(values[0]) + ", not within [" +
                          std::to_string(low) + ", " + std::to_string(high) + "]");
    value = int(values[0]);
    return Status();
}

Status Record::get(const std::string& name, std::string& text) const
{
    const Field* field = find(name);
    const auto* found = field ? std::get_if<std::string>(&field->value) : nullptr;
    if (!found) return wrongKind(name);
    text = *found;
    return Status();
}

Status Record::getChoice(const std::string& name, const char* const* names, int count,
                         int& index) const
{
    std::string text;
    const Status status = get(name, text);
    if (!status.ok()) return status;
    std::string known;
    for (int i = 0; i < count; ++i) {
        if (text == names[i]) {
            index = i;
            return Status();
        }
        known += (i ? ", " : "") + std::string(names[i]);
    }
    return Status(ErrorCode::VALUE_INVALID,
                  "field " + name + " is '" + text.substr(0, 40) + "', not one of " + known);
}

} // namespace serializers
} // namespace osgVolumizer
