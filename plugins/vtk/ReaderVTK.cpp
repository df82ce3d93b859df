// Unstructured grids through VTK's own readers: .vtk (legacy) and .vtu (XML), as a VolumeAppearance
// over one VolumeGeometry, as in:
// osgviewer -O "table=heat.lut scalars=temperature unit=5" engine.vtu
// Images and rectilinear grids in .vtk are what readVolume() makes of them.

#include "GridFile.h"
#include "GridGeometry.h"

#include <osgVolumizer/Error.h>
#include <osgVolumizer/ReadVolume.h>
#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/VolumeGeometry.h>
#include <osgVolumizer/core/Text.h>

#include <osg/Notify>
#include <osgDB/FileNameUtils>
#include <osgDB/FileUtils>
#include <osgDB/ReaderWriter>
#include <osgDB/Registry>

#include <cmath>
#include <limits>
#include <optional>

#define OSGVOLUMIZER_TEXT_OF(name) #name
#define OSGVOLUMIZER_TEXT(name) OSGVOLUMIZER_TEXT_OF(name)
#define OSGVOLUMIZER_REGISTER(name, reader) REGISTER_OSGPLUGIN(name, reader)

namespace osgVolumizer {
namespace vtk {
namespace {

const char* const EXTENSION = OSGVOLUMIZER_TEXT(OSGVOLUMIZER_EXTENSION);

struct Said
{
    std::string table, scalars, dataset;
    double unit = 0.0; ///< 0: not said
    std::optional<int> step;
};

Result<Said> parseOptions(const osgDB::Options* options)
{
    Said said;
    for (const core::Option& option :
         core::splitOptions(options ? options->getOptionString() : std::string())) {
        const std::string& value = option.value;
        const auto bad = [&option]() {
            return Status(ErrorCode::VALUE_INVALID,
                          "option " + option.name + " is '" + option.value + "'");
        };
        if (option.name == "table") said.table = value;
        if (option.name == "scalars") said.scalars = value;
        if (option.name == "dataset") said.dataset = value;
        if (option.name == "unit") {
            if (!core::parseNumber(value, said.unit) || !(said.unit > 0.0) ||
                !std::isfinite(said.unit))
                return bad();
        }
        if (option.name == "step") {
            std::int64_t step = 0;
            if (!core::parseInteger(value, step) || step < 0 ||
                step > std::numeric_limits<int>::max())
                return bad();
            said.step = static_cast<int>(step);
        }
    }
    if (said.scalars.empty()) said.scalars = said.dataset;
    return said;
}

// The scalars in a row along x, from one sample below the range to one above it.
osg::ref_ptr<Voxels> rowOfValues(const osg::Vec2d& range)
{
    VoxelSource::Description description;
    description.size = {GridGeometry::SAMPLES + 3, 3, 3};
    description.type = VoxelType::FLOAT32;
    osg::ref_ptr<MemoryVoxelSource> source = new MemoryVoxelSource;
    source->allocate(description);
    auto* out = static_cast<float*>(source->data());
    for (int row = 0; row < 9; ++row)
        for (int i = 0; i < description.size.x; ++i)
            *out++ = static_cast<float>(range.x() +
                                        (range.y() - range.x()) * (i - 1) / GridGeometry::SAMPLES);
    return new Voxels(source);
}

// The volume is filled through the row of values; the spacing says how finely it is sampled.
Status fillWithScalars(const GridGeometry& geometry, VolumeAppearance& appearance)
{
    const osg::ref_ptr<Voxels> voxels = rowOfValues(geometry.range);
    Status status = voxels->setBrickSize({GridGeometry::SAMPLES + 3, 3, 3});
    if (status.ok()) status = voxels->setRange(geometry.range);
    if (status.ok())
        status =
            voxels->setSpacing(osg::Vec3d(geometry.spacing, geometry.spacing, geometry.spacing));
    appearance.setVoxels(voxels);
    return status;
}

Result<osg::ref_ptr<osg::Node>> read(const std::string& path, const osgDB::Options* options)
{
    const CallerReports withFile;
    const auto inFile = [&path](Status status) {
        status.text = "File '" + path + "': " + status.text + ".";
        return status;
    };
    const Result<Said> said = parseOptions(options);
    if (!said) return inFile(said.status);
    const Result<GridFile> file = readGrid(path, said->step.value_or(0));
    if (!file) return file.status;
    if (file->steps > 1 && !said->step)
        OSG_NOTICE << "osgVolumizer: " << path << " has " << file->steps
                   << " time steps, the first of which is shown; step=n shows another" << std::endl;
    Result<GridGeometry> geometry = convertGrid(*file->grid, said->scalars);
    if (!geometry) return inFile(geometry.status);

    osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->setName(osgDB::getSimpleFileName(path));
    const double step = geometry->spacing;
    Status status = geometry->scalars ? fillWithScalars(*geometry, *appearance)
                                      : appearance->setSamplingPeriod(osg::Vec3d(step, step, step));
    if (status.ok())
        status = appearance->setOpacityUnit(said->unit > 0.0 ? said->unit : 10.0 * step);
    if (status.ok() && !said->table.empty()) {
        osg::ref_ptr<osgDB::Options> local = options ? options->cloneOptions() : new osgDB::Options;
        local->getDatabasePathList().push_back(osgDB::getFilePath(path));
        const Result<osg::ref_ptr<LookupTable>> table = readLookupTable(said->table, local.get());
        if (!table) return table.status;
        appearance->setLookupTable(table->get());
    }
    osg::ref_ptr<VolumeGeometry> volume = new VolumeGeometry;
    volume->setName(geometry->name);
    if (status.ok()) status = volume->setTetraSet(std::move(geometry->tetras));
    if (!status.ok()) return inFile(status);
    appearance->addChild(volume);
    return osg::ref_ptr<osg::Node>(appearance);
}

// An image or a rectilinear grid: voxels, with readVolume()'s options, and scalars= for dataset=.
Result<osg::ref_ptr<osg::Node>> readVoxelsOf(const std::string& path, const osgDB::Options* options)
{
    osg::ref_ptr<osgDB::Options> local = options ? options->cloneOptions() : new osgDB::Options;
    const Result<Said> said = parseOptions(options);
    if (said && said->dataset.empty() && !said->scalars.empty()) {
        const char mark = said->scalars.find('"') == std::string::npos ? '"' : '\'';
        local->setOptionString(local->getOptionString() + " dataset=" + mark + said->scalars +
                               mark);
    }
    const auto volume = readVolume(path, local);
    if (!volume.ok()) return volume.status;
    return osg::ref_ptr<osg::Node>(volume->get());
}

class ReaderVTK : public osgDB::ReaderWriter
{
public:
    ReaderVTK()
    {
        supportsExtension(EXTENSION, "Unstructured grid of VTK (osgVolumizer)");
        supportsOption("step=n", "Time step of a .vtu file of several, from 0; the first");
        supportsOption("scalars=name", "Point array to show; the active scalars");
        supportsOption("table=file", "Lookup table for scalars, .lut or .tf; a white ramp");
        supportsOption("unit=x", "Object units that opacities are stated for");
    }
    const char* className() const override { return "osgVolumizer reader of VTK's grids"; }

    ReadResult readObject(const std::string& name, const Options* options) const override
    {
        return readNode(name, options);
    }
    ReadResult readNode(const std::string& name, const Options* options) const override
    {
        if (!acceptsExtension(osgDB::getLowerCaseFileExtension(name)))
            return ReadResult::FILE_NOT_HANDLED;
        const std::string path = osgDB::findDataFile(name, options);
        if (path.empty()) return ReadResult::FILE_NOT_FOUND;
        const Result<osg::ref_ptr<osg::Node>> node =
            holdsVolume(path) ? readVoxelsOf(path, options) : read(path, options);
        if (node.ok()) return node->get();
        reportError(node.status);
        return ReadResult(node.status.text); // that is, ERROR_IN_READING_FILE
    }
};

} // namespace
} // namespace vtk
} // namespace osgVolumizer

using osgVolumizer::vtk::ReaderVTK;
OSGVOLUMIZER_REGISTER(OSGVOLUMIZER_EXTENSION, ReaderVTK)
