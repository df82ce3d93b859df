// DICOM and the formats of medicine for readVoxels(): see osgVolumizer/io/FormatPlugin.h.

#include "DicomVolume.h"
#include "ItkFile.h"
#include "NumberFile.h"
#include "WriteFile.h"

#include <osgVolumizer/io/FileKind.h>
#include <osgVolumizer/io/FormatPlugin.h>
#include <osgVolumizer/io/PluginFile.h>

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/Registry>

#include <algorithm>

namespace osgVolumizer {
namespace medical {
namespace {

bool isDicom(const io::VolumeRequest& request)
{
    return !request.files.empty() || io::fileKindOf(request.path) == io::FileKind::DICOM;
}

bool nameEndsIn(const std::string& path, std::initializer_list<const char*> ends)
{
    const std::string name = osgDB::convertToLowerCase(path);
    return std::any_of(ends.begin(), ends.end(), [&name](const std::string& end) {
        return name.size() > end.size() &&
               name.compare(name.size() - end.size(), end.size(), end) == 0;
    });
}

// By how it begins, unpacked: NIfTI and Analyze by the length of their header.
bool isNifti(const std::string& path)
{
    if (nameEndsIn(path, {".img", ".img.gz", ".nii", ".nii.gz", ".nia"})) return true;
    const std::string head = headOf(path, 4);
    for (const char* start : {"\x5c\x01\0\0", "\0\0\x01\x5c", "\x1c\x02\0\0", "\0\0\x02\x1c"})
        if (head == std::string(start, 4)) return true;
    return false;
}

// One that is no DICOM file, which has one volume, without a name.
Result<Samples> samplesOf(const io::VolumeRequest& request)
{
    if (!request.dataset.empty())
        return Status(ErrorCode::VALUE_INVALID, request.path +
                                                    " has one volume, and none of the name \"" +
                                                    request.dataset + '"');
    if (nameEndsIn(request.path, {".mgh", ".mgz", ".mgh.gz"})) return readMgh(request.path);
    return isNifti(request.path) ? readNifti(request.path) : readItkFile(request.path);
}

class ReaderItk : public io::FormatPlugin
{
public:
    ReaderItk() : FormatPlugin("osgvolumizer_itk", "DICOM and medical files for osgVolumizer") {}
    const char* className() const override { return "osgVolumizer ITK reader"; }

protected:
    Result<io::Source> read(const io::VolumeRequest& request) const override
    {
        if (isDicom(request)) return readDicom(request);
        const Result<Samples> samples = samplesOf(request);
        if (!samples.ok()) return samples.status;
        if (!samples->note.empty())
            OSG_NOTICE << "osgVolumizer: " << request.path << ": " << samples->note << std::endl;
        return sourceOf(*samples, request);
    }
    Result<std::vector<VolumeEntry>> list(const io::VolumeRequest& request) const override
    {
        if (isDicom(request)) return listDicom(request);
        const Result<Samples> samples = samplesOf(request);
        if (!samples.ok()) return samples.status;
        io::VolumeRequest quiet = request;
        if (!request.channel && !samples->colour) quiet.channel = 0;
        const Result<io::Source> source = sourceOf(*samples, quiet);
        if (!source.ok()) return source.status;
        VolumeEntry entry = io::entryOf(**source, "");
        entry.channels = samples->channels;
        entry.chosen = true;
        return std::vector<VolumeEntry>{entry};
    }
    Status write(const VoxelSource& source, const std::string& path) const override
    {
        return writeFile(source, path);
    }
};

} // namespace
} // namespace medical
} // namespace osgVolumizer

using osgVolumizer::medical::ReaderItk;
REGISTER_OSGPLUGIN(osgvolumizer_itk, ReaderItk)
