#include "RawName.h"

#include "../core/Text.h"
#include "../core/voxels/VoxelData.h"

#include <limits>

namespace osgVolumizer {
namespace io {

namespace {

Status refuse(const std::string& name, const char* field, std::string_view value, const char* why)
{
    return {ErrorCode::VALUE_INVALID,
            name + ": " + field + " \"" + std::string(value) + "\" " + why};
}

} // namespace

std::int64_t RawName::fileBytes() const
{
    const std::int64_t voxels = core::voxelBytes(size, type, 1);
    constexpr std::int64_t highest = std::numeric_limits<std::int64_t>::max();
    return voxels > highest - headerBytes ? highest : voxels + headerBytes;
}

bool looksRaw(const std::string& name)
{
    const std::size_t dot = name.rfind('.');
    return dot != std::string::npos && name.find(',', dot) != std::string::npos &&
           name.find_first_of("/\\", dot) == std::string::npos;
}

Result<RawName> parseRawName(const std::string& name)
{
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos || dot == 0)
        return Status(ErrorCode::VALUE_INVALID,
                      name + ": a raw file is named file.width,height,depth,type");
    const std::vector<std::string_view> fields =
        core::splitText(std::string_view(name).substr(dot + 1), ',');
    if (fields.size() < 4 || fields.size() > 6)
        return Status(ErrorCode::VALUE_INVALID,
                      name + ": the format of a raw file has " + std::to_string(fields.size()) +
                          " fields where width,height,depth,type[,header[,big|little]] belong");
    RawName raw;
    raw.fileName = name.substr(0, dot);
    static const char* const axes[] = {"width", "height", "depth"};
    for (int axis = 0; axis < 3; ++axis) {
        const std::string_view field = fields[static_cast<std::size_t>(axis)];
        std::int64_t samples = 0;
        if (!core::parseInteger(field, samples) || samples < 1 ||
            samples > std::numeric_limits<int>::max())
            return refuse(name, axes[axis], field,
                          "is not a number of samples from 1 to 2147483647");
        raw.size[axis] = static_cast<int>(samples);
    }
    const Result<VoxelType> type = voxelTypeFromName(std::string(fields[3]));
    if (!type.ok()) return Status(type.status.code, name + ": " + type.status.text);
    raw.type = *type;
    if (fields.size() > 4 &&
        (!core::parseInteger(fields[4], raw.headerBytes) || raw.headerBytes < 0))
        return refuse(name, "header length", fields[4], "is not a number of bytes");
    if (fields.size() > 5) {
        if (fields[5] != "big" && fields[5] != "little")
            return refuse(name, "byte order", fields[5], "is neither big nor little");
        raw.bigEndian = fields[5] == "big";
    }
    return raw;
}

} // namespace io
} // namespace osgVolumizer
