// BigDataViewer (.h5). The XML file beside it, which has the spacing, is not read.
#include "Layout.h"
#include "Values.h"

#include <osgVolumizer/core/Text.h>
#include <osgVolumizer/core/voxels/BrickTree.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace osgVolumizer {
namespace hdf5 {

namespace {

constexpr int MAXIMUM_SETUPS = 1000;

std::string numbered(const char* form, int number)
{
    char text[16];
    std::snprintf(text, sizeof(text), form, number);
    return text;
}

std::string cellsPath(int step, int setup, int level)
{
    return numbered("/t%05d", step) + numbered("/s%02d", setup) + "/" + std::to_string(level) +
           "/cells";
}

std::vector<int> setupsOf(hid_t file)
{
    std::vector<int> setups;
    if (!exists(file, numbered("/t%05d", 0))) return setups;
    for (int setup = 0; setup < MAXIMUM_SETUPS; ++setup)
        if (exists(file, cellsPath(0, setup, 0))) setups.push_back(setup);
    return setups;
}

// -1 for a factor that is no power of two.
int exponentOf(double factor)
{
    int exponent = 0;
    return std::frexp(factor, &exponent) == 0.5 && exponent > 0 ? exponent - 1 : -1;
}

// Each axis by the factor that is said of it, if that is a power of two and the size agrees.
glm::ivec3 halvingsBy(const glm::ivec3& whole, const glm::ivec3& size, const glm::dvec3* factors)
{
    glm::ivec3 halvings(-1);
    for (int axis = 0; axis < 3; ++axis) {
        if (!factors) {
            halvings[axis] = halvingsOf(whole[axis], size[axis]);
            continue;
        }
        const int n = exponentOf((*factors)[axis]);
        if (n < 0 || n >= core::BrickTree::MAXIMUM_LEVELS) continue;
        const std::int64_t step = std::int64_t(1) << n;
        if (size[axis] >= std::max<std::int64_t>(whole[axis] / step, 1) &&
            size[axis] <= (whole[axis] + step - 1) / step)
            halvings[axis] = n;
    }
    return halvings;
}

Status addMipmaps(hid_t file, int setup, Layout& layout, std::vector<int>& numbers)
{
    const std::vector<glm::dvec3> factors =
        triplesOf(file, numbered("/s%02d", setup) + "/resolutions");
    for (int level = 1; level < core::BrickTree::MAXIMUM_LEVELS; ++level) {
        const std::string path = cellsPath(0, setup, level);
        if (!exists(file, path)) return {};
        const Result<Dataset> cells = inspect(file, path);
        if (!cells.ok()) return cells.status;
        if (Status status = checkLevel(*cells); !status.ok()) return status;
        const Result<glm::ivec3> size = voxelSize(*cells, 0);
        if (!size.ok()) return size.status;
        const bool said = std::size_t(level) < factors.size();
        const FileLevel made{*size, halvingsBy(layout.description.size, *size,
                                               said ? &factors[std::size_t(level)] : nullptr)};
        addLevel(level, made, layout, numbers);
    }
    return {};
}

} // namespace

bool isBigDataViewer(hid_t file)
{
    return !setupsOf(file).empty();
}

Result<Layout> bigDataViewerLayout(hid_t file, const Wanted& wanted)
{
    const std::vector<int> setups = setupsOf(file);
    const int setup = wanted.channel.value_or(setups.front());
    if (Status status = checkChannel("setup", setups, setup); !status.ok()) return status;
    const Result<Dataset> cells = inspect(file, cellsPath(0, setup, 0));
    if (!cells.ok()) return cells.status;
    if (Status status = checkLevel(*cells); !status.ok()) return status;
    Result<Layout> layout = layoutOf(file, *cells);
    if (!layout.ok()) return layout;
    layout->channels = static_cast<int>(setups.size());
    // Java has no unsigned numbers: these are written as signed ones of the same bits.
    if (cells->type == VoxelType::INT16) layout->description.type = VoxelType::UINT16;
    std::vector<int> numbers{0};
    if (Status status = addMipmaps(file, setup, *layout, numbers); !status.ok()) return status;
    while (exists(file, cellsPath(layout->steps, setup, 0)))
        ++layout->steps;
    layout->pathOf = [numbers, setup](int step, int level) {
        return cellsPath(step, setup, numbers[std::size_t(level)]);
    };
    return layout;
}

} // namespace hdf5
} // namespace osgVolumizer
