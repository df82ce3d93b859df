#include "Info.h"

#include <osgVolumizer/ReadVolume.h>
#include <osgVolumizer/core/Text.h>
#include <osgVolumizer/core/voxels/VoxelData.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <iostream>

using namespace osgVolumizer;

namespace {

constexpr int BINS = 16, BAR = 50; // lines and characters of the histogram

struct Histogram
{
    double low, high;
    std::array<std::uint64_t, BINS> counts{};
    std::uint64_t samples = 0, missing = 0; ///< missing: no number
    double lowest = HUGE_VAL, highest = -HUGE_VAL;

    void add(double v)
    {
        ++samples;
        if (!std::isfinite(v)) {
            ++missing;
            return;
        }
        lowest = std::min(lowest, v);
        highest = std::max(highest, v);
        const double place = (v - low) / (high - low) * BINS;
        ++counts[static_cast<std::size_t>(std::clamp(place, 0.0, BINS - 1.0))];
    }
    /// A brick of a volume of `whole` samples, without those that the next ones have as well.
    void add(const VoxelBlock& block, const Voxels& voxels, const core::Box3i& part, int overlap,
             const glm::ivec3& whole)
    {
        const glm::ivec3 n = part.size();
        const core::VoxelView view{block.data, voxels.getType(), voxels.getComponents(), n};
        const int alpha = voxels.getComponents() == 4 ? 3 : 0;
        glm::ivec3 own = n;
        for (int axis = 0; axis < 3; ++axis)
            if (part.max[axis] < whole[axis]) own[axis] -= overlap;
        for (int z = 0; z < own.z; ++z)
            for (int y = 0; y < own.y; ++y)
                for (int x = 0; x < own.x; ++x)
                    add(core::voxelValue(view, (std::int64_t(z) * n.y + y) * n.x + x, alpha));
    }
};

// Of paged voxels the finest level of at most so many samples; which one that is.
Result<int> addAll(const Voxels& voxels, Histogram& histogram)
{
    constexpr std::int64_t MOST = std::int64_t(1) << 26;
    if (!voxels.isPaged()) {
        const core::BrickLayout& layout = voxels.getLayout();
        for (std::int64_t i = 0; i < layout.brickCount(); ++i) {
            const Result<VoxelBlock> block = voxels.readSamples(layout.brick(i).samples);
            if (!block.ok()) return block.status;
            histogram.add(*block, voxels, layout.brick(i).samples, layout.overlap(), layout.size());
        }
        return 0;
    }
    const core::BrickTree& tree = voxels.getTree();
    int level = 0;
    while (level + 1 < tree.levelCount() &&
           core::sampleCount(tree.levelSize(tree.size(), level)) > MOST)
        ++level;
    for (std::int64_t i = tree.index(level, glm::ivec3(0)), end = i + tree.brickCount(level);
         i < end; ++i) {
        const Result<VoxelBlock> block = voxels.readPage(i);
        if (!block.ok()) return block.status;
        histogram.add(*block, voxels, tree.brick(i).samples, voxels.getOverlap(),
                      tree.levelSize(tree.size(), level));
    }
    return level;
}

std::string bytesText(double bytes)
{
    static constexpr const char* units[] = {"bytes", "KB", "MB", "GB", "TB"};
    std::size_t unit = 0;
    for (; bytes >= 1000.0 && unit < 4; ++unit)
        bytes /= 1000.0;
    return core::formatNumber(std::round(bytes * 10.0) / 10.0) + " " + units[unit];
}

// The letter of the nearest direction of the patient.
char letterOf(const osg::Vec3d& axis)
{
    int nearest = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(axis[i]) > std::abs(axis[nearest])) nearest = i;
    return "LRPASI"[2 * nearest + (axis[nearest] < 0.0)];
}

std::string triple(const osg::Vec3d& v)
{
    return core::formatTriple(glm::dvec3(v.x(), v.y(), v.z()) + 0.0); // no -0
}

