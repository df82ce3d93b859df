#include "GroupComposer.h"

#include "../../Error.h"
#include "../context/ContextRefusals.h"
#include "../context/LeafState.h"
#include "../context/Matrices.h"
#include "../draw/VolumeProgram.h"
#include "../volume/SlabMesh.h"
#include "../volume/SlicedVolume.h"
#include "ScreenAreas.h"

#include <osgUtil/StateGraph>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace render {

namespace {

// More rectangles would cost more than they save.
constexpr std::size_t MAXIMUM_REGIONS = 8;
// When to sort fragments, and what a drawable that is no mesh counts for.
constexpr std::size_t MAXIMUM_SORTED_TRIANGLES = 20000, UNKNOWN_TRIANGLES = 1000;
constexpr double INFINITE_DEPTH = std::numeric_limits<double>::infinity();

double middle(const core::DepthInterval& d)
{
    return 0.5 * (d.nearDepth + d.farDepth);
}

// Any order that does not depend on the order of nodes.
bool comesFirst(const VolumeInstance* a, const VolumeInstance* b)
{
    if (a->depth.farDepth != b->depth.farDepth) return a->depth.farDepth > b->depth.farDepth;
    if (a->depth.nearDepth != b->depth.nearDepth) return a->depth.nearDepth > b->depth.nearDepth;
    const osg::Matrixd &m = *a->frameToEye, &n = *b->frameToEye;
    return std::lexicographical_compare(m.ptr(), m.ptr() + 16, n.ptr(), n.ptr() + 16);
}

} // namespace

bool GroupComposer::prepare(VolumeInstance& instance, PreparedVolume& volume)
{
    volume.instance = &instance;
    volume.view = {toGlm(*instance.leaf->_modelview), toGlm(usualProjection(*instance.leaf))};
    if (instance.look->features.slab) return true;
    const bool mergeable = _group.volumes.size() > 1 || !_group.surfaces.empty();
    volume.sliced = std::make_unique<SlicedVolume>();
    const Status status = volume.sliced->polygonize(instance, volume.view, mergeable);
    if (volume.sliced->polygonized()) ++_counts.polygonizations;
    if (!status) reportError(status);
    return status.ok();
}

void GroupComposer::prepareVolumes()
{
    std::vector<VolumeInstance*> instances = _group.volumes;
    std::sort(instances.begin(), instances.end(), comesFirst);
    _step = INFINITE_DEPTH;
    for (VolumeInstance* instance : instances) {
        PreparedVolume volume;
        if (!prepare(*instance, volume)) continue;
        _step = std::min(_step, volume.sliced ? volume.sliced->spacing() : instance->look->step);
        _volumes.push_back(std::move(volume));
    }
}

VolumeOutline GroupComposer::outlineOf(const VolumeInstance& volume) const
{
    VolumeOutline outline;
    outline.depth = volume.depth;
    // Faces of slabs are a little larger than their box.
    outline.margin = {4.0 / std::max(_viewport[2], 1), 4.0 / std::max(_viewport[3], 1)};
    const glm::dmat4 toClip =
        toGlm(usualProjection(*volume.leaf)) * toGlm(*volume.leaf->_modelview);
    for (int i = 0; i < 8; ++i) {
        const glm::dvec4 clip = toClip * glm::dvec4(volume.prepared->regionBox.corner(i), 1.0);
        outline.everywhere = outline.everywhere || !(clip.w > 0.0);
        outline.corners[i] = glm::dvec2(clip) / clip.w;
    }
    return outline;
}

