#include "Codec.h"

#include <algorithm>

namespace osgVolumizer {
namespace serializers {
namespace {

// Data goes in chunks, each followed by this byte. A size that lies is found out one chunk later.
constexpr unsigned char marker = 0x5a;
constexpr std::size_t chunkBytes = std::size_t(1) << 20;
constexpr unsigned maximumFields = 64;
constexpr unsigned maximumNameLength = 256;

void writeCount(osgDB::OutputStream& os, std::uint64_t n)
{
    os << static_cast<unsigned>(n) << static_cast<unsigned>(n >> 32);
}

std::uint64_t readCount(osgDB::InputStream& is)
{
    unsigned low = 0, high = 0;
    is >> low >> high;
    return (std::uint64_t(high) << 32) | low;
}

void writeElements(osgDB::OutputStream& os, const void* data, std::size_t count, unsigned size)
{
    writeCount(os, count);
    const auto* bytes = static_cast<const char*>(data);
    for (std::size_t left = count * size; left > 0;) {
        const std::size_t n = std::min(left, chunkBytes);
        os.writeCharArray(bytes, static_cast<unsigned>(n));
        os << marker;
        bytes += n;
        left -= n;
    }
}

// `values` has elements of `size` bytes in units of T (one byte for samples).
template <class T>
Status readElements(osgDB::InputStream& is, const std::string& name, unsigned size,
                    std::vector<T>& values)
{
    const std::uint64_t count = readCount(is);
    const auto cut = [&] {
        return Status(ErrorCode::FILE_UNREADABLE, "field " + name + " is cut short of its " +
                                                      std::to_string(count) + " values");
    };
    if (count > (std::uint64_t(1) << 60) / size) return cut();
    const std::size_t units = size / sizeof(T);
    for (std::uint64_t left = count; left > 0;) {
        const std::size_t n = std::size_t(std::min<std::uint64_t>(left, chunkBytes / size));
        const std::size_t old = values.size();
        values.resize(old + n * units);
        is.readComponentArray(reinterpret_cast<char*>(values.data() + old),
                              static_cast<unsigned>(n), 1, size);
        unsigned char end = 0;
        is >> end;
        if (is.getException() || end != marker) return cut();
        left -= n;
    }
    return Status();
}

void writeName(osgDB::OutputStream& os, const std::string& name)
{
    os << static_cast<unsigned>(name.size());
    os.writeCharArray(name.data(), static_cast<unsigned>(name.size()));
}

Status readName(osgDB::InputStream& is, std::string& name)
{
    unsigned length = 0;
    is >> length;
    if (is.getException() || length == 0 || length > maximumNameLength)
        return Status(ErrorCode::FILE_UNREADABLE, "the name of a field is damaged");
    name.resize(length);
    is.readCharArray(&name[0], length);
    return Status();
}

struct WriteValue
{
    osgDB::OutputStream& os;

    template <class T>
    void operator()(const std::vector<T>& v) const
    {
        writeElements(os, v.data(), v.size(), sizeof(T));
    }
    void operator()(const std::string& s) const { writeElements(os, s.data(), s.size(), 1); }
    void operator()(const Bytes& b) const
    {
        os << b.elementSize;
        writeElements(os, b.data.data(), b.data.size() / b.elementSize, b.elementSize);
    }
};

struct ReadValue
{
    osgDB::InputStream& is;
    const std::string& name;

    template <class T>
    Status operator()(std::vector<T>& v) const
    {
        return readElements(is, name, sizeof(T), v);
    }
    Status operator()(std::string& s) const
    {
        std::vector<char> text;
        const Status status = readElements(is, name, 1, text);
        s.assign(text.begin(), text.end());
        return status;
    }
    Status operator()(Bytes& b) const
    {
        is >> b.elementSize;
        if (b.elementSize != 1 && b.elementSize != 2 && b.elementSize != 4 && b.elementSize != 8)
            return Status(ErrorCode::VALUE_INVALID, "field " + name + " has samples of " +
                                                        std::to_string(b.elementSize) + " bytes");
        return readElements(is, name, b.elementSize, b.data);
    }
};

Field::Value emptyValue(unsigned kind)
{
    static const Field::Value values[kindCount] = {Field::Integers(), Field::Doubles(),
                                                   Field::Indices(), std::string(), Bytes()};
    return values[kind];
}

Status readFields(osgDB::InputStream& is, Record& record)
{
    unsigned count = 0;
    is >> count;
    if (is.getException() || count > maximumFields)
        return Status(ErrorCode::FILE_UNREADABLE,
                      "there cannot be " + std::to_string(count) + " fields");
    for (unsigned i = 0; i < count; ++i) {
        std::string name;
        Status status = readName(is, name);
        if (!status.ok()) return status;
        unsigned char kind = 0;
        is >> kind;
        if (is.getException() || kind >= kindCount)
            return Status(ErrorCode::FILE_UNREADABLE,
                          "a field is of unknown kind " + std::to_string(kind));
        Field::Value value = emptyValue(kind);
        status = std::visit(ReadValue{is, name}, value);
        if (!status.ok()) return status;
        record.add(std::move(name), std::move(value));
    }
    return Status();
}

} // namespace

void writeBinary(osgDB::OutputStream& os, const Record& record)
{
    os << os.BEGIN_BRACKET;
    os << static_cast<unsigned>(record.fields().size());
    for (const Field& field : record.fields()) {
        writeName(os, field.name);
        os << static_cast<unsigned char>(field.value.index());
        std::visit(WriteValue{os}, field.value);
    }
    os << os.END_BRACKET;
}

Status readBinary(osgDB::InputStream& is, Record& record)
{
    is >> is.BEGIN_BRACKET;
    const Status status = readFields(is, record);
    if (status.ok())
        is >> is.END_BRACKET;
    else
        is.advanceToCurrentEndBracket();
    return status;
}

} // namespace serializers
} // namespace osgVolumizer
