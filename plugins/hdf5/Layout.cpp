#include "Layout.h"
#include "Values.h"

#include <osgVolumizer/core/NumberRule.h>
#include <osgVolumizer/core/Text.h>
#include <osgVolumizer/core/voxels/BrickTree.h>

#include <algorithm>

namespace osgVolumizer {
namespace hdf5 {

int Layout::fileLevelFor(int level) const
{
    int best = 0;
    const auto sum = [](const glm::ivec3& v) { return v.x + v.y + v.z; };
    for (std::size_t i = 1; i < levels.size(); ++i) {
        const glm::ivec3& halvings = levels[i].halvings;
        if (std::max({halvings.x, halvings.y, halvings.z}) <= level &&
            sum(halvings) > sum(levels[std::size_t(best)].halvings))
            best = static_cast<int>(i);
    }
    return best;
}

int halvingsOf(int whole, int size)
{
    for (int n = 0; n < core::BrickTree::MAXIMUM_LEVELS; ++n) {
        const std::int64_t step = std::int64_t(1) << n;
        const std::int64_t down = std::max<std::int64_t>(whole / step, 1);
        if (size >= down && size <= (whole + step - 1) / step) return n;
    }
    return -1;
}

Result<Layout> layoutOf(hid_t file, const Dataset& dataset)
{
    if (Status status = checkVolume(dataset); !status.ok()) return status;
    Layout layout;
    layout.axes = *axesOf(dataset);
    const Result<glm::ivec3> size = voxelSize(dataset, layout.axes.z);
    if (!size.ok()) return size.status;
    if (dataset.rounded)
        layout.notices.push_back("values of dataset " + dataset.text() +
                                 " are rounded to those of float32");
    layout.description.size = *size;
    layout.description.type = layout.readAs = dataset.type;
    layout.levels = {{*size, glm::ivec3(0)}};
    const Handle id(H5Dopen2(file, dataset.path.c_str(), H5P_DEFAULT), H5Dclose);
    if (const auto spacing = tripleAttribute(id, "element_size_um"))
        if (core::LENGTH.holds(spacing->x) && core::LENGTH.holds(spacing->y) &&
            core::LENGTH.holds(spacing->z))
            layout.description.spacing = {spacing->z, spacing->y, spacing->x};
    return layout;
}

void addLevel(int number, const FileLevel& level, Layout& layout, std::vector<int>& numbers)
{
    if (level.halvings.x < 0 || level.halvings.y < 0 || level.halvings.z < 0) {
        layout.notices.push_back("level " + std::to_string(number) + " is not used, since its " +
                                 core::formatTriple(level.size) +
                                 " samples are no half, quarter, ... of the volume's");
        return;
    }
    layout.levels.push_back(level);
    numbers.push_back(number);
}

Status checkChannel(const char* what, const std::vector<int>& present, int wanted)
{
    if (std::find(present.begin(), present.end(), wanted) != present.end()) return {};
    constexpr std::size_t MOST = 5;
    std::string list;
    for (std::size_t i = 0; i < std::min(present.size(), MOST); ++i)
        list += (i ? ", " : "") + std::to_string(present[i]);
    if (present.size() > MOST) list += ", ... " + std::to_string(present.back());
    return {ErrorCode::INDEX_OUT_OF_RANGE,
            std::string("there is no ") + what + " " + std::to_string(wanted) +
                (list.empty() ? "" : ", but " + list),
            wanted};
}

Result<Layout> findLayout(hid_t file, const Wanted& wanted)
{
    if (!wanted.dataset.empty()) return datasetLayout(file, wanted);
    if (isImaris(file)) return imarisLayout(file, wanted);
    if (isBigDataViewer(file)) return bigDataViewerLayout(file, wanted);
    return datasetLayout(file, wanted);
}

} // namespace hdf5
} // namespace osgVolumizer
