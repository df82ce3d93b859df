#pragma once

#include <osgVolumizer/VoxelSource.h>

#include <string>

struct gzFile_s;

namespace osgVolumizer {
namespace medical {

/// A file that is written from its beginning to its end, packed by gzip or not.
class Sink
{
public:
    Sink(const std::string& path, bool packed);
    ~Sink();
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;

    void write(const void* data, std::size_t bytes);
    void write(const std::string& text) { write(text.data(), text.size()); }
    /// Whether all was written.
    bool close();

private:
    gzFile_s* _file;
    bool _good;
};

/// The type that samples are written in: half has none in these formats.
VoxelType writtenType(const VoxelSource::Description& description);

/// All samples of a source. `planar`: each component for itself.
Status writeSamples(Sink& sink, const VoxelSource& source, bool planar);

} // namespace medical
} // namespace osgVolumizer
