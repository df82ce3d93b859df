#include "Sink.h"

#include <osgVolumizer/core/voxels/VoxelData.h>

#include <zlib.h>

#include <algorithm>
#include <vector>

namespace osgVolumizer {
namespace medical {

Sink::Sink(const std::string& path, bool packed)
    : _file(gzopen(path.c_str(), packed ? "wb6" : "wbT")), _good(_file != nullptr)
{
}

Sink::~Sink()
{
    if (_file) gzclose(_file);
}

void Sink::write(const void* data, std::size_t bytes)
{
    const auto* from = static_cast<const char*>(data);
    while (_good && bytes > 0) {
        const auto piece = static_cast<unsigned>(std::min<std::size_t>(bytes, 1 << 26));
        _good = gzwrite(_file, from, piece) == static_cast<int>(piece);
        from += piece;
        bytes -= piece;
    }
}

bool Sink::close()
{
    if (_file && gzclose(_file) != Z_OK) _good = false;
    _file = nullptr;
    return _good;
}

VoxelType writtenType(const VoxelSource::Description& d)
{
    return d.type == VoxelType::HALF ? VoxelType::FLOAT32 : d.type;
}

Status writeSamples(Sink& sink, const VoxelSource& source, bool planar)
{
    const VoxelSource::Description d = source.describe();
    const VoxelType type = writtenType(d);
    const std::size_t values =
        std::size_t(d.size.x) * std::size_t(d.size.y) * static_cast<std::size_t>(d.components);
    const std::size_t bytes = voxelTypeSize(type);
    const auto parts = static_cast<std::size_t>(planar ? d.components : 1);
    std::vector<char> slice(values * voxelTypeSize(d.type)), converted(values * bytes),
        part(values / parts * bytes);
    for (std::size_t c = 0; c < parts; ++c)
        for (int z = 0; z < d.size.z; ++z) {
            const core::Box3i region{{0, 0, z}, {d.size.x, d.size.y, z + 1}};
            if (Status status = source.read(region, slice.data()); !status.ok()) return status;
            core::convertVoxels(slice.data(), d.type, converted.data(), type, values);
            if (parts == 1) {
                sink.write(converted.data(), converted.size());
                continue;
            }
            for (std::size_t i = 0; i < values / parts; ++i)
                std::copy_n(&converted[(i * parts + c) * bytes], bytes, &part[i * bytes]);
            sink.write(part.data(), part.size());
        }
    return {};
}

} // namespace medical
} // namespace osgVolumizer
