// Any text as an option string: either refused with a reason, or options that are written and read
// back the same.
#include <osgVolumizer/io/VoxelOptions.h>

#include <cstdlib>

using namespace osgVolumizer;

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    const std::string text(reinterpret_cast<const char*>(data), size);
    const Result<io::VoxelOptions> options = io::parseVoxelOptions(text);
    if (!options.ok()) {
        if (options.status.text.empty()) std::abort();
        return 0;
    }
    if (options->spacing && !(options->spacing->x > 0.0)) std::abort();
    const Result<io::VoxelOptions> again = io::parseVoxelOptions(options->voxelText());
    if (!again.ok() || again->spacing != options->spacing || again->origin != options->origin ||
        again->range != options->range || again->brick != options->brick ||
        again->dataset != options->dataset || again->channel != options->channel)
        std::abort();
    return 0;
}
