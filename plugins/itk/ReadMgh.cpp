// FreeSurfer's MGH and MGZ.

#include "NumberFile.h"

#include <osgVolumizer/core/voxels/VoxelData.h>

#include <cstring>

namespace osgVolumizer {
namespace medical {

namespace {

constexpr std::int64_t MGH_HEADER = 284;

// Big-endian, whatever the machine.
template <class T>
T field(const std::string& head, std::size_t offset)
{
    T value;
    std::memcpy(&value, head.data() + offset, sizeof(T));
    core::swapBytes(&value, sizeof(T), 1);
    return value;
}

bool numberOf(int type, Number& number)
{
    switch (type) {
    case 0:
        number = Number::UINT8;
        return true;
    case 1:
        number = Number::INT32;
        return true;
    case 3:
        number = Number::FLOAT32;
        return true;
    case 4:
        number = Number::INT16;
        return true;
    case 10:
        number = Number::UINT16;
        return true;
    default:
        return false;
    }
}

void placeMgh(const std::string& head, Samples& s)
{
    // Without a good direction: coronal.
    glm::dvec3 spacing(1.0), center(0.0);
    glm::dmat3 axes(-1, 0, 0, 0, 0, -1, 0, 1, 0);
    if (field<std::int16_t>(head, 28) > 0) {
        for (std::size_t i = 0; i < 3; ++i) {
            const int axis = static_cast<int>(i);
            spacing[axis] = field<float>(head, 30 + 4 * i);
            center[axis] = field<float>(head, 78 + 4 * i);
            for (std::size_t j = 0; j < 3; ++j)
                axes[axis][static_cast<int>(j)] = field<float>(head, 42 + 12 * i + 4 * j);
        }
    }
    for (int i = 0; i < 3; ++i)
        s.axes[i] = spacing[i] * axes[i];
    s.position = center - s.axes * (0.5 * glm::dvec3(s.size));
    for (glm::dvec3* v : {&s.axes[0], &s.axes[1], &s.axes[2], &s.position})
        *v *= glm::dvec3(-1, -1, 1); // from RAS
}

} // namespace

Result<Samples> readMgh(const std::string& path)
{
    const std::string head = headOf(path, MGH_HEADER);
    if (head.size() < MGH_HEADER || field<std::int32_t>(head, 0) != 1)
        return Status(ErrorCode::FILE_UNREADABLE,
                      path + " does not begin as files of FreeSurfer do");
    Samples samples;
    int size[4];
    for (std::size_t i = 0; i < 4; ++i) {
        size[i] = field<std::int32_t>(head, 4 + 4 * i);
        if (size[i] < 1)
            return Status(ErrorCode::VALUE_INVALID, path + " has " + std::to_string(size[i]) +
                                                        " samples on axis " + std::to_string(i));
    }
    const int type = field<std::int32_t>(head, 20);
    if (!numberOf(type, samples.number))
        return Status(ErrorCode::NOT_SUPPORTED, path + " has numbers of type " +
                                                    std::to_string(type) +
                                                    ", which no voxels are of");
    samples.size = {size[0], size[1], size[2]};
    samples.steps = size[3];
    placeMgh(head, samples);
    if (Status status = readNumbers(path, MGH_HEADER, true, samples); !status.ok()) return status;
    return samples;
}

} // namespace medical
} // namespace osgVolumizer
