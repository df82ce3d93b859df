#include "CoveredPages.h"

#include "../../core/transfer/TransferFunction.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace osgVolumizer {
namespace render {

namespace {

constexpr double LIGHT_LEFT = 8e-6; // of all; rays end at 3e-5

// Of a page's edge: what is deeper covers nothing, since too little of the page would.
constexpr double DEEPEST = 0.25;

bool isOpaque(const CoveredPages::Page& page)
{
    const glm::dvec3 size = page.box.size();
    return page.opaqueDepth && *page.opaqueDepth <= DEEPEST * std::min({size.x, size.y, size.z});
}

} // namespace

OpaqueDepth::OpaqueDepth(const VolumeLook& look, const osg::Vec2d& range)
    : _function(look.table.function), _range(range), _entry(1.0 / std::max(look.table.count - 1, 1))
{
    // No vector becomes longer by more than this.
    const glm::dmat3 unitsToFrame = glm::inverse(look.frameToUnits);
    double squares = 0.0;
    for (int axis = 0; axis < 3; ++axis)
        squares += glm::dot(unitsToFrame[axis], unitsToFrame[axis]);
    _voxelsPerUnit = std::sqrt(squares);
}

double OpaqueDepth::depth(double opacity) const
{
    if (!(opacity > 0.0)) return std::numeric_limits<double>::infinity();
    return -std::log(LIGHT_LEFT) / core::extinctionFromOpacity(opacity) * _voxelsPerUnit;
}

double OpaqueDepth::of(const core::ValueRange& values) const
{
    const double width = _range.y() - _range.x();
    return depth(_function->minimumOpacity((values.low - _range.x()) / width - _entry,
                                           (values.high - _range.x()) / width + _entry));
}

double OpaqueDepth::least() const
{
    constexpr double far = std::numeric_limits<double>::max();
    return depth(_function->maximumOpacity(-far, far));
}

CoveredPages::CoveredPages(const core::BrickTree& tree, const glm::dvec4& eyeVoxel,
                           core::CoverMask mask, std::int64_t most, Describe describe)
    : _tree(tree), _eye(eyeVoxel), _mask(std::move(mask)), _left(most),
      _describe(std::move(describe))
{
}

std::unordered_set<std::int64_t> CoveredPages::find()
{
    visit(_tree.roots(_eye));
    return std::move(_covered);
}

const std::optional<CoveredPages::Page>& CoveredPages::describe(std::int64_t page)
{
    const auto known = _known.find(page);
    return known != _known.end() ? known->second
                                 : _known.emplace(page, _describe(page)).first->second;
}

void CoveredPages::visit(const std::vector<std::int64_t>& farToNear)
{
    for (auto page = farToNear.rbegin(); page != farToNear.rend(); ++page)
        visit(*page);
}

void CoveredPages::visit(std::int64_t index)
{
    if (--_left < 0) return;
    const std::optional<Page> page = describe(index);
    if (!page) return;
    if (_mask.covers(page->box)) {
        _covered.insert(index);
        return;
    }
    if (page->splits) visit(_tree.children(index, _eye));
    if (isOpaque(*page)) cover(*page);
}

// A ray that meets the box once it is made smaller has passed enough of the page; at a face beyond
// which it is opaque too, of both.
void CoveredPages::cover(const Page& page)
{
    core::Box3d box = page.box;
    const core::TreeBrick& brick = page.brick;
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
            glm::ivec3 other = brick.coordinates;
            other[axis] += side;
            const bool isCut = side < 0 ? page.box.min[axis] > brick.clipBox.min[axis]
                                        : page.box.max[axis] < brick.clipBox.max[axis];
            const bool inside = other[axis] >= 0 && other[axis] < _tree.count(brick.level)[axis];
            const std::optional<Page> neighbour =
                inside && !isCut ? describe(_tree.index(brick.level, other)) : std::nullopt;
            if (neighbour && isOpaque(*neighbour)) continue;
            (side < 0 ? box.min : box.max)[axis] -= side * *page.opaqueDepth;
        }
    _mask.add(box);
}

} // namespace render
} // namespace osgVolumizer
