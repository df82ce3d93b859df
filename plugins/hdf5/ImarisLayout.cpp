// Imaris 5.5 (.ims). Sizes are in attributes, since datasets are padded to whole pieces; the volume
// reaches from ExtMin to ExtMax, which are borders of voxels and not the first and last sample.
#include "Layout.h"
#include "Values.h"

#include <osgVolumizer/core/NumberRule.h>
#include <osgVolumizer/core/Text.h>
#include <osgVolumizer/core/voxels/BrickTree.h>

#include <cmath>

namespace osgVolumizer {
namespace hdf5 {

namespace {

constexpr int MAXIMUM_CHANNELS = 1000;

std::string timePoint(int level, int step)
{
    return "/DataSet/ResolutionLevel " + std::to_string(level) + "/TimePoint " +
           std::to_string(step);
}

std::string channelPath(int level, int step, int channel)
{
    return timePoint(level, step) + "/Channel " + std::to_string(channel);
}

std::optional<double> numberAttribute(hid_t object, const std::string& name)
{
    const std::optional<std::string> text = textAttribute(object, name.c_str());
    const auto words = core::splitBlanks(text ? std::string_view(*text) : std::string_view());
    double value = 0.0;
    if (words.size() != 1 || !core::parseNumber(words[0], value)) return std::nullopt;
    return value;
}

// The samples of a level, and not those that fill its last pieces. Those of the dataset where
// nothing else is said.
Result<glm::ivec3> sizeOf(hid_t file, int level, int channel, const Dataset& data)
{
    const Result<glm::ivec3> whole = voxelSize(data, 0);
    if (!whole.ok()) return whole;
    glm::ivec3 size = *whole;
    const Handle group(H5Gopen2(file, channelPath(level, 0, channel).c_str(), H5P_DEFAULT),
                       H5Gclose);
    for (int axis = 0; axis < 3 && group.ok(); ++axis) {
        const std::string name = std::string("ImageSize") + "XYZ"[axis];
        if (H5Aexists(group, name.c_str()) <= 0) continue;
        const std::optional<double> said = numberAttribute(group, name);
        if (!said || !(*said >= 1.0 && *said <= size[axis]) || *said != std::floor(*said))
            return Status(ErrorCode::FILE_UNREADABLE,
                          name + " of level " + std::to_string(level) + " is " +
                              (said ? core::formatNumber(*said) : "no number") + ", of dataset " +
                              data.text());
        size[axis] = static_cast<int>(*said);
    }
    return size;
}

// Where the extents are none, the volume is where one without them is.
void setPlace(hid_t file, Layout& layout)
{
    VoxelSource::Description& description = layout.description;
    if (!exists(file, "/DataSetInfo/Image")) return;
    const Handle image(H5Gopen2(file, "/DataSetInfo/Image", H5P_DEFAULT), H5Gclose);
    glm::dvec3 spacing(1.0), origin(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const auto low = numberAttribute(image, "ExtMin" + std::to_string(axis));
        const auto high = numberAttribute(image, "ExtMax" + std::to_string(axis));
        spacing[axis] = (high.value_or(0.0) - low.value_or(0.0)) / description.size[axis];
        origin[axis] = low.value_or(0.0) + 0.5 * spacing[axis];
        if (core::LENGTH.holds(spacing[axis]) && core::POSITION.holds(origin[axis])) continue;
        layout.notices.push_back("ExtMin and ExtMax of axis " + std::to_string(axis) +
                                 " are no extent, and so the spacing is 1,1,1");
        return;
    }
    description.spacing = spacing;
    description.origin = origin;
}

// The axes are halved one by one, the longest first: each level is used for what it is.
Status addResolutionLevels(hid_t file, int channel, Layout& layout, std::vector<int>& numbers)
{
    for (int level = 1; level < core::BrickTree::MAXIMUM_LEVELS; ++level) {
        const std::string path = channelPath(level, 0, channel) + "/Data";
        if (!exists(file, path)) return {};
        const Result<Dataset> data = inspect(file, path);
        if (!data.ok()) return data.status;
        if (Status status = checkLevel(*data); !status.ok()) return status;
        const Result<glm::ivec3> size = sizeOf(file, level, channel, *data);
        if (!size.ok()) return size.status;
        FileLevel made{*size, {}};
        for (int axis = 0; axis < 3; ++axis)
            made.halvings[axis] = halvingsOf(layout.description.size[axis], (*size)[axis]);
        addLevel(level, made, layout, numbers);
    }
    return {};
}

} // namespace

bool isImaris(hid_t file)
{
    return exists(file, timePoint(0, 0));
}

Result<Layout> imarisLayout(hid_t file, const Wanted& wanted)
{
    std::vector<int> channels;
    for (int i = 0; i < MAXIMUM_CHANNELS && exists(file, channelPath(0, 0, i)); ++i)
        channels.push_back(i);
    const int channel = wanted.channel.value_or(0);
    if (Status status = checkChannel("channel", channels, channel); !status.ok()) return status;
    const Result<Dataset> data = inspect(file, channelPath(0, 0, channel) + "/Data");
    if (!data.ok()) return data.status;
    if (Status status = checkLevel(*data); !status.ok()) return status;
    Result<Layout> layout = layoutOf(file, *data);
    if (!layout.ok()) return layout;
    layout->channels = static_cast<int>(channels.size());
    const Result<glm::ivec3> size = sizeOf(file, 0, channel, *data);
    if (!size.ok()) return size.status;
    layout->description.size = layout->levels[0].size = *size;
    setPlace(file, *layout);
    std::vector<int> numbers{0};
    if (Status status = addResolutionLevels(file, channel, *layout, numbers); !status.ok())
        return status;
    while (exists(file, channelPath(0, layout->steps, channel)))
        ++layout->steps;
    layout->pathOf = [numbers, channel](int step, int level) {
        return channelPath(numbers[std::size_t(level)], step, channel) + "/Data";
    };
    return layout;
}

} // namespace hdf5
} // namespace osgVolumizer
