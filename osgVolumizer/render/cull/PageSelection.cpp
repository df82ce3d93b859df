#include "PageSelection.h"

#include "../context/Matrices.h"
#include "../context/Statistics.h"
#include "../textures/BrickResidency.h"
#include "../volume/PixelFootprint.h"
#include "BrickSelection.h"
#include "CoveredPages.h"

#include "../../Paging.h"
#include "../../core/sampling/ViewHelpers.h"

#include <osgUtil/CullVisitor>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

namespace osgVolumizer {
namespace render {

namespace {

// Of the budget for textures, what one frame may be drawn from: two frames that differ in all are
// then there at a time, and nothing that is drawn is thrown out.
constexpr double SHARE_OF_A_FRAME = 0.4;
// Samples that are no further apart than so many pixels are fine enough.
constexpr double FINE_ENOUGH = 1.0;

} // namespace

PageSelection::PageSelection(VolumeInstance& volume, const Voxels& voxels, const TimeSteps& steps,
                             const PageView& view, bool skipping,
                             const std::shared_ptr<Pages>& pages, osgUtil::CullVisitor& visitor)
    : _volume(volume), _voxels(voxels), _tree(voxels.getTree()), _steps(steps), _skipping(skipping),
      _visitor(visitor), _query(occupancyQuery(volume, voxels)), _pages(pages), _view(view),
      _frame(frameOf(visitor)),
      _contextId(visitor.getState() ? visitor.getState()->getContextID() : 0)
{
    const glm::dmat4 projection = toGlm(*visitor.getProjectionMatrix());
    const Result<glm::dvec4> eye = core::eyePosition({view.toEye, projection});
    _eye = eye.ok() ? *eye : glm::dvec4(0.0, 0.0, 1.0, 0.0);
    if (volume.look->features.slab && volume.prepared->voxelFrame && !view.frustum) {
        _toClip = *volume.frameToEye * *visitor.getProjectionMatrix();
        _known = pages->lastTest(volume.viewId, _frame);
        // What was hidden under other planes, or another cut, need not be.
        if (_known && !_known->isCutBy(volume.look->planes, volume.look->cut.id)) _known.reset();
        _hasOpaque = pages->hadOpaque(volume.viewId);
    }
    const glm::dmat2x3 edges = pixelEdges(view.toEye, 1.0, visitor);
    _voxelsPerPixel = std::min(glm::length(edges[0]), glm::length(edges[1]));
}

void PageSelection::choose(Purpose purpose)
{
    findCovered();
    _nodes.reserve(1024);
    for (const std::int64_t root : _tree.roots(_eye))
        add(root, -1);
    _rootCount = _nodes.size();
    if (_volume.prepared->voxelFrame) refine();
    for (Node& node : _nodes)
        look(node, purpose);
    if (purpose == TO_DRAW) chooseUploads();
    passUp();
    bool anyHidden = false;
    for (const Node& node : _nodes) {
        anyHidden = anyHidden || (node.hidden && !node.covered);
        if (!node.split && !node.hidden) _missing += !node.available || node.withheld;
        _failed += node.state == Pages::FAILED;
    }
    // What was hidden from elsewhere need not be from here.
    if (anyHidden && (!_known->isExact() || differs(_known->toClip(), _toClip))) ++_missing;
}

void PageSelection::draw()
{
    _volume.steps = _steps;
    _volume.emptyBricks += _empty;
    if (_volume.look->features.slab && _volume.prepared->voxelFrame) {
        _test = std::make_shared<VisibilityTest>(_frame, _toClip, _volume.rayDistance == 1.0,
                                                 _volume.look->planes, _volume.look->cut.id);
        _pages->addTest(_volume.viewId, _test);
    }
    for (std::size_t i = 0; i < _rootCount; ++i)
        draw(i, nullptr);
    _volume.sorted = true;
}

std::int64_t PageSelection::textureBytes(const Node& node) const
{
    return core::sampleCount(node.uniform ? glm::ivec3(1) : node.brick.samples.size()) *
           texelFormat(_voxels, _volume.look->features.gradientTexture).texelBytes();
}

// What reading takes for a while: samples, and texels where those are something else.
std::int64_t PageSelection::memoryBytes(const Node& node) const
{
    const std::int64_t samples =
        core::voxelBytes(node.brick.samples.size(), _voxels.getType(), _voxels.getComponents());
    const bool same =
        texelFormat(_voxels, _volume.look->features.gradientTexture).type == _voxels.getType() &&
        !_volume.look->features.gradientTexture;
    return same ? samples : samples + textureBytes(node);
}

// Whether opaque pages hide what lies behind them, and their ranges say of all of them what they
// show: floats may be none, and then show nothing.
bool PageSelection::canCover() const
{
    const ProgramFeatures& features = _volume.look->features;
    const VoxelType type = _voxels.getType();
    const bool integers =
        type != VoxelType::HALF && type != VoxelType::FLOAT32 && type != VoxelType::FLOAT64;
    const osg::Viewport* viewport = _visitor.getViewport();
    return features.slab && _volume.prepared->voxelFrame && features.planeCount == 0 &&
           !features.cut && !features.cubic && // which overshoots its samples

           features.rayFunction == VolumeAppearance::COMPOSITE && _voxels.getComponents() == 1 &&
           integers && _volume.above.isUsual() && viewport && viewport->width() >= 1.0 &&
           viewport->height() >= 1.0;
}

void PageSelection::findCovered()
{
    if (!canCover()) return;
    const ProgramFeatures& features = _volume.look->features;
    const OpaqueDepth opaqueDepth(*_volume.look, _voxels.getRange());
    if (opaqueDepth.least() > _tree.step()) return;
    // Nor where the source knows no ranges.
    const std::vector<std::int64_t> roots = _tree.roots(_eye);
    if (std::none_of(roots.begin(), roots.end(), [this](std::int64_t root) {
            return _voxels.getPageRange(root, _steps.first).has_value();
        }))
        return;
    const glm::dmat4 toClip =
        _volume.above.toUsualClip * toGlm(*_visitor.getProjectionMatrix()) * _view.toEye;
    const osg::Viewport& viewport = *_visitor.getViewport();
    const core::CoverMask mask(toClip, {int(viewport.width()), int(viewport.height())});
    const auto describe = [&](std::int64_t index) -> std::optional<CoveredPages::Page> {
        const std::optional<Node> node = make(index);
        if (!node || node->box.empty()) return std::nullopt;
        std::optional<double> depth;
        if (!node->range.empty())
            depth = std::max(opaqueDepth.of(node->range), sampleDistance(*node));
        return CoveredPages::Page{node->brick, node->box, depth, isTooCoarse(*node)};
    };
    // As many as there is room for, and what they lie in.
    const double pageBytes = std::pow(double(_tree.step()), 3.0) *
                             double(texelFormat(_voxels, features.gradientTexture).texelBytes());
    const auto most = std::int64_t(2.0 * roomForTextures() / pageBytes) + 64;
    _covered = CoveredPages(_tree, _eye, mask, most, describe).find();
}

// None of what is outside the view. What shows nothing has an empty box.
std::optional<PageSelection::Node> PageSelection::make(std::int64_t index)
{
    Node node;
    node.index = index;
    node.brick = _tree.brick(index);
    node.box = node.brick.clipBox;
    if (_volume.section && !_volume.section->touches(node.box)) return std::nullopt;
    if (_volume.prepared->voxelFrame) {
        node.box = intersection(node.box, _volume.prepared->regionBox);
        if (node.box.empty() || isOutside(node.box) || isClipped(_volume, node.box))
            return std::nullopt;
        const double w = clipW(_view.toEye, node.box, _visitor).x;
        node.error = node.brick.spacing / (_voxelsPerPixel * w);
        if (_volume.section)
            if (const auto pixels = _volume.section->pixelsPerVoxel(node.box))
                node.error = node.brick.spacing * *pixels;
        if (!(node.error >= 0.0)) node.error = std::numeric_limits<double>::max();
    }
    if (_voxels.getComponents() == 1 && isEmpty(node)) node.box = {};
    return node;
}

bool PageSelection::isOutside(const core::Box3d& box)
{
    if (_volume.section) return false; // what it does not touch is left out
    if (!_view.frustum)
        return _visitor.isCulled(objectBounds(box, _volume.prepared->frameToObject));
    return !_view.frustum->contains(objectBounds(box, glm::dmat4(1.0)));
}

// Leaves out what shows nothing.
void PageSelection::add(std::int64_t index, std::int64_t parent)
{
    std::optional<Node> node = make(index);
    if (!node) return;
    if (node->box.empty()) {
        ++_empty;
        return;
    }
    node->parent = parent;
    if (_known) findHidden(*node);
    node->covered = _covered.count(index) > 0;
    node->hidden = node->hidden || node->covered;
    _nodes.push_back(std::move(*node));
}

// Of what lies in a page that is visible only the next finer level is asked for: it is drawn with
// what there is of it, and so it is found out which parts of it are hidden.
void PageSelection::findHidden(Node& node) const
{
    node.answer = _known->answer(node.index);
    node.hidden = node.answer == VisibilityTest::HIDDEN;
    if (node.parent < 0) return;
    const Node& parent = _nodes[static_cast<std::size_t>(node.parent)];
    node.withheld = node.answer == VisibilityTest::UNKNOWN && parent.isWithinVisible;
    node.isWithinVisible = node.answer == VisibilityTest::UNKNOWN &&
                           (parent.isWithinVisible || parent.answer == VisibilityTest::VISIBLE);
}

// Whether a page shows nothing by its range; also finds whether it is uniform. A blend of two steps
// has all values between theirs.
bool PageSelection::isEmpty(Node& node) const
{
    core::ValueRange& all = node.range;
    node.uniform = true;
    for (int i = 0; i < _steps.count(); ++i) {
        const auto range = _voxels.getPageRange(node.brick, _steps.step(i));
        if (!range) {
            node.uniform = false;
            all = {};
            return false;
        }
        all.expand({range->first, range->second});
        node.uniform = node.uniform && range->first == range->second;
        node.values[std::size_t(i)] = range->first;
    }
    return !_volume.look->features.gathers() &&
           (all.empty() || !showsValues(_voxels, _query, all.low, all.high));
}

double PageSelection::roomForTextures() const
{
    const double all = double(getPagingBudget().textureBytes) /
                       double(Pages::viewCount(_frame, *_pages, _volume.viewId));
    const auto own = double(_voxels.getTextureBudget());
    return SHARE_OF_A_FRAME * (own > 0.0 ? std::min(own, all) : all);
}

// Voxels between samples of a ray through a page, at most.
double PageSelection::sampleDistance(const Node& node) const
{
    constexpr double OBLIQUE = 2.0; // a ray's length to its depth, as far as that counts
    const glm::dvec3& period = _volume.sampling.periodVoxel;
    return OBLIQUE * std::max(_volume.look->voxelsPerSample,
                              node.brick.spacing * std::max({period.x, period.y, period.z}));
}

// Splits the page whose samples are furthest apart on the screen, as long as there is room.
void PageSelection::refine()
{
    const double room = roomForTextures();
    std::int64_t bytes = 0;
    std::priority_queue<std::pair<double, std::size_t>> worst;
    const auto consider = [&](std::size_t i) {
        const Node& node = _nodes[i];
        if (!node.hidden) bytes += _steps.count() * textureBytes(node);
        if (isTooCoarse(node) && !node.hidden && !node.withheld) worst.emplace(node.error, i);
    };
    for (std::size_t i = 0; i < _nodes.size(); ++i)
        consider(i);
    while (!worst.empty()) {
        const std::size_t parent = worst.top().second;
        worst.pop();
        const std::size_t first = _nodes.size();
        for (const std::int64_t child : _tree.children(_nodes[parent].index, _eye))
            add(child, static_cast<std::int64_t>(parent));
        std::int64_t needed = 0;
        for (std::size_t i = first; i < _nodes.size(); ++i)
            if (!_nodes[i].hidden) needed += _steps.count() * textureBytes(_nodes[i]);
        if (double(bytes + needed) > room) {
            _nodes.resize(first);
            _limited = true;
            break;
        }
        _nodes[parent].split = true;
        _nodes[parent].firstChild = first;
        _nodes[parent].childCount = _nodes.size() - first;
        for (std::size_t i = first; i < _nodes.size(); ++i)
            consider(i);
    }
}

void PageSelection::look(Node& node, Purpose purpose)
{
    const auto rank = [](Pages::State state) {
        constexpr int ranks[] = {0, 2, 3, 1}; // ABSENT, READ, RESIDENT, FAILED
        return ranks[state];
    };
    node.state = Pages::RESIDENT;
    for (int i = 0; i < _steps.count(); ++i) {
        if (node.uniform) _pages->provide(keyOf(node, i), _voxels, *node.values[std::size_t(i)]);
        Pages::Page& page = node.pages[std::size_t(i)];
        const float priority = purpose == AHEAD ? -1.0f : node.hidden ? 0.0f : node.priority();
        page = _pages->look({keyOf(node, i), _contextId, _frame, priority});
        if (rank(page.state) < rank(node.state)) node.state = page.state;
    }
    // What shows nothing need not be uploaded for that.
    node.available = node.state == Pages::RESIDENT ||
                     (node.state == Pages::READ && !node.split && isCutAway(node));
}

// What has been read goes to the context as far as this frame's time allows: the coarsest first,
// but after all others what was to go before and was not, since nothing of it was drawn after all.
// A page above others is needed only for those that are missing.
void PageSelection::chooseUploads()
{
    std::vector<Node*> read;
    for (auto node = _nodes.rbegin(); node != _nodes.rend(); ++node) { // children before parents
        if (!node->split)
            node->missing = node->state == Pages::ABSENT || node->state == Pages::FAILED;
        if (node->parent >= 0)
            _nodes[static_cast<std::size_t>(node->parent)].missing |= node->missing;
        if (node->state == Pages::READ && !node->hidden && (!node->split || node->missing))
            read.push_back(&*node);
    }
    std::reverse(read.begin(), read.end());
    const auto offers = [](const Node& node) {
        return std::max(node.pages[0].offers, node.pages[1].offers);
    };
    std::stable_sort(read.begin(), read.end(), [&offers](const Node* a, const Node* b) {
        const int offersA = offers(*a), offersB = offers(*b);
        return offersA != offersB ? offersA < offersB : a->error > b->error;
    });
    UploadAllowance& allowance = UploadAllowance::of(_contextId);
    for (Node* node : read) {
        std::int64_t bytes = 0;
        for (int i = 0; i < _steps.count(); ++i)
            if (node->pages[std::size_t(i)].state == Pages::READ) bytes += textureBytes(*node);
        if (!allowance.take(_frame, bytes)) break;
        node->available = true;
        for (int i = 0; i < _steps.count(); ++i)
            _pages->offer(keyOf(*node, i));
    }
}

// Of children to their parents.
void PageSelection::passUp()
{
    for (auto node = _nodes.rbegin(); node != _nodes.rend(); ++node) { // children before parents
        node->below = node->below || node->available;
        node->shows = node->shows || !node->split;
        if (node->parent < 0) continue;
        Node& parent = _nodes[static_cast<std::size_t>(node->parent)];
        parent.below = parent.below || node->below;
        parent.shows = parent.shows || node->shows;
    }
}

// Children are far to near.
void PageSelection::draw(std::size_t number, const Node* coarser)
{
    const Node& node = _nodes[number];
    if (!node.shows) return; // all of it turned out to be empty, or outside the view
    const Node* own = node.available ? &node : coarser;
    bool childrenCan = false;
    for (std::size_t i = 0; i < node.childCount; ++i)
        childrenCan = childrenCan || _nodes[node.firstChild + i].below;
    if (node.split && childrenCan) {
        for (std::size_t i = 0; i < node.childCount; ++i)
            draw(node.firstChild + i, own);
        return;
    }
    if (own) append(*own, node);
}

// All or a part of what a page has: where another one is.
void PageSelection::append(const Node& node, const Node& place)
{
    SelectedBrick brick;
    brick.index = node.index;
    brick.box = brick.clipBox = place.brick.clipBox;
    if (_volume.prepared->voxelFrame)
        brick.box = intersection(brick.box, _volume.prepared->regionBox);
    if (brick.box.empty()) return;
    if (node.uniform) {
        brick.textureScale = glm::vec3(0.0f);
        brick.textureOffset = glm::vec3(0.5f);
        auto cells = std::make_shared<BrickCells>();
        cells->homogeneous = true;
        brick.cells = std::move(cells);
        ++_volume.homogeneousBricks;
    } else {
        const core::TreeBrick& from = node.brick;
        const glm::dvec3 size(from.samples.size());
        brick.textureScale = glm::vec3(1.0 / (from.spacing * size));
        brick.textureOffset =
            glm::vec3((0.5 - glm::dvec3(from.samples.min) - from.offset / from.spacing) / size);
    }
    // Samples that lie further apart are asked for at as many times the period.
    const glm::dvec3& period = _volume.sampling.periodVoxel;
    const double steps = node.brick.spacing * (period.x + period.y + period.z) /
                         (3.0 * _volume.look->voxelsPerSample);
    brick.stride = static_cast<float>(std::max(std::floor(steps + 1e-6), 1.0));
    // A coarse page may show nothing where a finer one does; that would not mean that it is hidden.
    const bool final = &node == &place && isFinal(node);
    const bool uncut = _hasOpaque && !final && !node.uniform;
    if (!uncut && !cutToOccupied(node, brick)) return;
    brick.texels = drawnBrick(node, 0);
    brick.texels.test = _test;
    if (uncut || final || node.uniform) brick.texels.testedAs = place.index;
    if (_steps.blended) {
        brick.nextTexels = drawnBrick(node, 1);
        brick.stepFraction = _steps.fraction;
    }
    _volume.bricks.push_back(std::move(brick));
}

DrawnBrick PageSelection::drawnBrick(const Node& node, int step) const
{
    DrawnBrick brick;
    brick.texture = node.pages[std::size_t(step)].texture;
    brick.voxels = &_voxels;
    brick.index = node.index;
    brick.gradients = _volume.look->features.gradientTexture;
    brick.paged = true;
    brick.texels = node.pages[std::size_t(step)].texels;
    return brick;
}

std::vector<DrawnBrick> PageSelection::uploads() const
{
    std::vector<DrawnBrick> uploads;
    for (const Node& node : _nodes)
        for (int i = 0; node.available && i < _steps.count(); ++i)
            if (node.pages[std::size_t(i)].state == Pages::READ)
                uploads.push_back(drawnBrick(node, i));
    return uploads;
}

// Whether finer pages would show more.
bool PageSelection::isTooCoarse(const Node& node)
{
    return !isFinal(node) && !node.uniform;
}

// Whether a page is drawn by itself, as good as it will be.
bool PageSelection::isFinal(const Node& node)
{
    return node.brick.level == 0 || node.error <= FINE_ENOUGH;
}

// Where a page shows something; null where that is not known.
std::shared_ptr<const BrickCells> PageSelection::cellsOf(const Node& node) const
{
    const ProgramFeatures& features = _volume.look->features;
    // What a blend of two steps shows is more than what either does.
    const bool known = !_steps.blended && node.pages[0].cells;
    if (node.uniform || !known || !_skipping || !_volume.prepared->voxelFrame || features.cubic ||
        features.gathers())
        return nullptr;
    return node.pages[0].cells->get(_voxels, _query);
}

// Whether nothing of a page is drawn.
bool PageSelection::isCutAway(const Node& node) const
{
    const ProgramFeatures& features = _volume.look->features;
    if ((_hasOpaque && !isFinal(node)) || !(features.slab || !features.preIntegrated)) return false;
    const std::shared_ptr<const BrickCells> cells = cellsOf(node);
    return cells && intersection(node.box, cells->box).empty();
}

// Cuts a brick down to where it shows something; false where that is nowhere.
bool PageSelection::cutToOccupied(const Node& node, SelectedBrick& brick)
{
    const ProgramFeatures& features = _volume.look->features;
    brick.cells = cellsOf(node);
    if (!brick.cells) return true;
    _volume.cellSize = std::min<double>(_volume.cellSize, brick.cells->cellSize);
    _volume.cellCount += brick.cells->cellCount;
    _volume.occupiedCells += brick.cells->occupiedCount;
    if (features.slab || !features.preIntegrated)
        brick.box = intersection(brick.box, brick.cells->box);
    if (brick.box.empty()) {
        ++_volume.emptyBricks;
        return false;
    }
    _volume.homogeneousBricks += brick.cells->homogeneous;
    return true;
}

// The coarser is the more urgent, since its samples are further apart on the screen.
void PageSelection::appendRequests(int lowered, std::vector<PageRequest>& requests) const
{
    for (const Node& node : _nodes)
        for (int i = 0; i < _steps.count(); ++i) {
            const Pages::State state = node.pages[std::size_t(i)].state;
            if (state != Pages::ABSENT && state != Pages::FAILED) continue;
            if (node.hidden || node.withheld) continue;
            const float own = node.priority();
            const float priority = lowered == 0 ? own : own / (1.0f + own) - float(lowered) - 1.0f;
            requests.push_back({keyOf(node, i), priority, memoryBytes(node)});
        }
}

std::int64_t PageSelection::memoryBytes() const
{
    std::int64_t bytes = 0;
    for (const Node& node : _nodes)
        bytes += _steps.count() * memoryBytes(node);
    return bytes;
}

void PageSelection::report(std::int64_t missing, std::int64_t waiting, std::int64_t ahead) const
{
    if (!collectingStats(_visitor.getCurrentCamera())) return;
    const std::pair<const char*, std::int64_t> values[] = {
        {"osgVolumizer pages wanted", static_cast<std::int64_t>(_nodes.size())},
        {"osgVolumizer pages missing", missing},
        {"osgVolumizer pages waited for", waiting},
        {"osgVolumizer pages ahead", ahead},
        {"osgVolumizer pages failed", _failed},
        {"osgVolumizer pages hidden",
         std::count_if(_nodes.begin(), _nodes.end(), [](const Node& n) { return n.hidden; })},
        {"osgVolumizer pages limited by the budget", _limited ? 1 : 0},
        {"osgVolumizer bytes of pages", PageQueue::instance().heldBytes()},
        {"osgVolumizer bytes of page textures", Pages::textureBytes(_contextId)}};
    for (const auto& value : values)
        count(_visitor.getCurrentCamera(), _visitor.getFrameStamp(), value.first,
              static_cast<double>(value.second));
}

} // namespace render
} // namespace osgVolumizer
