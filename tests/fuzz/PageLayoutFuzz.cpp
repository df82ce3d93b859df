// Image descriptions of TIFF. The first two bytes say how many pages and samples there are.
#include <osgVolumizer/io/PageLayout.h>

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    using namespace osgVolumizer;
    if (size < 2) return 0;
    io::PageLayout::File file;
    file.pages = data[0] + 1;
    file.samples = data[1] % 5 + 1;
    file.xResolution = data[1];
    const io::PageLayout layout =
        io::PageLayout::parse({reinterpret_cast<const char*>(data) + 2, size - 2}, file);
    if (layout.slices < 1 || layout.channels < 1 || layout.steps < 1) std::abort();
    for (int t = 0; t < layout.steps; ++t)
        for (int c = 0; c < layout.channels; ++c)
            for (int z = 0; z < layout.slices; ++z) {
                const int page = layout.page(z, c, t);
                if (page < 0 || (page >= file.pages && !layout.single)) std::abort();
                if (layout.slices > 4096) return 0;
            }
    return 0;
}