// Surfaces that, looked at closely, reach into no volume stay the leaves they are.
void GroupComposer::prepareSurfaces(std::vector<OrderedLeaf>& leaves)
{
    std::vector<VolumeOutline> outlines;
    if (!_group.surfaces.empty())
        for (const PreparedVolume& volume : _volumes)
            outlines.push_back(outlineOf(*volume.instance));
    for (const ForeignLeaf* leaf : _group.surfaces) {
        Surface surface;
        surface.leaf = leaf;
        surface.mesh = SurfaceMesh::of(*leaf);
        surface.view = surface.mesh ? surface.mesh->view() : leaf->view();
        const bool reaches =
            std::any_of(outlines.begin(), outlines.end(), [&](const VolumeOutline& outline) {
                return surface.mesh ? surface.mesh->touches(outline)
                                    : outline.depth.overlaps(surface.view.depth);
            });
        if (reaches)
            _surfaces.push_back(std::move(surface));
        else
            leaves.push_back({leaf->leaf()._depth, &leaf->leaf()});
    }
}

std::vector<GroupComposer::Region> GroupComposer::findRegions() const
{
    std::vector<ScreenArea> areas;
    for (std::size_t s = 0; s < _surfaces.size(); ++s) {
        // What is no mesh of triangles may be wider than its bounds: points, lines, text.
        const int margin = _surfaces[s].mesh ? 2 : 16;
        areas.push_back({pixelRectangle(_surfaces[s].view.screen, _viewport, margin), {s}});
    }
    areas = joinOverlapping(std::move(areas), MAXIMUM_REGIONS);
    std::vector<Region> regions;
    std::vector<glm::ivec4> rest = {_viewport};
    for (const ScreenArea& area : areas) {
        regions.push_back({{area.rectangle}, area.members});
        rest = subtract(rest, area.rectangle);
    }
    if (!rest.empty()) regions.push_back({rest, {}});
    return regions;
}

void GroupComposer::makeLooks(PreparedVolume& volume, const Region& region)
{
    auto look = std::make_shared<VolumeLook>(*volume.instance->look);
    look->scissors = region.rectangles;
    if (volume.sliced) {
        look->step = volume.sliced->spacing();
        look->surfaceNormal = volume.sliced->surfaceNormal();
        look->features.spherical = volume.sliced->spherical();
    } else if (!alone()) {
        look->step =
            _step; // the same samples in every region, and one for each volume in a thin slab
    }
    volume.looks[WHOLE] = look;
    for (const Part part : {BEHIND_LAYER, IN_FRONT_OF_LAYER}) {
        auto split = std::make_shared<VolumeLook>(*look);
        split->features.layerDepth = true;
        split->inFrontOfLayer = part == IN_FRONT_OF_LAYER;
        volume.looks[part] = split;
    }
}

std::vector<core::ScheduledInterval> GroupComposer::schedule(const Region& region) const
{
    std::vector<core::ScheduleMember> members;
    core::ScheduleLimits limits;
    for (const PreparedVolume& volume : _volumes) {
        members.push_back({volume.instance->depth, true, _step});
        // A slice has no inside that a layer could split.
        if (volume.sliced) limits.surfaceSteps = 1.0;
    }
    for (std::size_t s : region.surfaces) {
        members.push_back({_surfaces[s].view.depth, false, 0.0});
        // What leaves no depth cannot split a segment either.
        if (!leavesDepth(_surfaces[s])) limits.surfaceSteps = 1.0;
    }
    return core::depthSchedule(members, limits);
}

// The part of each surface in each interval. Members of the schedule are the volumes, then the
// region's surfaces.
void GroupComposer::splitSurfaces(const Region& region,
                                  const std::vector<core::ScheduledInterval>& intervals)
{
    std::vector<core::DepthInterval> depths;
    depths.reserve(intervals.size());
    for (const core::ScheduledInterval& interval : intervals)
        depths.push_back(interval.depth);
    for (std::size_t i = 0; i < region.surfaces.size(); ++i) {
        Surface& surface = _surfaces[region.surfaces[i]];
        const int member = static_cast<int>(_volumes.size() + i);
        surface.ends = {INFINITE_DEPTH, -INFINITE_DEPTH};
        for (const core::ScheduledInterval& interval : intervals) {
            const auto& in = interval.surfaces;
            if (std::find(in.begin(), in.end(), member) == in.end()) continue;
            surface.ends.nearDepth = std::min(surface.ends.nearDepth, interval.depth.nearDepth);
            surface.ends.farDepth = std::max(surface.ends.farDepth, interval.depth.farDepth);
        }
        if (surface.mesh) surface.splits = surface.mesh->split(depths);
    }
}

