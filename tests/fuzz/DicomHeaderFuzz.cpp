// Any bytes as a DICOM file: either refused with a reason, or pixels that lie within the file.
#include <osgVolumizer/io/DicomHeader.h>

#include <cstdlib>
#include <sstream>

using namespace osgVolumizer;

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    // The preamble is no part of the puzzle.
    const std::string bytes =
        std::string(128, '\0') + "DICM" + std::string(reinterpret_cast<const char*>(data), size);
    std::istringstream file(bytes);
    const Result<io::DicomHeader> header = io::readDicomHeader(file, "fuzz.dcm");
    if (!header.ok()) {
        if (header.status.text.empty()) std::abort();
        return 0;
    }
    if (header->pixelBytes() < 1 || header->pixelOffset < 132 ||
        header->pixelOffset + header->pixelBytes() > static_cast<std::int64_t>(bytes.size()))
        std::abort();
    return 0;
}
