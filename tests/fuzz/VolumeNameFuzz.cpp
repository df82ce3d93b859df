// Any text as a volume's name and as a loader's options: refused with a reason, or values within
// the bounds that the loader relies on.
#include <osgVolumizer/io/RawName.h>
#include <osgVolumizer/io/VoxelOptions.h>

#include <cstdlib>
#include <string>

using namespace osgVolumizer;

namespace {

void expect(bool condition)
{
    if (!condition) std::abort();
}

void checkRawName(const std::string& text)
{
    const auto raw = io::parseRawName(text);
    if (!raw.ok()) return expect(!raw.status.text.empty());
    expect(raw->size.x >= 1 && raw->size.y >= 1 && raw->size.z >= 1 && raw->headerBytes >= 0);
    expect(raw->fileBytes() > raw->headerBytes || raw->fileBytes() == INT64_MAX);
}

void checkOptions(const std::string& text)
{
    const auto options = io::parseVoxelOptions(text);
    if (!options.ok()) return expect(!options.status.text.empty());
    if (options->spacing) expect(options->spacing->x > 0.0);
    if (options->range) expect(options->range->x < options->range->y);
    if (options->brick) expect(options->brick->z >= 2);
    // What is written into scene files is read back as the same.
    const auto again = io::parseVoxelOptions(options->voxelText());
    expect(again.ok() && again->spacing == options->spacing && again->origin == options->origin &&
           again->range == options->range && again->brick == options->brick);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    const std::string text(reinterpret_cast<const char*>(data), size);
    checkRawName(text);
    checkOptions(text);
    return 0;
}
