// Headers of NumPy files, and what kind of file something is.
#include <osgVolumizer/io/FileKind.h>
#include <osgVolumizer/io/NumpyHeader.h>

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    using namespace osgVolumizer;
    const std::string_view head(reinterpret_cast<const char*>(data), size);
    io::fileKindOf(head, "fuzz");
    const Result<io::NumpyHeader> header = io::NumpyHeader::parse(head);
    if (header.ok() && (header->steps < 1 || header->raw.size.x < 1 ||
                        header->raw.headerBytes > static_cast<std::int64_t>(size)))
        std::abort();
    return 0;
}
