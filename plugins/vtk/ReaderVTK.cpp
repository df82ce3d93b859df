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
    std::optional<int> step, channel;
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
        if (option.name == "step" || option.name == "channel") {
            std::int64_t number = 0;
            if (!core::parseInteger(value, number) || number < 0 ||
                number > std::numeric_limits<int>::max())
                return bad();
            (option.name == "step" ? said.step : said.channel) = static_cast<int>(number);
        }
    }
    if (said.scalars.empty()) said.scalars = said.dataset;
    return said;
}

// The tetrahedra with their scalars or colours.
Result<osg::ref_ptr<VolumeGeometry>> makeVolume(GridGeometry& geometry)
{
    osg::ref_ptr<VolumeGeometry> volume = new VolumeGeometry;
    volume->setName(geometry.name);
    Status status = volume->setTetraSet(std::move(geometry.tetras));
    if (status.ok() && !geometry.scalars.empty())
        status = volume->setScalars(std::move(geometry.scalars),
                                    geometry.perTetrahedron ? VolumeGeometry::PER_TETRAHEDRON
                                                            : VolumeGeometry::PER_VERTEX);
    if (!status.ok()) return status;
    return volume;
}

void tell(const std::string& path, const std::string& what)
{
    OSG_NOTICE << "osgVolumizer: " << path << what << std::endl;
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
        tell(path, " has " + std::to_string(file->steps) +
                       " time steps, the first of which is shown; step=n shows another");
    Result<GridGeometry> geometry = convertGrid(*file->grid, said->scalars, said->channel);
    if (!geometry) return inFile(geometry.status);
    if (!geometry->notice.empty()) tell(path, ": " + geometry->notice);
    if (const std::string left = geometry->leftOut.text(); !left.empty())
        tell(path, ": cells left out: " + left);

    osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->setName(osgDB::getSimpleFileName(path));
    const double step = geometry->spacing;
    Status status;
    // Of scalars a period is half a tetrahedron anyway.
    if (geometry->tetras.vertices.format().colorSize > 0)
        status = appearance->setSamplingPeriod(osg::Vec3d(step, step, step));
    if (status.ok())
        status = appearance->setOpacityUnit(said->unit > 0.0 ? said->unit : 10.0 * step);
    if (status.ok() && !said->table.empty()) {
        osg::ref_ptr<osgDB::Options> local = options ? options->cloneOptions() : new osgDB::Options;
        local->getDatabasePathList().push_back(osgDB::getFilePath(path));
        const Result<osg::ref_ptr<LookupTable>> table = readLookupTable(said->table, local.get());
        if (!table) return table.status;
        appearance->setLookupTable(table->get());
    }
    if (!status.ok()) return inFile(status);
    const Result<osg::ref_ptr<VolumeGeometry>> volume = makeVolume(*geometry);
    if (!volume.ok()) return inFile(volume.status);
    appearance->addChild(*volume);
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
        supportsOption("scalars=name",
                       "Point or cell array to show, cells:NAME where both have it; "
                       "the active scalars");
        supportsOption("channel=n", "Component of the array, from 0; the length of a vector");
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
