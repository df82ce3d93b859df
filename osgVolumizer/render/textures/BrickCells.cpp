#include "BrickCells.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace osgVolumizer {
namespace render {

namespace {

// Keys's kernel overshoots: the weights of one sign sum up to ((5/4)^3 + 1)/2 in three dimensions.
constexpr double CUBIC_OVERSHOOT = 0.5 * (1.25 * 1.25 * 1.25 - 1.0);

osg::ref_ptr<osg::Texture3D> makeTexture(const glm::ivec3& count,
                                         const std::vector<std::uint8_t>& occupied)
{
    const std::vector<std::uint8_t> distances = core::chebyshevDistance(count, occupied);
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(count.x, count.y, count.z, GL_RED, GL_UNSIGNED_BYTE, 1);
    std::copy(distances.begin(), distances.end(), image->data());
    osg::ref_ptr<osg::Texture3D> texture = new osg::Texture3D(image);
    texture->setInternalFormat(GL_R8);
    texture->setResizeNonPowerOfTwoHint(false);
    texture->setUnRefImageDataAfterApply(false);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    for (auto axis : {osg::Texture::WRAP_S, osg::Texture::WRAP_T, osg::Texture::WRAP_R})
        texture->setWrap(axis, osg::Texture::CLAMP_TO_EDGE);
    texture->setDataVariance(osg::Object::STATIC);
    return texture;
}

// The part of an axis, in samples, between which something shows: empty where nothing does.
glm::dvec2 shownPart(const std::vector<core::ValueRange>& layers, bool cubic,
                     const std::function<bool(double, double)>& shows)
{
    const int gaps = std::max(static_cast<int>(layers.size()) - 1, 1), support = cubic ? 1 : 0;
    glm::dvec2 part(gaps, 0.0);
    for (int gap = 0; gap < gaps; ++gap) {
        core::ValueRange range;
        const int last = std::min(gap + 1 + support, static_cast<int>(layers.size()) - 1);
        for (int i = std::max(gap - support, 0); i <= last; ++i)
            range.expand(layers[static_cast<std::size_t>(i)]);
        if (range.empty() || !shows(range.low, range.high)) continue;
        part = {std::min(part.x, double(gap)), gap + 1.0};
    }
    return part;
}

core::Box3d shownBox(const core::LayerRanges& layers, const core::BrickPlace& place, bool cubic,
                     const std::function<bool(double, double)>& shows)
{
    core::Box3d box;
    for (int axis = 0; axis < 3; ++axis) {
        const glm::dvec2 part = shownPart(layers.axis[axis], cubic, shows);
        if (layers.axis[axis].size() == 1 && part.x < part.y) { // thicker than its samples
            box.min[axis] = place.clipBox.min[axis];
            box.max[axis] = place.clipBox.max[axis];
            continue;
        }
        box.min[axis] = place.samples.min[axis] + part.x;
        box.max[axis] = place.samples.min[axis] + part.y;
    }
    return intersection(box, place.clipBox);
}

// Cells in the box, and how many of them are occupied.
void countCells(const core::CellGrid& grid, const std::vector<std::uint8_t>& occupied,
                BrickCells& cells)
{
    const glm::dvec3 low = (cells.box.min - grid.originVoxel) / double(grid.cellSize);
    const glm::dvec3 high = (cells.box.max - grid.originVoxel) / double(grid.cellSize);
    const glm::ivec3 first = glm::max(glm::ivec3(glm::floor(low)), glm::ivec3(0));
    const glm::ivec3 end = glm::min(glm::ivec3(glm::ceil(high)), grid.count);
    for (int z = first.z; z < end.z; ++z)
        for (int y = first.y; y < end.y; ++y)
            for (int x = first.x; x < end.x; ++x) {
                ++cells.cellCount;
                cells.occupiedCount += occupied[grid.index(x, y, z)] != 0;
            }
}

// Takes away the cells of which a cut leaves nothing, and shrinks the box around those left.
void cutAway(const Voxels& voxels, const core::Cut& cut, const SampleFrame& frame,
             const core::CellGrid& grid, std::vector<std::uint8_t>& occupied, core::Box3d& box)
{
    core::Box3d left;
    glm::ivec3 i;
    for (i.z = 0; i.z < grid.count.z; ++i.z)
        for (i.y = 0; i.y < grid.count.y; ++i.y)
            for (i.x = 0; i.x < grid.count.x; ++i.x) {
                std::uint8_t& cell = occupied[grid.index(i.x, i.y, i.z)];
                if (!cell) continue;
                const glm::dvec3 corner = grid.originVoxel + double(grid.cellSize) * glm::dvec3(i);
                const core::Box3d part =
                    intersection(core::Box3d{corner, corner + double(grid.cellSize)}, box);
                if (part.empty()) continue;
                if (cut.keepsNothingOf(boxToCut(voxels, frame.toVoxels(part)))) {
                    cell = 0;
                    continue;
                }
                left.expand(part.min);
                left.expand(part.max);
            }
    box = left;
}

// Cells between the first and the last occupied one of each column: mean over the axes.
double spannedCells(const core::CellGrid& grid, const std::vector<std::uint8_t>& occupied)
{
    std::int64_t spanned = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        glm::ivec3 cell;
        for (cell[v] = 0; cell[v] < grid.count[v]; ++cell[v])
            for (cell[u] = 0; cell[u] < grid.count[u]; ++cell[u]) {
                int first = grid.count[axis], end = 0;
                for (cell[axis] = 0; cell[axis] < grid.count[axis]; ++cell[axis]) {
                    if (!occupied[grid.index(cell.x, cell.y, cell.z)]) continue;
                    first = std::min(first, cell[axis]);
                    end = cell[axis] + 1;
                }
                spanned += std::max(end - first, 0);
            }
    }
    return double(spanned) / 3.0;
}

// What is known once it is known which cells are occupied.
void setOccupied(const core::CellGrid& grid, const std::vector<std::uint8_t>& occupied,
                 BrickCells& cells)
{
    countCells(grid, occupied, cells);
    cells.origin = glm::vec3(grid.originVoxel);
    cells.cellSize = static_cast<float>(grid.cellSize);
    const glm::dvec3 box = cells.box.size();
    cells.marchedVolume = std::min(
        spannedCells(grid, occupied) * std::pow(double(grid.cellSize), 3.0), box.x * box.y * box.z);
    cells.texture = makeTexture(grid.count, occupied);
}

// Marks the cells of a whole volume that an occupied cell of a brick reaches into.
void markOccupied(const BrickCells& cells, const core::Box3d& clipBox, core::CellGrid& grid,
                  std::vector<std::uint8_t>& occupied)
{
    const osg::Image& distances = *cells.texture->getImage();
    for (int z = 0; z < distances.r(); ++z)
        for (int y = 0; y < distances.t(); ++y)
            for (int x = 0; x < distances.s(); ++x) {
                if (*distances.data(x, y, z) != 0) continue;
                const glm::dvec3 corner =
                    glm::dvec3(cells.origin) + double(cells.cellSize) * glm::dvec3(x, y, z);
                const core::Box3d cell =
                    intersection(core::Box3d{corner, corner + double(cells.cellSize)}, clipBox);
                if (cell.empty()) continue;
                const double size = grid.cellSize;
                const glm::ivec3 first(glm::floor(cell.min / size));
                const glm::ivec3 end = glm::min(
                    glm::max(glm::ivec3(glm::ceil(cell.max / size)), first + 1), grid.count);
                for (int k = first.z; k < end.z; ++k)
                    for (int j = first.y; j < end.y; ++j)
                        for (int i = first.x; i < end.x; ++i)
                            occupied[grid.index(i, j, k)] = 255;
            }
}

} // namespace

