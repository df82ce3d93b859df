#include "VoxelOptions.h"

#include "../core/Text.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>

namespace osgVolumizer {
namespace io {

namespace {

using Setter = std::function<bool(VoxelOptions&, const std::string&)>;

struct Row
{
    const char* name;
    const char* expected; ///< completes "is ..., expected "
    const char* values;   ///< as they are written
    const char* help;
    Setter set; ///< false for a bad value
};

bool parseTriple(std::string_view text, glm::dvec3& v)
{
    return core::parseNumbers(text, &v.x, 3) && std::isfinite(v.x) && std::isfinite(v.y) &&
           std::isfinite(v.z);
}

bool setSpacing(VoxelOptions& o, const std::string& text)
{
    glm::dvec3 v;
    if (!parseTriple(text, v) || !(v.x > 0.0 && v.y > 0.0 && v.z > 0.0)) return false;
    o.spacing = v;
    return true;
}

bool setOrigin(VoxelOptions& o, const std::string& text)
{
    glm::dvec3 v;
    if (!parseTriple(text, v)) return false;
    o.origin = v;
    return true;
}

bool setRange(VoxelOptions& o, const std::string& text)
{
    glm::dvec2 v;
    if (!core::parseNumbers(text, &v.x, 2) || !(v.x < v.y) || !std::isfinite(v.y - v.x))
        return false;
    o.range = v;
    return true;
}

bool setBrick(VoxelOptions& o, const std::string& text)
{
    std::int64_t n[3];
    const std::vector<std::string_view> pieces = core::splitText(text, ',');
    if (pieces.size() != 1 && pieces.size() != 3) return false;
    for (std::size_t i = 0; i < 3; ++i)
        if (!core::parseInteger(pieces[pieces.size() == 3 ? i : 0], n[i]) || n[i] < 2 ||
            n[i] > 65536)
            return false;
    o.brick = glm::ivec3(static_cast<int>(n[0]), static_cast<int>(n[1]), static_cast<int>(n[2]));
    return true;
}

bool setOverlap(VoxelOptions& o, const std::string& text)
{
    std::int64_t n = 0;
    if (!core::parseInteger(text, n) || n < 0 || n > 1024) return false;
    o.overlap = static_cast<int>(n);
    return true;
}

constexpr const char* PARTIAL_NAMES[] = {"shrink_to_fit", "truncate", "average_up"};

bool setPartial(VoxelOptions& o, const std::string& text)
{
    const auto name = std::find(std::begin(PARTIAL_NAMES), std::end(PARTIAL_NAMES), text);
    if (name == std::end(PARTIAL_NAMES)) return false;
    o.partial = static_cast<core::PartialBricks>(name - std::begin(PARTIAL_NAMES));
    return true;
}

bool setSeries(VoxelOptions& o, const std::string& text)
{
    if (text == "on" || text == "off") o.series = text == "on";
    return text == "on" || text == "off";
}

// What no quotation marks can be put around could not be written again.
bool isWritable(const std::string& text)
{
    return !text.empty() &&
           (text.find('"') == std::string::npos || text.find('\'') == std::string::npos);
}

bool setDataset(VoxelOptions& o, const std::string& text)
{
    if (!isWritable(text)) return false;
    o.dataset = text;
    return true;
}

bool setDimensions(VoxelOptions& o, const std::string& text)
{
    const std::vector<std::string_view> names = core::splitText(text, ',');
    if (!isWritable(text) || names.size() < 2 || names.size() > 4) return false;
    o.dimensions = text;
    return true;
}

bool setChannel(VoxelOptions& o, const std::string& text)
{
    std::int64_t n = 0;
    if (!core::parseInteger(text, n) || n < 0 || n > std::numeric_limits<int>::max()) return false;
    o.channel = static_cast<int>(n);
    return true;
}

bool setTable(VoxelOptions& o, const std::string& text)
{
    if (!text.empty()) o.table = text;
    return !text.empty();
}

bool setRamp(VoxelOptions& o, const std::string& text)
{
    glm::dvec3 v(0.0, 0.0, 1.0);
    const auto count = core::splitText(text, ',').size();
    if (count < 2 || count > 3 || !core::parseNumbers(text, &v.x, int(count))) return false;
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !(v.z >= 0.0 && v.z <= 1.0)) return false;
    o.ramp = v;
    return true;
}

// Anatomical letters, as in NRRD and ITK: where the axis points. Object x is left, y posterior, z
// up.
bool setOrientation(VoxelOptions& o, const std::string& text)
{
    static const std::string letters = "LRPASI";
    glm::dmat3 axes(0.0);
    bool taken[3] = {};
    o.axesOfFile = text == "file";
    if (o.axesOfFile) o.axes.reset();
    if (text.size() != 3) return o.axesOfFile;
    for (int i = 0; i < 3; ++i) {
        const auto at = letters.find(
            static_cast<char>(std::toupper(static_cast<unsigned char>(text[std::size_t(i)]))));
        if (at == std::string::npos || taken[at / 2]) return false;
        taken[at / 2] = true;
        axes[i][static_cast<int>(at / 2)] = at % 2 == 0 ? 1.0 : -1.0;
    }
    o.axes = axes;
    return true;
}

const std::vector<Row>& rows()
{
    static const std::vector<Row> table{
        {"spacing", "three positive numbers, x,y,z", "x,y,z",
         "object units between samples; the file's, or 1,1,1", setSpacing},
        {"origin", "three numbers, x,y,z", "x,y,z",
         "object position of the first sample; the file's, or 0,0,0", setOrigin},
        {"orientation", "three letters of L or R, P or A, S or I, or file", "LPS or file",
         "where the axes of the voxels point: Left or Right, Posterior or Anterior, Superior or "
         "Inferior; object axes are LPS. file: as it says, also of a single slice, which else "
         "faces "
         "the viewer",
         setOrientation},
        {"range", "two rising numbers, low,high", "low,high",
         "data values at the ends of the table's domain", setRange},
        {"brick", "one or three numbers of samples from 2 to 65536", "n or x,y,z",
         "samples per axis of a brick; 256", setBrick},
        {"overlap", "a number of samples from 0 to 1024", "n",
         "samples that bricks share at least; more where light or cubic interpolation need it",
         setOverlap},
        {"partial", "shrink_to_fit, truncate or average_up", "shrink_to_fit, truncate, average_up",
         "where the size is no multiple of the bricks': the last one is smaller, left out, or "
         "moved back",
         setPartial},
        {"series", "on or off", "on, off",
         "files of a folder or a pattern are volumes, one time step each, and not slices",
         setSeries},
        {"dataset", "a name", "name",
         "which volume of several, as osgvolumizertool list names them: a series of DICOM (number, "
         "UID or description), a dataset of HDF5, a variable, a grid, an array of scalars; the "
         "largest",
         setDataset},
        {"channel", "a whole number from 0", "n",
         "which channel or component of several (setup of a BigDataViewer file); the first",
         setChannel},
        {"dimensions", "two to four names, x,y,z,time", "x,y,z,time",
         "which dimensions of a variable (NetCDF, Zarr) lie along x, y, z and time, by name; as "
         "the "
         "file says",
         setDimensions},
        {"table", "a file name", "file",
         "lookup table, .lut or .tf, beside the volume or on OSG's data path", setTable},
        {"ramp", "centre,width or centre,width,opacity with an opacity from 0 to 1",
         "centre,width[,opacity]",
         "a white table instead, that rises about a fraction of the range", setRamp},
    };
    return table;
}

Status unexpected(const core::Option& option, const std::string& expected)
{
    return {ErrorCode::VALUE_INVALID,
            "option " + option.name + " is \"" + option.value + "\", expected " + expected};
}

Status setOption(VoxelOptions& options, const core::Option& option)
{
    const auto row = std::find_if(rows().begin(), rows().end(),
                                  [&option](const Row& r) { return option.name == r.name; });
    const AppearanceProperty* property = findAppearanceOption(option.name);
    if (row == rows().end() && !property) {
        options.foreign.push_back(option.name);
        return {};
    }
    if (!option.closed) return unexpected(option, "a closing quotation mark");
    if (!property) {
        if (row->set(options, option.value)) return {};
        return unexpected(option, row->expected);
    }
    const Result<AppearanceProperty::Values> values =
        parseAppearanceValues(*property, option.value);
    if (!values.ok()) return {values.status.code, "option " + values.status.text};
    options.properties.emplace_back(property, *values);
    return {};
}

// Expects that one kind of quotation mark is not in it.
std::string inQuotes(const std::string& text)
{
    const char mark = text.find('"') == std::string::npos ? '"' : '\'';
    return mark + text + mark;
}

} // namespace

std::string VoxelOptions::voxelText() const
{
    std::string text;
    const auto add = [&](const char* name, const std::string& value) {
        text += (text.empty() ? "" : " ") + std::string(name) + "=" + value;
    };
    if (spacing) add("spacing", core::formatTriple(*spacing));
    if (origin) add("origin", core::formatTriple(*origin));
    if (range) add("range", core::formatNumber(range->x) + "," + core::formatNumber(range->y));
    if (brick) add("brick", core::formatTriple(*brick));
    if (overlap) add("overlap", std::to_string(*overlap));
    if (partial) add("partial", PARTIAL_NAMES[static_cast<int>(*partial)]);
    if (series) add("series", *series ? "on" : "off");
    if (dataset) add("dataset", inQuotes(*dataset));
    if (channel) add("channel", std::to_string(*channel));
    if (dimensions) add("dimensions", inQuotes(*dimensions));
    return text;
}

bool VoxelOptions::has(const char* option) const
{
    return std::any_of(properties.begin(), properties.end(),
                       [option](const auto& p) { return std::string(option) == p.first->option; });
}

std::vector<VolumeOption> voxelOptionHelp()
{
    std::vector<VolumeOption> help;
    for (const Row& row : rows())
        help.push_back({row.name, row.values, row.help});
    for (const AppearanceProperty& p : appearanceProperties())
        help.push_back({p.option, appearanceValueText(p), p.help});
    return help;
}

Result<VoxelOptions> parseVoxelOptions(const std::string& text)
{
    VoxelOptions options;
    for (const core::Option& option : core::splitOptions(text))
        if (Status status = setOption(options, option); !status.ok()) return status;
    return options;
}

} // namespace io
} // namespace osgVolumizer
