// OpenVDB for readVoxels(): see osgVolumizer/io/FormatPlugin.h.

#include "GridList.h"
#include "GridSource.h"

#include <osgVolumizer/core/Text.h>
#include <osgVolumizer/io/FormatPlugin.h>

#include <osg/Notify>
#include <osgDB/Registry>

namespace osgVolumizer {
namespace vdb {
namespace {

Status withName(const Status& status, const std::string& path, const std::string& grid)
{
    return {status.code, path + ": grid \"" + grid + "\" cannot be read: " + status.text};
}

void notice(const std::string& path, const std::string& text)
{
    OSG_NOTICE << "osgVolumizer: " << path << ": " << text << std::endl;
}

class ReaderOpenVdb : public io::FormatPlugin
{
public:
    ReaderOpenVdb() : FormatPlugin("osgvolumizer_openvdb", "OpenVDB files for osgVolumizer") {}
    const char* className() const override { return "osgVolumizer OpenVDB reader"; }

protected:
    Result<io::Source> read(const io::VolumeRequest& request) const override
    {
        Result<GridList> list = GridList::open(request.path);
        if (!list.ok()) return list.status;
        const Result<std::size_t> chosen = list->choose(request.dataset);
        if (!chosen.ok()) return chosen.status;
        const GridEntry& entry = list->entries()[*chosen];
        if (request.dataset.empty() && list->entries().size() > 1)
            notice(request.path, "grid \"" + entry.name + "\" of " + list->names());
        if (request.channel && *request.channel >= entry.kind->channels)
            return Status(ErrorCode::INDEX_OUT_OF_RANGE,
                          request.path + ": grid \"" + entry.name + "\" has " +
                              std::to_string(entry.kind->channels) +
                              " channels, there is no channel " + std::to_string(*request.channel));
        const Result<GridToShow> show = gridToShow(list->readGrid(*chosen));
        if (!show.ok()) return withName(show.status, request.path, entry.name);
        const bool vectors = entry.kind->channels > 1;
        const io::Source source =
            vectors ? sourceOfVectors(*show, request.channel) : sourceOfNumbers(*show);
        if (!source)
            return withName({ErrorCode::NOT_SUPPORTED, "its values are no numbers"}, request.path,
                            entry.name);
        if (vectors && !request.channel)
            notice(request.path, "grid \"" + entry.name +
                                     "\" has vectors: their length is read; channel= chooses a "
                                     "component");
        const Status status = source->describe().validate();
        if (!status.ok()) return withName(status, request.path, entry.name);
        return source;
    }

    Result<std::vector<VolumeEntry>> list(const io::VolumeRequest& request) const override
    {
        Result<GridList> list = GridList::open(request.path);
        if (!list.ok()) return list.status;
        const Result<std::size_t> chosen = list->choose(request.dataset);
        if (!chosen.ok()) return chosen.status;
        std::vector<VolumeEntry> entries;
        for (std::size_t i = 0; i < list->entries().size(); ++i) {
            const GridEntry& grid = list->entries()[i];
            if (!grid.kind) continue;
            VolumeEntry entry;
            entry.name = grid.name;
            entry.text = grid.text();
            entry.size = {grid.size.x, grid.size.y, grid.size.z};
            entry.type = grid.kind->type;
            entry.channels = grid.kind->channels;
            entry.chosen = i == *chosen;
            entries.push_back(entry);
        }
        return entries;
    }
};

} // namespace
} // namespace vdb
} // namespace osgVolumizer

using osgVolumizer::vdb::ReaderOpenVdb;
REGISTER_OSGPLUGIN(osgvolumizer_openvdb, ReaderOpenVdb)