void printPlace(std::ostream& out, const Voxels& voxels)
{
    const osg::Matrixd place = getPlacement(voxels);
    const osg::Vec3i n = voxels.getSize();
    const osg::Vec3d spacing = voxels.getSpacing(), origin = voxels.getOrigin();
    const osg::Vec3d last =
        origin +
        osg::Vec3d(spacing.x() * (n.x() - 1), spacing.y() * (n.y() - 1), spacing.z() * (n.z() - 1));
    out << "spacing      " << triple(spacing) << '\n'
        << "first voxel  " << triple(origin * place) << '\n'
        << "last voxel   " << triple(last * place) << '\n';
    std::string letters;
    for (int i = 0; i < 3; ++i) {
        const osg::Vec3d axis(place(i, 0), place(i, 1), place(i, 2));
        letters += letterOf(axis);
        out << (i ? "             " : "axes         ") << triple(axis) << '\n';
    }
    const bool mirrored = (osg::Vec3d(place(0, 0), place(0, 1), place(0, 2)) ^
                           osg::Vec3d(place(1, 0), place(1, 1), place(1, 2))) *
                              osg::Vec3d(place(2, 0), place(2, 1), place(2, 2)) <
                          0.0;
    out << "orientation  " << letters << (mirrored ? ", left-handed" : "") << '\n';
}

void printHistogram(std::ostream& out, const Histogram& h)
{
    const std::uint64_t most = *std::max_element(h.counts.begin(), h.counts.end());
    for (int i = 0; i < BINS; ++i) {
        const std::uint64_t count = h.counts[std::size_t(i)];
        const int length =
            most ? static_cast<int>(std::ceil(double(count) / double(most) * BAR)) : 0;
        out << std::setw(14) << std::setprecision(6) << h.low + (h.high - h.low) * i / BINS << "  "
            << std::left << std::setw(BAR) << std::string(std::size_t(length), '#') << std::right
            << "  " << count << '\n';
    }
}

std::string typeText(VoxelType type, int components)
{
    return (components > 1 ? std::to_string(components) + " x " : "") + voxelTypeName(type);
}

} // namespace

Status printInfo(std::ostream& out, const Voxels& voxels)
{
    const osg::Vec3i n = voxels.getSize();
    const VoxelSource::Description d = voxels.getSource()->describe();
    out << "size         " << n.x() << " x " << n.y() << " x " << n.z() << " voxels of "
        << typeText(voxels.getType(), voxels.getComponents()) << '\n';
    printPlace(out, voxels);
    if (voxels.getStepCount() > 1) out << "time steps   " << voxels.getStepCount() << '\n';
    const double bytes = static_cast<double>(d.sizeInBytes());
    out << "memory       " << bytesText(bytes);
    if (voxels.getStepCount() > 1) out << " a time step";
    if (voxels.isPaged())
        out << ", of which as much is held as is shown, in " << voxels.getTree().levelCount()
            << " levels";
    out << '\n';
    const osg::Vec2d range = voxels.getRange();
    Histogram histogram{range.x(), range.y()};
    const Result<int> level = addAll(voxels, histogram);
    if (!level.ok()) return level.status;
    out << "values       " << (*level ? "about " : "");
    if (histogram.lowest <= histogram.highest)
        out << core::formatNumber(histogram.lowest) << " to "
            << core::formatNumber(histogram.highest);
    else
        out << "none";
    if (histogram.missing) out << ", and " << histogram.missing << " that are no numbers";
    out << "\nrange        " << core::formatNumber(range.x()) << " to "
        << core::formatNumber(range.y()) << " of the lookup table\nhistogram    of "
        << histogram.samples << " samples" << (voxels.getComponents() == 4 ? ", alpha" : "")
        << '\n';
    printHistogram(out, histogram);
    return {};
}

void printList(std::ostream& out, const std::vector<VolumeEntry>& entries)
{
    for (const VolumeEntry& entry : entries) {
        out << (entry.chosen ? "* " : "  ");
        if (!entry.name.empty()) out << entry.name << "  ";
        out << entry.size.x() << " x " << entry.size.y() << " x " << entry.size.z() << " of "
            << typeText(entry.type, entry.channels);
        if (entry.steps > 1) out << ", " << entry.steps << " time steps";
        if (!entry.text.empty()) out << "  " << entry.text;
        out << '\n';
    }
}
