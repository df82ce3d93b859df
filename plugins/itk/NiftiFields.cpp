#include "NiftiFields.h"

#include "Sink.h"

#include <osgVolumizer/io/Placement.h>

#include <algorithm>
#include <cstring>

namespace osgVolumizer {
namespace medical {

namespace {

using Description = VoxelSource::Description;

template <class T>
void put(std::string& head, std::size_t offset, double value)
{
    const T narrow = static_cast<T>(value);
    std::memcpy(&head[offset], &narrow, sizeof(T));
}

int niftiType(const Description& d)
{
    switch (writtenType(d)) {
    case VoxelType::INT8:
        return 256;
    case VoxelType::INT16:
        return 4;
    case VoxelType::UINT16:
        return 512;
    case VoxelType::INT32:
        return 8;
    case VoxelType::UINT32:
        return 768;
    case VoxelType::FLOAT64:
        return 64;
    case VoxelType::UINT8:
        return d.components == 4 ? 2304 : 2;
    default:
        return 16;
    }
}

/// Where the fields of a version stand, and what its numbers are.
struct Places
{
    std::size_t dim, pixdim, slope, qformCode, sformCode, srow, units, intent, type, bits, offset;
};
constexpr Places FIRST{40, 76, 112, 252, 254, 280, 123, 68, 70, 72, 108};
constexpr Places SECOND{16, 104, 176, 344, 348, 400, 500, 504, 12, 14, 168};

/// Size: of dimensions; Real: of places; Code: of codes; Units and Offset as they say.
template <class Size, class Real, class Code, class Units, class Offset>
void fill(std::string& head, const Places& at, const Description& d)
{
    constexpr int INTENT_RGBA = 2004, SCANNER = 1, MILLIMETRES = 2;
    const bool vector = d.components == 4 && writtenType(d) != VoxelType::UINT8;
    put<Size>(head, at.dim, vector ? 5 : 3);
    for (std::size_t i = 0; i < 7; ++i) {
        const int axis = static_cast<int>(i);
        put<Size>(head, at.dim + sizeof(Size) * (i + 1),
                  axis < 3              ? d.size[axis]
                  : axis == 4 && vector ? 4
                                        : 1);
        put<Real>(head, at.pixdim + sizeof(Real) * (i + 1), axis < 3 ? d.spacing[axis] : 1.0);
    }
    put<Real>(head, at.pixdim, 1.0);
    put<Real>(head, at.slope, 1.0);
    put<Code>(head, at.sformCode, SCANNER);
    put<Units>(head, at.units, MILLIMETRES);
    if (vector) put<Code>(head, at.intent, INTENT_RGBA);
    const int bytes = static_cast<int>(voxelTypeSize(writtenType(d)));
    put<std::int16_t>(head, at.type, niftiType(d));
    put<std::int16_t>(head, at.bits, 8 * bytes * (niftiType(d) == 2304 ? 4 : 1));
    put<Offset>(head, at.offset, double(head.size()));
    const glm::dvec3 position = io::placeOf(d, glm::dvec3(0.0));
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) {
            const double lps = column < 3 ? d.axes[column][row] * d.spacing[column] : position[row];
            put<Real>(head, at.srow + sizeof(Real) * static_cast<std::size_t>(4 * row + column),
                      row < 2 ? -lps : lps); // to RAS
        }
}

} // namespace

std::string niftiHeaderOf(const Description& d)
{
    constexpr int MOST_OF_FIRST = 32767;
    const bool first = std::max({d.size.x, d.size.y, d.size.z}) <= MOST_OF_FIRST;
    std::string head(first ? 352 : 544, '\0'); // with 4 bytes that say there are no extensions
    put<std::int32_t>(head, 0, first ? 348 : 540);
    if (first) {
        fill<std::int16_t, float, std::int16_t, std::uint8_t, float>(head, FIRST, d);
        std::memcpy(&head[344], "n+1", 3);
    } else {
        fill<std::int64_t, double, std::int32_t, std::int32_t, std::int64_t>(head, SECOND, d);
        std::memcpy(&head[4], "n+2\0\r\n\x1a\n", 8);
    }
    return head;
}

} // namespace medical
} // namespace osgVolumizer