void GroupComposer::compose(std::vector<OrderedLeaf>& leaves)
{
    prepareVolumes();
    prepareSurfaces(leaves);
    if (_volumes.empty()) return;
    if (_surfaces.empty()) {
        composeRegion({}, leaves);
        return;
    }
    for (const Region& region : findRegions())
        composeRegion(region, leaves);
}

// Other drawables may set the depth mask themselves, as particle systems do.
bool GroupComposer::leavesDepth(const Surface& surface)
{
    return keepsState(*surface.leaf->leaf().getDrawable());
}

namespace {

// Colour and depth of a fragment together, with the graph's state: not text, which writes depth in
// a pass of its own, nor what others may do.
bool drawsAtOnce(const osg::Drawable& drawable)
{
    const std::string library = drawable.libraryName();
    return drawable.asGeometry() && !drawable.getDrawCallback() &&
           (library == "osg" || library == "osgAnimation");
}

} // namespace

bool GroupComposer::canBeCaptured(const Region& region) const
{
    if (region.surfaces.empty() || _volumes.size() != 1) return false;
    if (isRefused(_contextId, Refusal::CAPTURED_SURFACES)) return false;
    const PreparedVolume& volume = _volumes.front();
    if (volume.sliced || volume.instance->bricks.size() != 1) return false;
    if (!volume.instance->look->above.isUsual()) return false;
    const Blending blending = blendingOf(_surfaces[region.surfaces.front()].leaf->leaf()._parent);
    if (!blending.over) return false;
    return std::all_of(region.surfaces.begin(), region.surfaces.end(), [&](std::size_t s) {
        const osgUtil::StateGraph* graph = _surfaces[s].leaf->leaf()._parent;
        return drawsAtOnce(*_surfaces[s].leaf->leaf().getDrawable()) && hasUsualDepthTest(graph) &&
               blendingOf(graph) == blending;
    });
}

// Large meshes by themselves, with as many slots as they seem to have layers, and one more where
// there is room; all others together, with as many as they could need. Empty where the slots do not
// suffice.
std::vector<GroupComposer::CaptureSet> GroupComposer::findCaptureSets(const Region& region) const
{
    constexpr std::size_t LARGE_MESH = 2000;
    constexpr int COMMON_SLOTS = 8, UNKNOWN_LAYERS = 4;
    // An estimate may be a little above a whole number of layers.
    constexpr double ESTIMATE_TOLERANCE = 0.9;
    const int affordable =
        affordableSlots(_viewport[0] + _viewport[2], _viewport[1] + _viewport[3]);
    CaptureSet common;
    std::vector<CaptureSet> sets;
    int total = 0, commonLayers = 0;
    for (std::size_t s : region.surfaces) {
        const SurfaceMesh* mesh = _surfaces[s].mesh.get();
        const double layers = mesh ? mesh->layerEstimate() * ESTIMATE_TOLERANCE : UNKNOWN_LAYERS;
        const int slots = static_cast<int>(std::ceil(std::clamp(layers, 1.0, 1000.0)));
        if (mesh && mesh->triangleCount() >= LARGE_MESH) {
            sets.push_back({{s}, 0, slots});
            total += slots;
        } else {
            common.surfaces.push_back(s);
            const std::size_t most = mesh ? mesh->triangleCount() : UNKNOWN_LAYERS;
            commonLayers += static_cast<int>(std::min(most, std::size_t(slots) + 1));
        }
    }
    common.slotCount = std::min(commonLayers, COMMON_SLOTS);
    int spare = affordable - total - common.slotCount, next = 0;
    if (spare < 0) return {};
    if (spare >= static_cast<int>(sets.size())) {
        for (CaptureSet& set : sets)
            ++set.slotCount;
        spare -= static_cast<int>(sets.size());
    }
    common.slotCount = std::min(commonLayers, common.slotCount + spare);
    if (common.slotCount > 0) sets.insert(sets.begin(), common);
    for (CaptureSet& set : sets) {
        set.firstSlot = next;
        next += set.slotCount;
    }
    // Whole fours are sorted, so all of them have to be drawn, or at least cleared.
    sets.back().slotCount += (next + 3) / 4 * 4 - next;
    return sets;
}

