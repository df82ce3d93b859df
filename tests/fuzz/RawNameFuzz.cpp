// Any text as the name of a raw file: either refused with a reason, or a format that makes sense.
#include <osgVolumizer/io/RawName.h>

#include <cstdlib>

using namespace osgVolumizer;

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    const std::string name(reinterpret_cast<const char*>(data), size);
    io::looksRaw(name);
    const Result<io::RawName> raw = io::parseRawName(name);
    if (!raw.ok()) {
        if (raw.status.text.empty()) std::abort();
        return 0;
    }
    if (raw->size.x < 1 || raw->size.y < 1 || raw->size.z < 1 || raw->headerBytes < 0) std::abort();
    if (raw->fileName.empty() || raw->fileBytes() <= raw->headerBytes - 1) std::abort();
    return 0;
}
