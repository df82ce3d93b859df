// Any text as a .lut or .tf: either refused with a reason, or points that a table takes; and as a
// table of other programs.
#include <osgVolumizer/LookupTable.h>
#include <osgVolumizer/io/ForeignTable.h>

#include <cstdlib>
#include <string>

using namespace osgVolumizer;

namespace {

void check(const Result<LookupPoints>& points)
{
    if (!points.ok()) {
        if (points.status.text.empty()) std::abort();
        return;
    }
    osg::ref_ptr<LookupTable> table = new LookupTable;
    if (!table->setPoints(*points, LookupTable::DATA_VALUES).ok()) std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    const std::string text(reinterpret_cast<const char*>(data), size);
    check(parseLookupTable(text, "fuzz.lut"));
    check(parseTransferFunctionFile(text, "fuzz.tf"));
    for (const char* name : {"fuzz.lut", "fuzz.vp"})
        if (io::foreignTableFormat(text, name).size() > 60) std::abort();
    return 0;
}
