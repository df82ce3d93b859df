#include "NumpyHeader.h"

#include "../core/Text.h"

#include <algorithm>
#include <limits>

namespace osgVolumizer {
namespace io {

namespace {

Status unreadable(const std::string& text)
{
    return {ErrorCode::FILE_UNREADABLE, "is no NumPy file that can be read: " + text};
}

// Behind "'key':", without blanks in front; empty where there is no such key.
std::string_view valueOf(std::string_view header, const std::string& key)
{
    for (const char quote : {'\'', '"'}) {
        const std::size_t at = header.find(quote + key + quote);
        if (at == std::string_view::npos) continue;
        const std::size_t colon = header.find(':', at);
        if (colon == std::string_view::npos) continue;
        const std::size_t begin = header.find_first_not_of(" \t", colon + 1);
        if (begin != std::string_view::npos) return header.substr(begin);
    }
    return {};
}

std::string_view between(std::string_view text, char open, char close)
{
    if (text.empty() || text[0] != open) return {};
    const std::size_t end = text.find(close, 1);
    return end == std::string_view::npos ? std::string_view() : text.substr(1, end - 1);
}

Status parseType(std::string_view text, RawName& raw)
{
    std::string_view type = between(text, '\'', '\'');
    if (type.empty()) type = between(text, '"', '"');
    static const struct
    {
        const char* name;
        VoxelType type;
    } types[] = {{"b1", VoxelType::UINT8},  {"u1", VoxelType::UINT8}, {"i1", VoxelType::INT8},
                 {"u2", VoxelType::UINT16}, {"i2", VoxelType::INT16}, {"u4", VoxelType::UINT32},
                 {"i4", VoxelType::INT32},  {"f2", VoxelType::HALF},  {"f4", VoxelType::FLOAT32},
                 {"f8", VoxelType::FLOAT64}};
    if (type.size() < 2) return unreadable("its type is missing");
    for (const auto& t : types)
        if (type.substr(1) == t.name) {
            raw.type = t.type;
            raw.bigEndian = type[0] == '>';
            return {};
        }
    return {ErrorCode::NOT_SUPPORTED,
            "has numbers of type " + std::string(type.substr(0, 16)) + ", which no voxels are of"};
}

// Slowest axis first, whatever the order.
Status parseShape(std::string_view text, bool fortran, NumpyHeader& header)
{
    std::vector<std::int64_t> shape;
    for (const std::string_view piece : core::splitText(between(text, '(', ')'), ',')) {
        const std::vector<std::string_view> word = core::splitBlanks(piece);
        if (word.empty()) continue; // behind the last comma
        std::int64_t n = 0;
        if (word.size() != 1 || !core::parseInteger(word[0], n) || n < 1 ||
            n > std::numeric_limits<int>::max())
            return unreadable("its shape is (" + std::string(piece.substr(0, 32)) + ")");
        shape.push_back(n);
    }
    if (fortran) std::reverse(shape.begin(), shape.end());
    while (shape.size() > 3 && shape.front() == 1)
        shape.erase(shape.begin());
    if (shape.size() < 2 || shape.size() > 4)
        return {ErrorCode::NOT_SUPPORTED, "has an array of " + std::to_string(shape.size()) +
                                              " dimensions, expected z,y,x or time,z,y,x"};
    while (shape.size() < 4)
        shape.insert(shape.begin(), 1);
    header.steps = static_cast<int>(shape[0]);
    header.raw.size = {int(shape[3]), int(shape[2]), int(shape[1])};
    return {};
}

} // namespace

Result<NumpyHeader> NumpyHeader::parse(std::string_view head)
{
    constexpr std::size_t START = 10;
    if (head.size() < START + 2 || head.substr(0, 6) != "\x93NUMPY")
        return unreadable("it does not begin as one");
    const auto byte = [&head](std::size_t i) {
        return static_cast<std::size_t>(static_cast<unsigned char>(head[i]));
    };
    const bool isLong = byte(6) > 1;
    const std::size_t start = isLong ? START + 2 : START;
    const std::size_t length =
        byte(8) | byte(9) << 8 | (isLong ? byte(10) << 16 | byte(11) << 24 : 0);
    if (byte(6) < 1 || byte(6) > 3 || length > head.size() - start)
        return unreadable("its header is cut short");
    const std::string_view text = head.substr(start, length);
    NumpyHeader header;
    header.raw.headerBytes = static_cast<std::int64_t>(start + length);
    if (Status status = parseType(valueOf(text, "descr"), header.raw); !status.ok()) return status;
    const bool fortran = valueOf(text, "fortran_order").substr(0, 4) == "True";
    if (Status status = parseShape(valueOf(text, "shape"), fortran, header); !status.ok())
        return status;
    return header;
}

} // namespace io
} // namespace osgVolumizer
