#include "MergedGroup.h"

#include "../../Error.h"
#include "../context/ContextRefusals.h"
#include "../context/LeafState.h"
#include "../context/Matrices.h"
#include "../context/ScissorScope.h"
#include "../context/ScreenPass.h"
#include "../context/SharedStateSets.h"
#include "../draw/VolumeProgram.h"
#include "../volume/SlabMesh.h"
#include "FuseVolumes.h"
#include "ScreenAreas.h"

#include <osg/ColorMask>
#include <osgUtil/StateGraph>

#include <algorithm>
#include <iterator>
#include <limits>

namespace osgVolumizer {
namespace render {

namespace {

// More rectangles would cost more than they save.
constexpr std::size_t MAXIMUM_REGIONS = 8;

// Any order that does not depend on the order of nodes.
bool comesFirst(const VolumeInstance* a, const VolumeInstance* b)
{
    if (a->depth.farDepth != b->depth.farDepth) return a->depth.farDepth > b->depth.farDepth;
    if (a->depth.nearDepth != b->depth.nearDepth) return a->depth.nearDepth > b->depth.nearDepth;
    const osg::Matrixd &m = *a->frameToEye, &n = *b->frameToEye;
    return std::lexicographical_compare(m.ptr(), m.ptr() + 16, n.ptr(), n.ptr() + 16);
}

// Intervals as depths from a march's reference depth, the outermost to the ends of its volumes.
std::vector<core::DepthInterval> fromReference(const MergedVolume& volume,
                                               std::vector<core::DepthInterval> intervals)
{
    const double reference = volume.look->referenceDepth;
    for (core::DepthInterval& interval : intervals) {
        if (interval.nearDepth <= volume.depth.nearDepth)
            interval.nearDepth = volume.wholeDepth.nearDepth;
        if (interval.farDepth >= volume.depth.farDepth)
            interval.farDepth = volume.wholeDepth.farDepth;
        interval = {interval.nearDepth - reference, interval.farDepth - reference};
    }
    return intervals;
}

} // namespace

MergedGroup::MergedGroup(const MergeGroup& group, const MergeFrame& frame, LeafList& untouched)
    : _frame(frame)
{
    prepareVolumes(group);
    prepareSurfaces(group, untouched);
    fuse(!_surfaces.empty());
}

bool MergedGroup::prepare(VolumeInstance& instance, bool mergeable, MergedVolume& volume) const
{
    volume.instance = &instance;
    volume.view = {toGlm(*instance.leaf->_modelview), toGlm(usualProjection(*instance.leaf))};
    volume.look = instance.look;
    volume.depth = instance.depth;
    volume.wholeDepth = instance.wholeDepth;
    volume.step = instance.look->step;
    volume.rayDistance = instance.rayDistance;
    volume.screen = viewOf(instance).screen;
    if (instance.look->features.slab) return true;
    volume.sliced = std::make_unique<SlicedVolume>();
    const Status status = volume.sliced->polygonize(instance, volume.view, mergeable);
    if (volume.sliced->polygonized()) ++_frame.counts.polygonizations;
    reportError(status);
    if (status.ok()) volume.step = volume.sliced->spacing();
    return status.ok();
}

void MergedGroup::prepareVolumes(const MergeGroup& group)
{
    const bool mergeable = group.volumes.size() > 1 || !group.surfaces.empty();
    std::vector<VolumeInstance*> instances = group.volumes;
    std::sort(instances.begin(), instances.end(), comesFirst);
    _step = std::numeric_limits<double>::infinity();
    for (VolumeInstance* instance : instances) {
        MergedVolume volume;
        if (!prepare(*instance, mergeable, volume)) continue;
        _step = std::min(_step, volume.step);
        _volumes.push_back(std::move(volume));
    }
}

void MergedGroup::fuse(bool splitBricks)
{
    if (isRefused(_frame.contextId, Refusal::FUSED_VOLUMES)) return;
    FuseLimits limits;
    if (_frame.textureUnits > 0) limits.textureUnits = _frame.textureUnits;
    fuseVolumes(_volumes, limits, splitBricks);
}

VolumeOutline MergedGroup::outlineOf(const VolumeInstance& volume) const
{
    VolumeOutline outline;
    outline.depth = volume.depth;
    // Faces of slabs are a little larger than their box.
    outline.margin = {4.0 / std::max(_frame.viewport[2], 1), 4.0 / std::max(_frame.viewport[3], 1)};
    const glm::dmat4 toClip =
        toGlm(usualProjection(*volume.leaf)) * toGlm(*volume.leaf->_modelview);
    for (int i = 0; i < 8; ++i) {
        const glm::dvec4 clip = toClip * glm::dvec4(volume.prepared->regionBox.corner(i), 1.0);
        outline.everywhere = outline.everywhere || !(clip.w > 0.0);
        outline.corners[i] = glm::dvec2(clip) / clip.w;
    }
    return outline;
}

void MergedGroup::prepareSurfaces(const MergeGroup& group, LeafList& untouched)
{
    std::vector<VolumeOutline> outlines;
    if (!group.surfaces.empty())
        for (const MergedVolume& volume : _volumes)
            outlines.push_back(outlineOf(*volume.instance));
    for (const ForeignLeaf* leaf : group.surfaces) {
        MergedSurface surface;
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
            untouched.add(leaf->leaf()._depth, &leaf->leaf());
    }
}

std::vector<MergeRegion> MergedGroup::regions() const
{
    std::vector<ScreenArea> areas;
    for (std::size_t s = 0; s < _surfaces.size(); ++s) {
        // What is no mesh of triangles may be wider than its bounds: points, lines, text.
        const int margin = _surfaces[s].mesh ? 2 : 16;
        areas.push_back({pixelRectangle(_surfaces[s].view.screen, _frame.viewport, margin), {s}});
    }
    areas = joinOverlapping(std::move(areas), MAXIMUM_REGIONS);
    if (_surfaces.empty()) return {MergeRegion()};
    std::vector<MergeRegion> regions;
    std::vector<glm::ivec4> rest = {_frame.viewport};
    for (const ScreenArea& area : areas) {
        regions.push_back({{area.rectangle}, area.members});
        rest = subtract(rest, area.rectangle);
    }
    if (!rest.empty()) regions.push_back({rest, {}});
    return regions;
}

glm::ivec4 MergedGroup::areaOf(const MergeRegion& region) const
{
    return region.rectangles.empty() ? _frame.viewport : region.rectangles.front();
}

// What of a region a march covers.
std::vector<glm::ivec4> MergedGroup::areasOf(const MergeRegion& region,
                                             const MergedVolume& volume) const
{
    const glm::ivec4 covered = pixelRectangle(volume.screen, _frame.viewport, 2);
    if (region.rectangles.empty()) return {covered};
    std::vector<glm::ivec4> areas;
    for (const glm::ivec4& rectangle : region.rectangles) {
        const glm::ivec4 area = intersection(rectangle, covered);
        if (area[2] > 0 && area[3] > 0) areas.push_back(area);
    }
    // None would mean everywhere.
    if (areas.empty()) areas.emplace_back(0, 0, 0, 0);
    return areas;
}

VolumePart MergedGroup::partIn(const MergeRegion& region, const MergedVolume& volume) const
{
    VolumePart part = partOf(*volume.instance);
    part.scissors = region.rectangles;
    part.covered = pixelRectangle(volume.screen, _frame.viewport, 2);
    if (volume.fused) {
        part.look = volume.look;
        part.features = volume.look->features;
        part.fused = volume.fused;
        part.lights = nullptr;
        part.paints = nullptr;
        part.scissors = areasOf(region, volume);
    }
    if (volume.sliced) {
        part.step = volume.sliced->spacing();
        part.surfaceNormal = volume.sliced->surfaceNormal();
        part.features.spherical = volume.sliced->spherical();
    } else if (!isAlone()) {
        // The same samples in every region, and one for each volume in a thin slab.
        part.step = _step;
    }
    return part;
}

VolumePart MergedGroup::wholeIn(const MergeRegion& region, const MergedVolume& volume) const
{
    VolumePart part = partIn(region, volume);
    part.rayDistance = volume.rayDistance;
    part.features.coarse = part.rayDistance > 1.0 && part.features.slab &&
                           !part.features.gathers() && !part.features.countSamples;
    return part;
}

std::shared_ptr<const VolumeMesh>
MergedGroup::meshOf(const MergedVolume& volume,
                    const std::vector<core::DepthInterval>& farToNear) const
{
    if (volume.fused) return screenMesh({}, fromReference(volume, farToNear));
    if (!volume.sliced) return slabMesh(*volume.instance, volume.view, farToNear);
    if (isAlone()) return volume.sliced->mesh(*volume.instance);
    return volume.sliced->mesh(*volume.instance,
                               {farToNear.back().nearDepth, farToNear.front().farDepth});
}

std::shared_ptr<const VolumeMesh> MergedGroup::screenMeshOf(const MergedVolume& volume) const
{
    return volume.fused ? meshOf(volume, {volume.depth}) : screenMesh(*volume.instance);
}

void MergedGroup::addVolume(const MergedVolume& volume, std::shared_ptr<const VolumeMesh> mesh,
                            std::shared_ptr<const VolumePart> part, double depth,
                            LeafList& leaves) const
{
    if (mesh->batches.empty()) return;
    const VolumeInstance& instance = *volume.instance;
    _frame.counts.faces += mesh->faceCount;
    _frame.counts.polygons += static_cast<double>(mesh->indexArray().size() / 3);
    ++_frame.counts.volumeLeaves;
    osgUtil::StateGraph* graph = instance.leaf->_parent;
    const osg::ref_ptr<osg::StateSet> set = volumeStateSet(part->features, membersOf(*part));
    if (graph->getStateSet() != set) graph = graph->_parent->find_or_insert(set);
    if (!part->above.depthTest.isUsual() && part->features.slotCount == 0)
        graph = graph->find_or_insert(depthTestStateSet(part->above.depthTest));
    osg::ref_ptr<VolumeDrawable> drawable = new VolumeDrawable;
    drawable->set(std::move(mesh), std::move(part));
    osg::ref_ptr<osgUtil::RenderLeaf> leaf = new osgUtil::RenderLeaf(
        drawable, instance.leaf->_projection, instance.leaf->_modelview, static_cast<float>(depth));
    graph->addLeaf(leaf);
    leaves.add(depth, leaf.get());
}

void MergedGroup::addStep(osg::Drawable* drawable, osg::StateSet* state, double depth,
                          LeafList& leaves) const
{
    const osgUtil::RenderLeaf& beside = *_volumes.front().instance->leaf;
    osg::ref_ptr<osgUtil::RenderLeaf> leaf = new osgUtil::RenderLeaf(
        drawable, beside._projection, beside._modelview, static_cast<float>(depth));
    beside._parent->_parent->find_or_insert(state)->addLeaf(leaf);
    leaves.add(depth, leaf.get());
}

void MergedGroup::addCopies(const std::vector<std::size_t>& surfaces, osg::StateSet& state,
                            double depth, LeafList& leaves) const
{
    for (std::size_t s : surfaces) {
        leaves.add(depth, _surfaces[s].leaf->copy(state));
        ++_frame.counts.surfacePieces;
    }
}

void MergedGroup::addDepths(const std::vector<std::size_t>& surfaces, LeafList& leaves) const
{
    std::vector<std::size_t> writing;
    std::copy_if(surfaces.begin(), surfaces.end(), std::back_inserter(writing),
                 [this](std::size_t s) { return writesDepth(_surfaces[s].graph()); });
    const osg::ref_ptr<osg::StateSet> set = sharedStateSet(SharedState::SURFACE_DEPTHS, []() {
        osg::ref_ptr<osg::StateSet> made = new osg::StateSet;
        made->setAttribute(new osg::ColorMask(false, false, false, false), FORCE_ON);
        return made;
    });
    addCopies(writing, *set, depth(), leaves);
}

} // namespace render
} // namespace osgVolumizer