int cellSizeFor(const glm::ivec3& samples)
{
    return std::max({samples.x, samples.y, samples.z}) > 129 ? 16 : 8;
}

osg::Texture3D* occupiedEverywhere()
{
    static const osg::ref_ptr<osg::Texture3D> texture = makeTexture(glm::ivec3(1), {255});
    return texture.get();
}

bool showsValues(const Voxels& voxels, const OccupancyQuery& query, double low, double high)
{
    const double overshoot = query.cubic ? CUBIC_OVERSHOOT * (high - low) : 0.0;
    low -= overshoot;
    high += overshoot;
    if (voxels.getComponents() != 1) return high > 0.0;
    const osg::Vec2d range = voxels.getRange();
    const double a = (low - range.x()) / (range.y() - range.x());
    const double b = (high - range.x()) / (range.y() - range.x());
    if (query.isosurface) return a <= query.isoFraction && query.isoFraction <= b;
    return query.table->shows(a, b);
}

OccupancyKey occupancyKey(const Voxels& voxels, const OccupancyQuery& query)
{
    const bool byTable = voxels.getComponents() == 1 && !query.isosurface;
    return {byTable ? query.table->id : 0, query.cubic, query.isosurface,
            query.isosurface ? query.isoFraction : 0.0, query.cut ? query.cut->id : 0};
}

