// NetCDF, Zarr and HDF5 for readVoxels(), by GDAL: see osgVolumizer/io/FormatPlugin.h.

#include "GdalSource.h"
#include "Session.h"

#include <osgVolumizer/io/FormatPlugin.h>

#include <osgDB/Registry>

namespace osgVolumizer {
namespace gdal {
namespace {

class ReaderGdal : public io::FormatPlugin
{
public:
    ReaderGdal() : FormatPlugin("osgvolumizer_gdal", "NetCDF and Zarr files for osgVolumizer") {}
    const char* className() const override { return "osgVolumizer GDAL reader"; }

protected:
    Result<io::Source> read(const io::VolumeRequest& request) const override
    {
        if (request.channel.value_or(0) > 0)
            return Status(ErrorCode::INDEX_OUT_OF_RANGE,
                          request.path + ": variables have one channel each, there is no channel " +
                              std::to_string(*request.channel));
        osg::ref_ptr<GdalSource> source = new GdalSource;
        if (Status status = source->open(request.path, request.dataset, request.dimensions);
            !status.ok())
            return status;
        return io::Source(source);
    }

    Result<std::vector<VolumeEntry>> list(const io::VolumeRequest& request) const override
    {
        const Session session;
        const Result<std::shared_ptr<const File>> file = File::open(request.path);
        if (!file.ok()) return file.status;
        const Result<std::size_t> chosen = (*file)->choose(request.dataset);
        if (!chosen.ok()) return chosen.status;
        std::vector<VolumeEntry> entries;
        for (std::size_t i = 0; i < (*file)->variables().size(); ++i) {
            const Variable& variable = (*file)->variables()[i];
            const bool isChosen = i == *chosen;
            const osg::ref_ptr<GdalSource> source = new GdalSource;
            const Status status =
                source->open(request.path, *file, i, isChosen ? request.dimensions : std::string());
            if (!status.ok() && isChosen) return status;
            if (!status.ok()) continue;
            const VoxelSource::Description d = source->describe();
            VolumeEntry entry;
            entry.name = variable.path;
            entry.text = variable.text();
            entry.size = {d.size.x, d.size.y, d.size.z};
            entry.type = d.type;
            entry.steps = source->stepCount();
            entry.chosen = isChosen;
            entries.push_back(entry);
        }
        return entries;
    }
};

} // namespace
} // namespace gdal
} // namespace osgVolumizer

using osgVolumizer::gdal::ReaderGdal;
REGISTER_OSGPLUGIN(osgvolumizer_gdal, ReaderGdal)
