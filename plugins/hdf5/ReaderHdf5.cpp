// HDF5 for readVoxels(): see osgVolumizer/io/FormatPlugin.h.

#include "Hdf5Source.h"

#include <osgVolumizer/io/FormatPlugin.h>

#include <osgDB/Registry>

namespace osgVolumizer {
namespace hdf5 {
namespace {

class ReaderHdf5 : public io::FormatPlugin
{
public:
    ReaderHdf5() : FormatPlugin("osgvolumizer_hdf5", "HDF5 files for osgVolumizer") {}
    const char* className() const override { return "osgVolumizer HDF5 reader"; }

protected:
    Result<io::Source> read(const io::VolumeRequest& request) const override
    {
        const osg::ref_ptr<Hdf5Source> source = new Hdf5Source;
        Status status = source->open(request.path, {request.dataset, request.channel});
        if (!status.ok()) return status;
        return io::Source(source);
    }
    Result<std::vector<VolumeEntry>> list(const io::VolumeRequest& request) const override
    {
        const osg::ref_ptr<Hdf5Source> source = new Hdf5Source;
        Status status = source->open(request.path, {request.dataset, request.channel});
        if (!status.ok()) return status;
        return source->list();
    }
};

} // namespace
} // namespace hdf5
} // namespace osgVolumizer

using osgVolumizer::hdf5::ReaderHdf5;
REGISTER_OSGPLUGIN(osgvolumizer_hdf5, ReaderHdf5)
