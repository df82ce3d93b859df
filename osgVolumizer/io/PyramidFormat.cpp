#include "PyramidFormat.h"

#include "../core/Text.h"
#include "OiioTypes.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

namespace osgVolumizer {
namespace io {

namespace {

const char* const MAGIC = "osgVolumizer pyramid";

Status unreadablePyramid(const std::string& text)
{
    return {ErrorCode::FILE_UNREADABLE, "the header of the pyramid " + text};
}

} // namespace

Result<core::BrickTree> PyramidFormat::tree() const
{
    Result<core::BrickTree> tree = core::BrickTree::create(
        description.size, core::BrickTree::levelsFor(description.size, STEP), STEP);
    if (tree.ok() && tree->brickCount() > MAXIMUM_BRICKS)
        return Status(ErrorCode::TOO_LARGE,
                      "a pyramid of " + core::formatTriple(description.size) + " voxels has " +
                          std::to_string(tree->brickCount()) + " bricks, more than " +
                          std::to_string(MAXIMUM_BRICKS));
    return tree;
}

std::string PyramidFormat::text() const
{
    const VoxelSource::Description& d = description;
    return std::string(MAGIC) + " 1\nsize " + core::formatTriple(d.size) + "\ntype " +
           voxelTypeName(d.type) + "\ncomponents " + std::to_string(d.components) + "\nspacing " +
           core::formatNumbers(&d.spacing[0], 3) + "\norigin " +
           core::formatNumbers(&d.origin[0], 3) + "\naxes " +
           core::formatNumbers(&d.axes[0][0], 9) + "\nrule " +
           (rule == core::LevelRule::MODE ? "mode" : "mean") + "\nfrom " + oneLine(origin);
}

bool PyramidFormat::isPyramid(const std::string& description)
{
    return description.compare(0, std::string(MAGIC).size(), MAGIC) == 0;
}

Result<PyramidFormat> PyramidFormat::parse(const std::string& text)
{
    std::istringstream in(text);
    std::string line;
    if (!std::getline(in, line) || line != std::string(MAGIC) + " 1")
        return unreadablePyramid("does not begin with \"" + std::string(MAGIC) + " 1\"");
    std::map<std::string, std::string> values;
    while (std::getline(in, line)) {
        const std::size_t blank = std::min(line.find(' '), line.size());
        values[line.substr(0, blank)] = line.substr(std::min(blank + 1, line.size()));
    }
    PyramidFormat format;
    VoxelSource::Description& d = format.description;
    double size[3], components = 0.0;
    if (!core::parseNumbers(values["size"], size, 3)) return unreadablePyramid("has no size");
    for (int axis = 0; axis < 3; ++axis) {
        if (!(size[axis] >= 1.0 && size[axis] <= 1e9)) return unreadablePyramid("has a wrong size");
        d.size[axis] = static_cast<int>(size[axis]);
    }
    const Result<VoxelType> type = voxelTypeFromName(values["type"]);
    if (!type.ok()) return unreadablePyramid("has a wrong type: " + type.status.text);
    d.type = *type;
    if (!core::parseNumber(values["components"], components))
        return unreadablePyramid("has no number of components");
    d.components = components == 4.0 ? 4 : components == 1.0 ? 1 : 0;
    if (!core::parseNumbers(values["spacing"], &d.spacing[0], 3) ||
        !core::parseNumbers(values["origin"], &d.origin[0], 3) ||
        !core::parseNumbers(values["axes"], &d.axes[0][0], 9))
        return unreadablePyramid("does not say where the voxels lie");
    for (int i = 0; i < 9; ++i)
        if (!(std::abs(d.axes[i / 3][i % 3]) <= 1.001)) return unreadablePyramid("has wrong axes");
    if (values["rule"] != "mean" && values["rule"] != "mode")
        return unreadablePyramid("has a wrong rule");
    format.rule = values["rule"] == "mode" ? core::LevelRule::MODE : core::LevelRule::MEAN;
    format.origin = values["from"];
    if (Status status = d.validate(); !status.ok())
        return unreadablePyramid("describes no voxels: " + status.text);
    return format;
}

int PyramidFormat::layerCount(const core::BrickTree& tree)
{
    return pairOf(tree, tree.levelCount(), 0);
}

int PyramidFormat::pairOf(const core::BrickTree& tree, int level, int layer)
{
    int pair = layer;
    for (int i = 0; i < level; ++i)
        pair += tree.count(i).z;
    return pair;
}

} // namespace io
} // namespace osgVolumizer