void GroupComposer::composeCaptured(const Region& region, const std::vector<CaptureSet>& sets,
                                    std::vector<OrderedLeaf>& leaves)
{
    using Step = CaptureLeaf::Step;
    PreparedVolume& volume = _volumes.front();
    const VolumeInstance& instance = *volume.instance;
    const double depth = instance.look->referenceDepth;
    CaptureLeaf::Settings settings;
    settings.area = areaOf(region);
    settings.slotCount = sets.back().firstSlot + sets.back().slotCount;
    _accumulation.requireTarget();
    for (const CaptureSet& set : sets) {
        for (int k = 0; k < set.slotCount; ++k) {
            settings.slot = set.firstSlot + k;
            // Waiting for what the last pass drew costs; passes that are likely needed do not.
            settings.conditional = k > 1;
            settings.step = Step::BEGIN_SLOT;
            addCaptureStep(settings, depth, leaves);
            addCopies(set.surfaces, *captureState(k), depth, leaves);
            settings.step = Step::END_SLOT;
            addCaptureStep(settings, depth, leaves);
        }
    }
    settings.step = Step::SORT;
    addCaptureStep(settings, depth, leaves);

    auto look = std::make_shared<VolumeLook>(*volume.looks[WHOLE]);
    look->features.slotCount = settings.slotCount;
    const Blending blending = blendingOf(_surfaces[region.surfaces.front()].leaf->leaf()._parent);
    look->surfaceWeights = {blending.colorWeighted ? 1.0f : 0.0f,
                            blending.alphaWeighted ? 1.0f : 0.0f};
    addVolume(volume, screenMesh(instance), look, depth, leaves);

    for (const CaptureSet& set : sets) {
        settings.slot = set.firstSlot + set.slotCount - 1;
        settings.step = Step::BEGIN_REST;
        addCaptureStep(settings, depth, leaves);
        addCopies(set.surfaces, *captureRestState(set.slotCount), depth, leaves);
        settings.step = Step::END_REST;
        addCaptureStep(settings, depth, leaves);
    }
    const bool oneDepth =
        std::all_of(region.surfaces.begin(), region.surfaces.end(), [this](std::size_t s) {
            const osgUtil::StateGraph* graph = _surfaces[s].leaf->leaf()._parent;
            return writesDepth(graph) && hasUsualDepthRange(graph);
        });
    settings.step = Step::WRITE_DEPTH;
    if (oneDepth)
        addCaptureStep(settings, depth, leaves);
    else
        addSurfaces(RankLeaf::DEPTH, 0, region, depth, leaves);
}

void GroupComposer::addCaptureStep(const CaptureLeaf::Settings& settings, double depth,
                                   std::vector<OrderedLeaf>& leaves)
{
    const osgUtil::RenderLeaf& beside = *_volumes.front().instance->leaf;
    osg::ref_ptr<osgUtil::RenderLeaf> leaf =
        new osgUtil::RenderLeaf(new CaptureLeaf(&_accumulation, settings), beside._projection,
                                beside._modelview, static_cast<float>(depth));
    beside._parent->_parent->find_or_insert(CaptureLeaf::stateSet(settings))->addLeaf(leaf);
    leaves.push_back({depth, leaf.get()});
}

void GroupComposer::addCopies(const std::vector<std::size_t>& surfaces, osg::StateSet& state,
                              double depth, std::vector<OrderedLeaf>& leaves)
{
    for (std::size_t s : surfaces) {
        leaves.push_back({depth, _surfaces[s].leaf->copy(state)});
        ++_counts.surfacePieces;
    }
}

