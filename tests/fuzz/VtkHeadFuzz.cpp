// What is read of VTK's files before VTK reads them.
#include <plugins/vtkimage/FileHead.h>

#include "TemporaryFile.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    static const osgVolumizer::fuzz::TemporaryFile file("osgVolumizerVtkHeadFuzz");
    file.write(data, size);
    (void)osgVolumizer::vtkimage::readHead(file.path());
    return 0;
}
