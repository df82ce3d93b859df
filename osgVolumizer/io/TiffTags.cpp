#include "TiffTags.h"

#include <algorithm>

namespace osgVolumizer {
namespace io {

namespace {

constexpr std::uint64_t BITS_PER_SAMPLE = 258, PHOTOMETRIC = 262, IMAGE_DEPTH = 32997;
constexpr std::uint64_t MAXIMUM_ENTRIES = 4096, MAXIMUM_PAGES = 1 << 20;

/// Numbers of a file in its own byte order; 0 beyond its end.
class Numbers
{
public:
    Numbers(std::istream& file, bool bigEndian) : _file(file), _bigEndian(bigEndian) {}
    std::uint64_t at(std::uint64_t offset, int bytes)
    {
        unsigned char b[8] = {};
        _file.clear();
        if (offset > (std::uint64_t(1) << 62)) return 0;
        _file.seekg(static_cast<std::streamoff>(offset));
        if (!_file.read(reinterpret_cast<char*>(b), bytes)) return 0;
        if (!_bigEndian) std::reverse(b, b + bytes);
        std::uint64_t number = 0;
        for (int i = 0; i < bytes; ++i)
            number = number << 8 | b[i];
        return number;
    }

private:
    std::istream& _file;
    bool _bigEndian;
};

} // namespace

TiffTags TiffTags::read(std::istream& file)
{
    TiffTags tags;
    char order[2] = {};
    file.clear();
    file.seekg(0, std::ios::end);
    const auto bytes = static_cast<std::uint64_t>(std::max<std::streamoff>(file.tellg(), 0));
    file.seekg(0);
    if (!file.read(order, 2) || order[0] != order[1] || (order[0] != 'I' && order[0] != 'M'))
        return tags;
    Numbers numbers(file, order[0] == 'M');
    const std::uint64_t magic = numbers.at(2, 2);
    if (magic != 42 && magic != 43) return tags;
    const bool big = magic == 43;
    std::uint64_t directory = big ? numbers.at(8, 8) : numbers.at(4, 4);
    const std::uint64_t entries = std::min(numbers.at(directory, big ? 8 : 2), MAXIMUM_ENTRIES);
    tags.bitsPerSample = 1;
    for (std::uint64_t i = 0; i < entries; ++i) {
        const std::uint64_t entry = directory + (big ? 8 + 20 * i : 2 + 12 * i);
        const std::uint64_t tag = numbers.at(entry, 2), isShort = numbers.at(entry + 2, 2) == 3;
        const std::uint64_t count = big ? numbers.at(entry + 4, 8) : numbers.at(entry + 4, 4);
        const std::uint64_t value = entry + (big ? 12 : 8);
        const std::uint64_t number = numbers.at(value, isShort ? 2 : 4);
        if (tag == IMAGE_DEPTH) tags.imageDepth = std::max<std::uint64_t>(1, number);
        if (tag == PHOTOMETRIC) tags.minIsWhite = number == 0;
        // Of several channels the numbers may lie elsewhere.
        const bool inPlace = count <= (big ? 4u : 2u);
        if (tag == BITS_PER_SAMPLE)
            tags.bitsPerSample = inPlace ? number : numbers.at(numbers.at(value, big ? 8 : 4), 2);
    }
    // A link to a directory beyond the end is what is left of a file that was cut short.
    for (std::uint64_t page = 0; page < MAXIMUM_PAGES && directory; ++page) {
        const std::uint64_t count = std::min(numbers.at(directory, big ? 8 : 2), MAXIMUM_ENTRIES);
        const std::uint64_t link = (big ? 8 + 20 * count : 2 + 12 * count), size = big ? 8 : 4;
        if (directory > bytes || link + size > bytes - directory) {
            tags.lostPage = page;
            break;
        }
        directory = numbers.at(directory + link, static_cast<int>(size));
    }
    return tags;
}

} // namespace io
} // namespace osgVolumizer