core::Box3d boxToCut(const Voxels& voxels, const core::Box3d& box)
{
    const osg::Vec3d o = voxels.getOrigin(), s = voxels.getSpacing();
    const glm::dvec3 origin(o.x(), o.y(), o.z()), spacing(s.x(), s.y(), s.z());
    return {origin + spacing * box.min, origin + spacing * box.max};
}

int shownComponent(const Voxels& voxels)
{
    return voxels.getComponents() == 4 ? 3 : 0;
}

std::shared_ptr<const BrickCells>
findOccupied(const Voxels& voxels, const core::BrickPlace& place, const core::CellGrid& grid,
             const core::LayerRanges& layers, const OccupancyQuery& query, const SampleFrame& frame)
{
    auto result = std::make_shared<BrickCells>();
    const auto shows = [&](double low, double high) {
        return showsValues(voxels, query, low, high);
    };
    result->box = shownBox(layers, place, query.cubic, shows);
    if (result->box.empty()) return result;
    std::vector<std::uint8_t> occupied = core::occupiedCells(grid, shows);
    if (query.cut) cutAway(voxels, *query.cut, frame, grid, occupied, result->box);
    if (result->box.empty()) return result;
    setOccupied(grid, occupied, *result);
    const auto range = std::minmax_element(grid.low.begin(), grid.low.end());
    const float highest = *std::max_element(grid.high.begin(), grid.high.end());
    result->homogeneous =
        voxels.getComponents() == 1 && *range.first == highest &&
        (!query.cut || query.cut->keepsAllOf(boxToCut(voxels, frame.toVoxels(result->box))));
    if (result->homogeneous) result->marchedVolume = 0.0;
    return result;
}

std::shared_ptr<const BrickCells>
joinCells(const Voxels& voxels,
          const std::map<std::int64_t, std::shared_ptr<const BrickCells>>& parts)
{
    core::CellGrid grid;
    const glm::ivec3 samples = voxels.getLayout().size();
    grid.cellSize = cellSizeFor(samples);
    grid.count = glm::max((samples - 2) / grid.cellSize + 1, 1);
    std::vector<std::uint8_t> occupied(static_cast<std::size_t>(core::sampleCount(grid.count)), 0);
    auto result = std::make_shared<BrickCells>();
    for (const auto& part : parts) {
        const BrickCells& cells = *part.second;
        if (!cells.texture) continue;
        markOccupied(cells, voxels.getLayout().brick(part.first).clipBox, grid, occupied);
        result->box.expand(cells.box.min);
        result->box.expand(cells.box.max);
        result->apartMarchedVolume += cells.marchedVolume;
    }
    setOccupied(grid, occupied, *result);
    return result;
}

} // namespace render
} // namespace osgVolumizer
