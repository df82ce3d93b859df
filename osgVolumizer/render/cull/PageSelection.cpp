#include "PageSelection.h"

#include "../context/Matrices.h"
#include "../context/Statistics.h"
#include "../textures/BrickResidency.h"
#include "../volume/PixelFootprint.h"
#include "BrickSelection.h"

#include "../../Paging.h"
#include "../../core/sampling/ViewHelpers.h"
#include "../../core/voxels/VoxelData.h"

#include <osgUtil/CullVisitor>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>

namespace osgVolumizer {
namespace render {

namespace {

// Of the budget for textures, what one frame may be drawn from: two frames that differ in all are
// then there at a time, and nothing that is drawn is thrown out.
constexpr double SHARE_OF_A_FRAME = 0.4;
// Samples that are no further apart than so many pixels are fine enough.
constexpr double FINE_ENOUGH = 1.0;

class PageSelection
{
public:
    PageSelection(VolumeInstance& volume, const Voxels& voxels, bool skipping,
                  osgUtil::CullVisitor& visitor)
        : _volume(volume), _voxels(voxels), _tree(voxels.getTree()), _skipping(skipping),
          _visitor(visitor), _query(occupancyQuery(volume, voxels)),
          _pages(BrickResidency::of(voxels)->pages(voxels)), _toEye(toGlm(*volume.frameToEye)),
          _frame(frameOf(visitor)),
          _contextId(visitor.getState() ? visitor.getState()->getContextID() : 0)
    {
        const core::View view{_toEye, toGlm(*visitor.getProjectionMatrix())};
        const Result<glm::dvec4> eye = core::eyePosition(view);
        _eye = eye.ok() ? *eye : glm::dvec4(0.0, 0.0, 1.0, 0.0);
        const glm::dmat2x3 edges = pixelEdges(_toEye, 1.0, visitor);
        _voxelsPerPixel = std::min(glm::length(edges[0]), glm::length(edges[1]));
    }

    void run()
    {
        for (const std::int64_t root : _tree.roots(_eye))
            add(root, -1);
        _rootCount = _nodes.size();
        if (_volume.prepared->voxelFrame) refine();
        for (Node& node : _nodes)
            look(node);
        chooseUploads();
        for (std::size_t i = 0; i < _rootCount; ++i)
            draw(i, nullptr);
        _volume.sorted = true;
        ask();
        report();
    }

private:
    /// A page that may be drawn. The nodes of a parent's children follow each other.
    struct Node
    {
        std::int64_t index = 0;
        core::TreeBrick brick;
        core::Box3d box;               ///< voxel frame; of its clip box, what is in the region
        std::optional<double> uniform; ///< the one value of all that it stands for
        double error = 0.0;            ///< pixels between its samples, where it is nearest
        std::int64_t parent = -1;
        std::size_t firstChild = 0, childCount = 0;
        bool split = false; ///< its children are to be drawn instead
        Pages::Page page;
        bool available = false; ///< it can be drawn in this frame
        bool below = false;     ///< it can, or something below it
        bool shows = false;     ///< it, or something below it, is to be drawn
    };

    PageKeeper::Key keyOf(const Node& node) const
    {
        return {node.index, _volume.look->features.gradientTexture};
    }
    std::int64_t textureBytes(const Node& node) const
    {
        return core::sampleCount(node.uniform ? glm::ivec3(1) : node.brick.samples.size()) *
               texelFormat(_voxels, _volume.look->features.gradientTexture).texelBytes();
    }
    // What reading takes for a while: samples, and texels where those are something else.
    std::int64_t memoryBytes(const Node& node) const
    {
        const std::int64_t samples =
            core::voxelBytes(node.brick.samples.size(), _voxels.getType(), _voxels.getComponents());
        const bool same = texelFormat(_voxels, _volume.look->features.gradientTexture).type ==
                              _voxels.getType() &&
                          !_volume.look->features.gradientTexture;
        return same ? samples : samples + textureBytes(node);
    }