// Sorting draws every surface twice per layer; worth it until triangles cost more than intervals
// do.
bool GroupComposer::isWorthSorting(const Region& region) const
{
    if (region.surfaces.empty()) return false;
    if (isRefused(_contextId, Refusal::RANKED_SURFACES)) return false;
    for (const PreparedVolume& volume : _volumes)
        if (volume.sliced) return false;
    std::size_t triangles = 0;
    for (std::size_t s : region.surfaces) {
        if (!leavesDepth(_surfaces[s])) return false;
        // Fragments are counted by stencil values.
        const osgUtil::StateGraph* graph = _surfaces[s].leaf->leaf()._parent;
        if (isOn(graph, GL_STENCIL_TEST, false) || !hasUsualDepthTest(graph)) return false;
        // The target is of floats, which logic operations leave alone.
        if (isOn(graph, GL_COLOR_LOGIC_OP, false)) return false;
        triangles += _surfaces[s].mesh ? _surfaces[s].mesh->triangleCount() : UNKNOWN_TRIANGLES;
    }
    return triangles <= MAXIMUM_SORTED_TRIANGLES;
}

void GroupComposer::composeSorted(const Region& region, std::vector<OrderedLeaf>& leaves)
{
    using Step = RankLeaf::Step;
    const double depth = _volumes.front().instance->look->referenceDepth;
    const std::vector<core::ScheduledInterval> intervals = schedule({region.rectangles, {}});
    _accumulation.requireTarget();
    for (int k = 0; k < RankLeaf::LAYER_COUNT; ++k) {
        addLayerStep(Step::BEGIN_CAPTURE, k, region, depth, leaves);
        addSurfaces(Step::BEGIN_CAPTURE, k, region, depth, leaves);
        addLayerStep(Step::END_CAPTURE, k, region, depth, leaves);
    }
    addLayerStep(Step::SORT, 0, region, depth, leaves);
    std::vector<OrderedLeaf> segments;
    for (int rank = 0; rank <= RankLeaf::LAYER_COUNT; ++rank) {
        for (PreparedVolume& volume : _volumes) {
            auto look = std::make_shared<VolumeLook>(*volume.looks[WHOLE]);
            look->features.ranked = true;
            look->rank = rank;
            volume.looks[WHOLE] = look;
        }
        addLayerStep(Step::BEGIN_SEGMENT, rank, region, depth, leaves);
        segments.clear();
        composeVolumes(intervals, segments);
        for (const OrderedLeaf& segment : segments)
            leaves.push_back({depth, segment.leaf});
        addLayerStep(Step::END_SEGMENT, rank, region, depth, leaves);
        const bool rest = rank == RankLeaf::LAYER_COUNT;
        const int query = rest ? rank - 1 : rank;
        const Step begin = rest ? Step::BEGIN_REST : Step::BEGIN_RANK;
        addLayerStep(begin, query, region, depth, leaves);
        addSurfaces(begin, rank, region, depth, leaves);
        addLayerStep(rest ? Step::END_REST : Step::END_RANK, query, region, depth, leaves);
    }
    addSurfaces(Step::DEPTH, 0, region, depth, leaves);
}

// Intervals without surfaces: slabs, alternating who goes first.
void GroupComposer::composeVolumes(const std::vector<core::ScheduledInterval>& intervals,
                                   std::vector<OrderedLeaf>& leaves)
{
    bool reversed = false;
    for (const core::ScheduledInterval& interval : intervals) {
        addPending(interval, reversed, leaves);
        reversed = !reversed;
    }
    flush(leaves);
}

void GroupComposer::addPending(const core::ScheduledInterval& interval, bool reversed,
                               std::vector<OrderedLeaf>& leaves)
{
    std::vector<int> order = interval.volumes;
    if (reversed) std::reverse(order.begin(), order.end());
    for (int v : order) {
        if (_pendingVolume != v) flush(leaves);
        _pendingVolume = v;
        _volumes[static_cast<std::size_t>(v)].pending.push_back(interval.depth);
    }
}

