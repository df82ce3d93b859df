#pragma once

#include "../core/Export.h"
#include "../core/Status.h"
#include "../core/voxels/VoxelType.h"

#include <glm/vec3.hpp>

#include <string>

namespace osgVolumizer {
namespace io {

/// The parts of a raw file's name: "engine.raw.256,256,110,uint8[,headerBytes[,big|little]]".
struct RawName
{
    std::string fileName; ///< "engine.raw"
    glm::ivec3 size{0};
    VoxelType type = VoxelType::UINT8;
    std::int64_t headerBytes = 0;
    bool bigEndian = false; ///< as the file is; little unless said otherwise
    int sliceStep = 1;      ///< of the file's slices, those of other channels lie between

    /// Bytes that the file has to have; saturates.
    std::int64_t fileBytes() const;
};

/// True where the part behind the last dot is a list, and so meant as the format of a raw file.
OSGVOLUMIZER_EXPORT bool looksRaw(const std::string& name);
/// Refuses (VALUE_INVALID) with the field and its value.
OSGVOLUMIZER_EXPORT Result<RawName> parseRawName(const std::string& name);

} // namespace io
} // namespace osgVolumizer