    void add(std::int64_t index, std::int64_t parent);
    void refine();
    void look(Node& node);
    void chooseUploads();
    bool isMissingBelow(const Node& node) const;
    void draw(std::size_t number, const Node* coarser);
    void append(const Node& node, const core::Box3d& clipBox);
    bool cutToOccupied(const Node& node, SelectedBrick& brick);
    void ask();
    void report() const;

    VolumeInstance& _volume;
    const Voxels& _voxels;
    const core::BrickTree& _tree;
    const bool _skipping;
    osgUtil::CullVisitor& _visitor;
    const OccupancyQuery _query;
    const std::shared_ptr<Pages> _pages;
    const glm::dmat4 _toEye;
    const unsigned _frame, _contextId;
    glm::dvec4 _eye;
    double _voxelsPerPixel = 0.0; ///< where clip w is 1
    std::vector<Node> _nodes;     ///< parents before children
    std::size_t _rootCount = 0;
    std::int64_t _missing = 0, _waiting = 0, _failed = 0;
    bool _limited = false; ///< by the budget
};

// Leaves out what shows nothing.
void PageSelection::add(std::int64_t index, std::int64_t parent)
{
    Node node;
    node.index = index;
    node.parent = parent;
    node.brick = _tree.brick(index);
    node.box = node.brick.clipBox;
    const PreparedGeometry& prepared = *_volume.prepared;
    if (prepared.voxelFrame) {
        node.box = intersection(node.box, prepared.regionBox);
        if (node.box.empty()) return;
        if (_visitor.isCulled(objectBounds(node.box, prepared.frameToObject))) return;
        const double w = clipW(_toEye, node.box, _visitor).x;
        node.error = node.brick.spacing / (_voxelsPerPixel * w);
        if (!(node.error >= 0.0)) node.error = std::numeric_limits<double>::max();
    }
    if (_voxels.getComponents() == 1) {
        const auto range = _voxels.getPageRange(index);
        if (range && !_volume.look->features.gathers() &&
            (!(range->first <= range->second) ||
             !showsValues(_voxels, _query, range->first, range->second))) {
            ++_volume.emptyBricks;
            return;
        }
        if (range && range->first == range->second) node.uniform = range->first;
    }
    _nodes.push_back(std::move(node));
}

// Splits the page whose samples are furthest apart on the screen, as long as there is room.
void PageSelection::refine()
{
    const double room = SHARE_OF_A_FRAME * double(getPagingBudget().textureBytes) /
                        double(Pages::viewCount(_frame, *_pages, _volume.viewId));
    std::int64_t bytes = 0;
    std::priority_queue<std::pair<double, std::size_t>> worst;
    const auto consider = [&](std::size_t i) {
        const Node& node = _nodes[i];
        bytes += textureBytes(node);
        if (node.brick.level > 0 && node.error > FINE_ENOUGH && !node.uniform)
            worst.emplace(node.error, i);
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
            needed += textureBytes(_nodes[i]);
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

void PageSelection::look(Node& node)
{
    const auto priority = static_cast<float>(std::min(node.error, 1e30));
    if (node.uniform) _pages->provide(keyOf(node), _voxels, *node.uniform);
    node.page = _pages->look({keyOf(node), _contextId, _frame, priority});
    node.available = node.page.state == Pages::RESIDENT;
}

bool PageSelection::isMissingBelow(const Node& node) const
{
    if (!node.split) return node.page.state == Pages::ABSENT || node.page.state == Pages::FAILED;
    for (std::size_t i = 0; i < node.childCount; ++i)
        if (isMissingBelow(_nodes[node.firstChild + i])) return true;
    return false;
}

// What has been read goes to the context as far as this frame's time allows: the coarsest first,
// but after all others what was to go before and was not, since nothing of it was drawn after all.
// A page above others is needed only for those that are missing.
void PageSelection::chooseUploads()
{
    std::vector<Node*> read;
    for (Node& node : _nodes)
        if (node.page.state == Pages::READ && (!node.split || isMissingBelow(node)))
            read.push_back(&node);
    std::stable_sort(read.begin(), read.end(), [](const Node* a, const Node* b) {
        return a->page.offers != b->page.offers ? a->page.offers < b->page.offers
                                                : a->error > b->error;
    });
    UploadAllowance& allowance = UploadAllowance::of(_contextId);
    for (Node* node : read) {
        if (!allowance.take(_frame, textureBytes(*node))) break;
        node->available = true;
        _pages->offer(keyOf(*node));
    }
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
    if (!node.split) {
        _missing += !node.available;
    } else if (childrenCan) {
        for (std::size_t i = 0; i < node.childCount; ++i)
            draw(node.firstChild + i, own);
        return;
    } else {
        ++_missing;
    }
    if (own) append(*own, node.brick.clipBox);
}

void PageSelection::append(const Node& node, const core::Box3d& clipBox)
{
    SelectedBrick brick;
    brick.index = node.index;
    brick.box = brick.clipBox = clipBox;
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
        const core::TreeBrick& place = node.brick;
        const glm::dvec3 size(place.samples.size());
        brick.textureScale = glm::vec3(1.0 / (place.spacing * size));
        brick.textureOffset =
            glm::vec3((0.5 - glm::dvec3(place.samples.min) - place.offset / place.spacing) / size);
    }
    // Samples that lie further apart are asked for at as many times the period.
    const glm::dvec3& period = _volume.sampling.periodVoxel;
    const double steps = node.brick.spacing * (period.x + period.y + period.z) /
                         (3.0 * _volume.look->voxelsPerSample);
    brick.stride = static_cast<float>(std::max(std::floor(steps + 1e-6), 1.0));
    if (!cutToOccupied(node, brick)) return;
    brick.texels.texture = node.page.texture;
    brick.texels.voxels = &_voxels;
    brick.texels.index = node.index;
    brick.texels.gradients = _volume.look->features.gradientTexture;
    brick.texels.paged = true;
    brick.texels.texels = node.page.texels;
    _volume.bricks.push_back(std::move(brick));
}

// Cuts a brick down to where it shows something; false where that is nowhere.
bool PageSelection::cutToOccupied(const Node& node, SelectedBrick& brick)
{
    const ProgramFeatures& features = _volume.look->features;
    if (node.uniform || !node.page.cells || !_skipping || !_volume.prepared->voxelFrame ||
        features.cubic || features.gathers())
        return true;
    brick.cells = node.page.cells->get(_voxels, _query);
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
void PageSelection::ask()
{
    std::vector<PageRequest> requests;
    for (const Node& node : _nodes) {
        _failed += node.page.state == Pages::FAILED;
        if (node.page.state != Pages::ABSENT && node.page.state != Pages::FAILED) continue;
        requests.push_back(
            {keyOf(node), static_cast<float>(std::min(node.error, 1e30)), memoryBytes(node)});
    }
    _waiting = _pages->ask(_volume.viewId, std::move(requests));
}

void PageSelection::report() const
{
    if (!collectingStats(_visitor.getCurrentCamera())) return;
    const std::pair<const char*, std::int64_t> values[] = {
        {"osgVolumizer pages wanted", static_cast<std::int64_t>(_nodes.size())},
        {"osgVolumizer pages missing", _missing},
        {"osgVolumizer pages waited for", _waiting},
        {"osgVolumizer pages failed", _failed},
        {"osgVolumizer pages limited by the budget", _limited ? 1 : 0},
        {"osgVolumizer bytes of pages", PageQueue::instance().heldBytes()},
        {"osgVolumizer bytes of page textures", Pages::textureBytes(_contextId)}};
    for (const auto& value : values)
        count(_visitor.getCurrentCamera(), _visitor.getFrameStamp(), value.first,
              static_cast<double>(value.second));
}

} // namespace

void selectPages(VolumeInstance& volume, const Voxels& voxels, const ViewHooks& hooks,
                 osgUtil::CullVisitor& visitor)
{
    if (!visitor.getProjectionMatrix()) return;
    PageSelection(volume, voxels, hooks.skipping, visitor).run();
}

} // namespace render
} // namespace osgVolumizer