void GroupComposer::addLayerStep(RankLeaf::Step step, int index, const Region& region, double depth,
                                 std::vector<OrderedLeaf>& leaves)
{
    const osgUtil::RenderLeaf& beside = *_volumes.front().instance->leaf;
    osg::ref_ptr<osgUtil::RenderLeaf> leaf =
        new osgUtil::RenderLeaf(new RankLeaf(&_accumulation, step, index, areaOf(region)),
                                beside._projection, beside._modelview);
    beside._parent->_parent->find_or_insert(RankLeaf::stateSet(step))->addLeaf(leaf);
    leaves.push_back({depth, leaf.get()});
}

void GroupComposer::addSurfaces(RankLeaf::Step step, int index, const Region& region, double depth,
                                std::vector<OrderedLeaf>& leaves)
{
    for (std::size_t s : region.surfaces) {
        const ForeignLeaf& surface = *_surfaces[s].leaf;
        if (step == RankLeaf::DEPTH && !writesDepth(surface.leaf()._parent)) continue;
        leaves.push_back({depth, surface.copy(*layerSurfaceState(step, index))});
        ++_counts.surfacePieces;
    }
}

void GroupComposer::composeRegion(const Region& region, std::vector<OrderedLeaf>& leaves)
{
    for (PreparedVolume& volume : _volumes)
        makeLooks(volume, region);
    if (canBeCaptured(region)) {
        const std::vector<CaptureSet> sets = findCaptureSets(region);
        if (!sets.empty()) {
            composeCaptured(region, sets, leaves);
            return;
        }
    }
    if (isWorthSorting(region)) {
        composeSorted(region, leaves);
        return;
    }
    const std::vector<core::ScheduledInterval> intervals = schedule(region);
    splitSurfaces(region, intervals);
    _counts.intervals += static_cast<double>(intervals.size());
    bool reversed = false;
    for (std::size_t i = 0; i < intervals.size(); ++i) {
        const core::ScheduledInterval& interval = intervals[i];
        std::vector<int> order = interval.volumes;
        if (reversed) std::reverse(order.begin(), order.end());
        if (interval.surfaces.empty()) addPending(interval, reversed, leaves);
        reversed = !reversed;
        if (interval.surfaces.empty()) continue;
        flush(leaves);
        composeMixed(region, intervals, i, order, leaves);
    }
    flush(leaves);
}

void GroupComposer::composeMixed(const Region& region,
                                 const std::vector<core::ScheduledInterval>& intervals,
                                 std::size_t interval, const std::vector<int>& order,
                                 std::vector<OrderedLeaf>& leaves)
{
    const core::DepthInterval& range = intervals[interval].depth;
    const double depth = middle(range);
    std::vector<std::shared_ptr<const VolumeMesh>> meshes;
    bool split = false;
    for (int v : order) {
        PreparedVolume& volume = _volumes[static_cast<std::size_t>(v)];
        meshes.push_back(meshOf(volume, {range}));
        split = split || (!volume.sliced && !meshes.back()->batches.empty());
    }
    if (split) {
        addStep(AccumulationLeaf::BEGIN_LAYER, region, depth, leaves);
        addPieces(region, intervals, interval, true, leaves);
        addStep(AccumulationLeaf::END_LAYER, region, depth, leaves);
    }
    for (std::size_t i = 0; i < order.size(); ++i) {
        PreparedVolume& volume = _volumes[static_cast<std::size_t>(order[i])];
        addVolume(volume, meshes[i], volume.looks[volume.sliced ? WHOLE : BEHIND_LAYER], depth,
                  leaves);
    }
    addPieces(region, intervals, interval, false, leaves);
    for (std::size_t i = order.size(); i-- > 0;) {
        PreparedVolume& volume = _volumes[static_cast<std::size_t>(order[i])];
        if (!volume.sliced)
            addVolume(volume, meshes[i], volume.looks[IN_FRONT_OF_LAYER], depth, leaves);
    }
}

