#include "Codec.h"

#include <algorithm>

namespace osgVolumizer {
namespace serializers {
namespace {

// A record is its number of bytes, the number of fields, and the fields; so a size that lies is
// found out before anything else is read in its name. Data goes in chunks, each followed by this
// byte, so that a file that has ended is found out one chunk later.
constexpr unsigned char marker = 0x5a;
constexpr std::uint64_t chunkBytes = std::uint64_t(1) << 20;
constexpr unsigned maximumFields = 64;
constexpr unsigned maximumNameLength = 256;

void writeCount(osgDB::OutputStream& os, std::uint64_t n)
{
    os << static_cast<unsigned>(n) << static_cast<unsigned>(n >> 32);
}

/// Bytes of `count` elements in the file, with their number and the markers.
std::uint64_t bytesOf(std::uint64_t count, unsigned size)
{
    const std::uint64_t bytes = count * size;
    return 8 + bytes + (bytes + chunkBytes - 1) / chunkBytes;
}

struct BytesOfValue
{
    template <class T>
    std::uint64_t operator()(const std::vector<T>& v) const
    {
        return bytesOf(v.size(), sizeof(T));
    }
    std::uint64_t operator()(const std::string& s) const { return bytesOf(s.size(), 1); }
    std::uint64_t operator()(const Bytes& b) const { return 4 + bytesOf(b.data.size(), 1); }
};

std::uint64_t bytesOf(const Record& record)
{
    std::uint64_t bytes = 4;
    for (const Field& field : record.fields())
        bytes += 4 + field.name.size() + 1 + std::visit(BytesOfValue(), field.value);
    return bytes;
}

void writeElements(osgDB::OutputStream& os, const void* data, std::size_t count, unsigned size)
{
    writeCount(os, count);
    const auto* bytes = static_cast<const char*>(data);
    for (std::uint64_t left = count * size; left > 0;) {
        const std::uint64_t n = std::min(left, chunkBytes);
        os.writeCharArray(bytes, static_cast<unsigned>(n));
        os << marker;
        bytes += n;
        left -= n;
    }
}

void writeName(osgDB::OutputStream& os, const std::string& name)
{
    os << static_cast<unsigned>(name.size());
    os.writeCharArray(name.data(), static_cast<unsigned>(name.size()));
}

struct WriteBinaryValue
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

/// Reads within the bytes of one record.
class Reader
{
public:
    explicit Reader(osgDB::InputStream& is) : _is(is) { _left = count(); }

    std::uint64_t count()
    {
        const std::uint64_t low = integer();
        return std::uint64_t(integer()) << 32 | low;
    }
    unsigned integer()
    {
        unsigned value = 0;
        _is >> value;
        return value;
    }
    unsigned char byte()
    {
        unsigned char value = 0;
        _is >> value;
        return value;
    }
    bool failed() const { return _is.getException() != nullptr; }

    Status name(std::string& name)
    {
        const unsigned length = integer();
        if (failed() || length == 0 || length > maximumNameLength)
            return Status(ErrorCode::FILE_UNREADABLE, "the name of a field is damaged");
        name.resize(length);
        _is.readCharArray(&name[0], length);
        return Status();
    }
    /// `values` holds elements of `size` bytes in units of T (for samples: of one byte).
    template <class T>
    Status elements(const std::string& name, unsigned size, std::vector<T>& values)
    {
        const std::uint64_t n = count();
        if (failed() || n > _left || bytesOf(n, size) > _left) return cut(name, n);
        _left -= bytesOf(n, size);
        for (std::uint64_t done = 0; done < n;) {
            const std::uint64_t some = std::min<std::uint64_t>(n - done, chunkBytes / size);
            const std::size_t old = values.size();
            values.resize(old + std::size_t(some) * (size / sizeof(T)));
            _is.readComponentArray(reinterpret_cast<char*>(values.data() + old), unsigned(some), 1,
                                   size);
            if (byte() != marker || failed()) return cut(name, n);
            done += some;
        }
        return Status();
    }

private:
    static Status cut(const std::string& name, std::uint64_t count)
    {
        return Status(ErrorCode::FILE_UNREADABLE,
                      "field " + name + " does not have its " + std::to_string(count) + " values");
    }

    osgDB::InputStream& _is;
    std::uint64_t _left = 0;
};

struct ReadValue
{
    Reader& reader;
    const std::string& name;

    template <class T>
    Status operator()(std::vector<T>& v) const
    {
        return reader.elements(name, sizeof(T), v);
    }
    Status operator()(std::string& s) const
    {
        std::vector<char> text;
        const Status status = reader.elements(name, 1, text);
        s.assign(text.begin(), text.end());
        return status;
    }
    Status operator()(Bytes& b) const
    {
        b.elementSize = reader.integer();
        if (b.elementSize != 1 && b.elementSize != 2 && b.elementSize != 4 && b.elementSize != 8)
            return Status(ErrorCode::VALUE_INVALID, "field " + name + " has samples of " +
                                                        std::to_string(b.elementSize) + " bytes");
        return reader.elements(name, b.elementSize, b.data);
    }
};

Field::Value emptyValue(unsigned kind)
{
    static const Field::Value values[kindCount] = {Field::Integers(), Field::Doubles(),
                                                   Field::Indices(), std::string(), Bytes()};
    return values[kind];
}

Status readFields(Reader& reader, Record& record)
{
    const unsigned count = reader.integer();
    if (reader.failed() || count > maximumFields)
        return Status(ErrorCode::FILE_UNREADABLE,
                      "there cannot be " + std::to_string(count) + " fields");
    for (unsigned i = 0; i < count; ++i) {
        std::string name;
        Status status = reader.name(name);
        if (!status.ok()) return status;
        const unsigned kind = reader.byte();
        if (reader.failed() || kind >= kindCount)
            return Status(ErrorCode::FILE_UNREADABLE,
                          "a field is of unknown kind " + std::to_string(kind));
        Field::Value value = emptyValue(kind);
        status = std::visit(ReadValue{reader, name}, value);
        if (!status.ok()) return status;
        record.add(std::move(name), std::move(value));
    }
    return Status();
}

} // namespace

void writeBinary(osgDB::OutputStream& os, const Record& record)
{
    os << os.BEGIN_BRACKET;
    writeCount(os, bytesOf(record));
    os << static_cast<unsigned>(record.fields().size());
    for (const Field& field : record.fields()) {
        writeName(os, field.name);
        os << static_cast<unsigned char>(field.value.index());
        std::visit(WriteBinaryValue{os}, field.value);
    }
    os << os.END_BRACKET;
}

Status readBinary(osgDB::InputStream& is, Record& record)
{
    is >> is.BEGIN_BRACKET;
    Reader reader(is);
    const Status status = readFields(reader, record);
    if (status.ok())
        is >> is.END_BRACKET;
    else
        is.advanceToCurrentEndBracket();
    return status;
}

} // namespace serializers
} // namespace osgVolumizer
