// HDF5 for readVoxels(), which asks for "scan.h5" as "scan.h5.osgvolumizer_hdf5", with the options
// dataset and channel as plugin data, and gets a VoxelSource or "ERROR_CODE: sentence".

#include "Hdf5Source.h"

#include <osgVolumizer/core/Text.h>

#include <osgDB/FileNameUtils>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>

#include <exception>
#include <limits>

namespace osgVolumizer {
namespace hdf5 {
namespace {

Result<Wanted> wantedBy(const osgDB::Options* options)
{
    Wanted wanted;
    if (!options) return wanted;
    wanted.dataset = options->getPluginStringData("dataset");
    const std::string channel = options->getPluginStringData("channel");
    std::int64_t number = 0;
    if (channel.empty()) return wanted;
    if (!core::parseInteger(channel, number) || number < 0 ||
        number > std::numeric_limits<int>::max())
        return Status(ErrorCode::VALUE_INVALID,
                      "option channel is \"" + channel + "\", expected a number from 0");
    wanted.channel = static_cast<int>(number);
    return wanted;
}

Result<osg::ref_ptr<Hdf5Source>> readSource(const std::string& path, const osgDB::Options* options)
{
    try {
        const Result<Wanted> wanted = wantedBy(options);
        if (!wanted.ok()) return wanted.status;
        osg::ref_ptr<Hdf5Source> source = new Hdf5Source;
        if (Status status = source->open(path, *wanted); !status.ok()) return status;
        return source;
    } catch (const std::exception& e) {
        return Status(ErrorCode::FILE_UNREADABLE, path + " cannot be read: " + e.what());
    }
}

class ReaderHdf5 : public osgDB::ReaderWriter
{
public:
    ReaderHdf5() { supportsExtension("osgvolumizer_hdf5", "HDF5 files for osgVolumizer"); }
    const char* className() const override { return "osgVolumizer HDF5 reader"; }

    ReadResult readObject(const std::string& name, const Options* options) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(name)))
            return ReadResult::FILE_NOT_HANDLED;
        const auto source = readSource(osgDB::getNameLessExtension(name), options);
        if (source.ok()) return ReadResult(source->get());
        return ReadResult(std::string(errorName(source.status.code)) + ": " + source.status.text);
    }
};

} // namespace
} // namespace hdf5
} // namespace osgVolumizer

using osgVolumizer::hdf5::ReaderHdf5;
REGISTER_OSGPLUGIN(osgvolumizer_hdf5, ReaderHdf5)
