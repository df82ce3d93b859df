// DICOM and the formats of medicine for readVoxels(): see osgVolumizer/io/FormatPlugin.h.

#include "DicomVolume.h"

#include <osgVolumizer/io/FileKind.h>
#include <osgVolumizer/io/FormatPlugin.h>

#include <osgDB/Registry>

namespace osgVolumizer {
namespace medical {
namespace {

class ReaderItk : public io::FormatPlugin
{
public:
    ReaderItk() : FormatPlugin("osgvolumizer_itk", "DICOM and medical files for osgVolumizer") {}
    const char* className() const override { return "osgVolumizer ITK reader"; }

protected:
    Result<io::Source> read(const io::VolumeRequest& request) const override
    {
        return readDicom(request);
    }
    Result<std::vector<VolumeEntry>> list(const io::VolumeRequest& request) const override
    {
        return listDicom(request);
    }
};

} // namespace
} // namespace medical
} // namespace osgVolumizer

using osgVolumizer::medical::ReaderItk;
REGISTER_OSGPLUGIN(osgvolumizer_itk, ReaderItk)
