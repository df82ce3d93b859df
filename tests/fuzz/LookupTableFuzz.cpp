// Any text as a .lut: either refused with a reason, or points that a table takes.
#include <osgVolumizer/LookupTable.h>

#include <cstdlib>
#include <string>

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    const std::string text(reinterpret_cast<const char*>(data), size);
    auto points = osgVolumizer::parseLookupTable(text, "fuzz.lut");
    if (!points.ok()) {
        if (points.status.text.empty()) std::abort();
        return 0;
    }
    osg::ref_ptr<osgVolumizer::LookupTable> table = new osgVolumizer::LookupTable;
    if (!table->setPoints(*points, osgVolumizer::LookupTable::DATA_VALUES).ok()) std::abort();
    return 0;
}
