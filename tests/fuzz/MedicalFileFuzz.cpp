// What the plugin for medical images reads of files itself. The first byte says which reader it is.
#include <plugins/itk/NumberFile.h>
#include <plugins/itk/RunLengths.h>
#include <plugins/itk/Structure.h>

#include "TemporaryFile.h"

#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size)
{
    using namespace osgVolumizer;
    static const fuzz::TemporaryFile file("osgVolumizerMedicalFileFuzz");
    if (size < 4) return 0;
    const unsigned char which = data[0] % 4;
    if (which == 3) {
        const int samples = data[1] % 4 + 1, bytes = data[2] % 4 + 1;
        const std::size_t pixels = data[3];
        std::vector<char> to(pixels * std::size_t(samples * bytes) + 1);
        medical::decodeRunLengths(reinterpret_cast<const char*>(data) + 4, size - 4, samples, bytes,
                                  pixels, to.data());
        return 0;
    }
    file.write(data + 1, size - 1);
    if (which == 0) (void)medical::readNifti(file.path());
    if (which == 1) (void)medical::readMgh(file.path());
    if (which == 2) (void)medical::checkStructure(file.path());
    return 0;
}