void GroupComposer::flush(std::vector<OrderedLeaf>& leaves)
{
    if (_pendingVolume < 0) return;
    PreparedVolume& volume = _volumes[static_cast<std::size_t>(_pendingVolume)];
    const double depth = middle(volume.pending.front());
    addVolume(volume, meshOf(volume, volume.pending), volume.looks[WHOLE], depth, leaves);
    volume.pending.clear();
    _pendingVolume = -1;
}

std::shared_ptr<const VolumeMesh>
GroupComposer::meshOf(const PreparedVolume& volume,
                      const std::vector<core::DepthInterval>& intervals) const
{
    if (!volume.sliced) return slabMesh(*volume.instance, volume.view, intervals);
    if (alone()) return volume.sliced->mesh(*volume.instance);
    return volume.sliced->mesh(*volume.instance,
                               {intervals.back().nearDepth, intervals.front().farDepth});
}

void GroupComposer::addVolume(PreparedVolume& volume, std::shared_ptr<const VolumeMesh> mesh,
                              const std::shared_ptr<const VolumeLook>& look, double depth,
                              std::vector<OrderedLeaf>& leaves)
{
    if (mesh->batches.empty()) return;
    VolumeInstance& instance = *volume.instance;
    _counts.faces += mesh->faceCount;
    _counts.polygons += static_cast<double>(mesh->indexArray().size() / 3);
    ++_counts.volumeLeaves;
    osg::ref_ptr<VolumeDrawable> drawable = new VolumeDrawable;
    drawable->set(std::move(mesh), look);
    osg::ref_ptr<osgUtil::RenderLeaf> leaf = new osgUtil::RenderLeaf(
        drawable, instance.leaf->_projection, instance.leaf->_modelview, static_cast<float>(depth));
    osgUtil::StateGraph* graph = instance.leaf->_parent;
    const osg::ref_ptr<osg::StateSet> set = volumeStateSet(look->features);
    if (graph->getStateSet() != set) graph = graph->_parent->find_or_insert(set);
    if (!look->above.depthTest.isUsual() && look->features.slotCount == 0)
        graph = graph->find_or_insert(depthTestStateSet(look->above.depthTest));
    graph->addLeaf(leaf);
    leaves.push_back({depth, leaf.get()});
}

void GroupComposer::addPieces(const Region& region,
                              const std::vector<core::ScheduledInterval>& intervals,
                              std::size_t interval, bool layer, std::vector<OrderedLeaf>& leaves)
{
    const core::ScheduledInterval& scheduled = intervals[interval];
    for (int member : scheduled.surfaces) {
        const Surface& surface =
            _surfaces[region.surfaces[static_cast<std::size_t>(member) - _volumes.size()]];
        osg::ref_ptr<osg::Drawable> part;
        if (surface.mesh) {
            if (surface.splits[interval]->empty()) continue;
            part = surface.mesh->drawable(surface.splits[interval]);
        }
        // The outermost pieces reach as far as the leaf's own planes: bounds may be too tight.
        core::DepthInterval depth = scheduled.depth;
        if (depth.nearDepth == surface.ends.nearDepth) depth.nearDepth = -INFINITE_DEPTH;
        if (depth.farDepth == surface.ends.farDepth) depth.farDepth = INFINITE_DEPTH;
        osgUtil::RenderLeaf* leaf = surface.leaf->piece(depth, layer, part);
        if (!leaf) continue;
        leaves.push_back({middle(scheduled.depth), leaf});
        ++_counts.surfacePieces;
    }
}

glm::ivec4 GroupComposer::areaOf(const Region& region) const
{
    return region.rectangles.empty() ? _viewport : region.rectangles.front();
}

void GroupComposer::addStep(AccumulationLeaf::Step step, const Region& region, double depth,
                            std::vector<OrderedLeaf>& leaves)
{
    leaves.push_back({depth, accumulationLeaf(_accumulation, step, *_volumes.front().instance->leaf,
                                              areaOf(region))});
}

} // namespace render
} // namespace osgVolumizer
