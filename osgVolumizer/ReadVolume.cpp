#include "ReadVolume.h"

#include "VolumeGeometry.h"
#include "core/transfer/ScanStatistics.h"
#include "io/RawName.h"
#include "io/VoxelOptions.h"

#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>

namespace osgVolumizer {

namespace {

/// The table, looked for beside the volume as well.
Result<osg::ref_ptr<LookupTable>> readTable(const std::string& table, const std::string& volume,
                                            const osgDB::Options* options)
{
    std::string path = osgDB::findDataFile(volume, options);
    if (path.empty() && io::looksRaw(volume))
        if (const auto raw = io::parseRawName(volume); raw.ok())
            path = osgDB::findDataFile(raw->fileName, options);
    if (path.empty()) path = volume; // a pattern
    osg::ref_ptr<osgDB::Options> local = options ? options->cloneOptions() : new osgDB::Options;
    local->getDatabasePathList().push_back(osgDB::getFilePath(path));
    return readLookupTable(table, local.get());
}

} // namespace

osg::ref_ptr<LookupTable> createSuggestedTable(const Voxels& voxels)
{
    osg::ref_ptr<LookupTable> table = new LookupTable;
    if (!voxels.valid() || voxels.getComponents() != 1) return table;
    const osg::Vec2d range = voxels.getRange();
    core::ScanStatistics statistics(voxels.getLayout().size(), {range.x(), range.y()});
    for (std::int64_t i = 0; i < voxels.getLayout().brickCount(); ++i) {
        const core::Box3i samples = voxels.getLayout().brick(i).samples;
        if (const Voxels::Block block = voxels.getBrick(i))
            statistics.add({block.data, voxels.getType(), 1, samples.size()}, samples.min);
    }
    table->setPoints(core::suggestTransferFunction(statistics).points(),
                     LookupTable::RANGE_FRACTION);
    return table;
}

Result<osg::ref_ptr<VolumeAppearance>>
readVolume(const std::string& name, const osgDB::Options* options, const Progress& progress)
{
    const Result<osg::ref_ptr<Voxels>> voxels = readVoxels(name, options, progress);
    if (!voxels.ok()) return voxels.status;
    // Parsed before, by readVoxels().
    const io::VoxelOptions said =
        *io::parseVoxelOptions(options ? options->getOptionString() : std::string());
    osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->setName(osgDB::getSimpleFileName(name));
    appearance->setVoxels(voxels->get());
    if (said.table) {
        const Result<osg::ref_ptr<LookupTable>> table = readTable(*said.table, name, options);
        if (!table.ok()) return table.status;
        appearance->setLookupTable(table->get());
    } else {
        appearance->setLookupTable(createSuggestedTable(**voxels).get());
    }
    const CallerReports quiet;
    if (said.unit)
        if (Status status = appearance->setOpacityUnit(*said.unit); !status.ok()) return status;
    appearance->addChild(VolumeGeometry::createBox(**voxels).get());
    return appearance;
}

} // namespace osgVolumizer
