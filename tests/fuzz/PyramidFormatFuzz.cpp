// Any text as the header of a pyramid: either refused with a reason, or voxels that make sense,
// which the header that is written of them says again.
#include <osgVolumizer/io/PyramidFormat.h>

#include <cstdlib>

using namespace osgVolumizer;

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    const std::string text(reinterpret_cast<const char*>(data), size);
    io::PyramidFormat::isPyramid(text);
    const Result<io::PyramidFormat> format = io::PyramidFormat::parse(text);
    if (!format.ok()) {
        if (format.status.text.empty()) std::abort();
        return 0;
    }
    if (!format->description.validate().ok()) std::abort();
    const Result<io::PyramidFormat> again = io::PyramidFormat::parse(format->text());
    if (!again.ok() || again->text() != format->text()) std::abort();
    format->tree();
    return 0;
}
