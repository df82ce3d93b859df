#include "ClassicFile.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <vector>

namespace osgVolumizer {
namespace gdal {

namespace {

constexpr std::int64_t MOST_CLASSIC_BYTES = std::numeric_limits<std::int64_t>::max();

struct ClassicVariable
{
    std::int64_t begin = 0, bytes = 0; ///< of a record, where it has some
    bool records = false;
};

/// Reads the header, as long as it lies within the file.
class Header
{
public:
    explicit Header(const std::string& path)
        : _file(path, std::ios::binary),
          _size(static_cast<std::int64_t>(std::filesystem::file_size(path)))
    {
        char magic[4] = {};
        _file.read(magic, 4);
        const bool known = _file && magic[0] == 'C' && magic[1] == 'D' && magic[2] == 'F' &&
                           (magic[3] == 1 || magic[3] == 2 || magic[3] == 5);
        _version = known ? magic[3] : 0;
    }

    bool isClassic() const { return _version != 0; }
    std::int64_t size() const { return _size; }
    [[noreturn]] static void fail() { throw std::runtime_error("it is cut short or damaged"); }

    std::int64_t word() { return read(4); }
    std::int64_t count() { return read(_version == 5 ? 8 : 4); }
    std::int64_t place() { return read(_version == 1 ? 4 : 8); }
    void skipName() { skipPadded(count()); }
    void skipPadded(std::int64_t bytes)
    {
        if (bytes < 0 || bytes > _size) fail();
        const std::int64_t to = static_cast<std::int64_t>(_file.tellg()) + (bytes + 3) / 4 * 4;
        if (to > _size || !_file.seekg(to)) fail();
    }
    void skipAttributes()
    {
        word();
        const std::int64_t attributes = count();
        for (std::int64_t i = 0; i < attributes; ++i) {
            skipName();
            const std::int64_t type = word(), values = count();
            if (values < 0 || values > _size) fail();
            skipPadded(values * typeBytes(type));
        }
    }
    static std::int64_t typeBytes(std::int64_t type)
    {
        constexpr int BYTES[] = {0, 1, 1, 2, 4, 4, 8, 1, 2, 4, 8, 8};
        if (type < 1 || type > 11) fail();
        return BYTES[type];
    }

private:
    // Big endian; one without a sign where it has 4 bytes.
    std::int64_t read(int bytes)
    {
        unsigned char b[8];
        if (!_file.read(reinterpret_cast<char*>(b), bytes)) fail();
        std::uint64_t value = 0;
        for (int i = 0; i < bytes; ++i)
            value = value << 8 | b[i];
        return static_cast<std::int64_t>(value);
    }

    std::ifstream _file;
    std::int64_t _size;
    int _version = 0;
};

ClassicVariable readVariable(Header& header, const std::vector<std::int64_t>& lengths)
{
    ClassicVariable variable;
    header.skipName();
    const std::int64_t rank = header.count();
    double product = 1.0; // in case that it is more than any file has
    std::int64_t bytes = 1;
    for (std::int64_t i = 0; i < rank; ++i) {
        const std::int64_t dimension = header.count();
        if (dimension < 0 || dimension >= std::int64_t(lengths.size())) Header::fail();
        const std::int64_t length = lengths[std::size_t(dimension)];
        if (i == 0 && length == 0) {
            variable.records = true;
            continue;
        }
        product *= double(length);
        if (!(product < 1e17)) Header::fail();
        bytes *= length;
    }
    header.skipAttributes();
    variable.bytes = bytes * Header::typeBytes(header.word());
    header.count(); // what it takes, which is not to be trusted
    variable.begin = header.place();
    return variable;
}

void checkHeader(Header& header)
{
    const std::int64_t records = header.count();
    const bool streamed = records == 0xffffffff || records < 0; // how many is not known
    std::vector<std::int64_t> lengths;
    header.word();
    for (std::int64_t i = header.count(); i > 0; --i) {
        header.skipName();
        lengths.push_back(header.count());
        if (lengths.back() < 0) Header::fail();
    }
    header.skipAttributes();
    header.word();
    std::vector<ClassicVariable> variables;
    for (std::int64_t i = header.count(); i > 0; --i)
        variables.push_back(readVariable(header, lengths));
    std::int64_t ofRecord = 0, recordVariables = 0;
    for (const ClassicVariable& v : variables)
        if (v.records) {
            ofRecord += (v.bytes + 3) / 4 * 4;
            ++recordVariables;
        }
    for (const ClassicVariable& v : variables) {
        if (v.begin < 0 || v.begin > MOST_CLASSIC_BYTES / 4) Header::fail();
        const std::int64_t step = recordVariables == 1 ? v.bytes : ofRecord;
        if (v.records && (streamed || records == 0)) continue;
        if (v.records && double(records) * double(step) > double(header.size())) Header::fail();
        const std::int64_t before = v.records ? (records - 1) * step : 0;
        if (v.bytes > 0 && v.begin + before + v.bytes > header.size()) Header::fail();
    }
}

} // namespace

Status checkClassicFile(const std::string& path)
{
    try {
        Header header(path);
        if (header.isClassic()) checkHeader(header);
    } catch (const std::exception& e) {
        return {ErrorCode::FILE_UNREADABLE, path + " cannot be read: " + e.what()};
    }
    return {};
}

} // namespace gdal
} // namespace osgVolumizer
