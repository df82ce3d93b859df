#include "CapturedSurfaces.h"

#include "../../context/ContextRefusals.h"
#include "../../context/LeafState.h"
#include "../../volume/SlabMesh.h"

#include <algorithm>
#include <string>

namespace osgVolumizer {
namespace render {

namespace {

// Whether colour and depth of a fragment come together, with the graph's state: not of text, which
// writes depth in a pass of its own, nor of what others may do.
bool drawsAtOnce(const osg::Drawable& drawable)
{
    const std::string library = drawable.libraryName();
    return drawable.asGeometry() && !drawable.getDrawCallback() &&
           (library == "osg" || library == "osgAnimation");
}

bool canBeCaptured(const MergedGroup& group, const MergeRegion& region)
{
    if (region.surfaces.empty() || group.volumes().size() != 1) return false;
    if (isRefused(group.frame().contextId, Refusal::CAPTURED_SURFACES)) return false;
    const MergedVolume& volume = group.volumes().front();
    if (!volume.isOne()) return false;
    if (!volume.instance->above.isUsual()) return false;
    const Blending blending = blendingOf(group.surfaces()[region.surfaces.front()].graph());
    if (!blending.over) return false;
    return std::all_of(region.surfaces.begin(), region.surfaces.end(), [&](std::size_t s) {
        const MergedSurface& surface = group.surfaces()[s];
        return drawsAtOnce(*surface.leaf->leaf().getDrawable()) &&
               hasUsualDepthTest(surface.graph()) && blendingOf(surface.graph()) == blending;
    });
}

} // namespace

std::optional<CapturedSurfaces> CapturedSurfaces::of(const MergedGroup& group,
                                                     const MergeRegion& region)
{
    if (!canBeCaptured(group, region)) return std::nullopt;
    std::vector<SurfaceDepthComplexity> surfaces;
    for (std::size_t s : region.surfaces) {
        const SurfaceMesh* mesh = group.surfaces()[s].mesh.get();
        if (mesh)
            surfaces.push_back({mesh->coverEstimate(), mesh->triangleCount(), true});
        else
            surfaces.emplace_back();
    }
    const glm::ivec4& viewport = group.frame().viewport;
    std::vector<CaptureSet> sets = findCaptureSets(
        surfaces, affordableSlots(viewport[0] + viewport[2], viewport[1] + viewport[3]));
    if (sets.empty()) return std::nullopt;
    return CapturedSurfaces(group, region, std::move(sets));
}

void CapturedSurfaces::compose(LeafList& leaves) const
{
    _group.frame().accumulation.requireTarget();
    for (const CaptureSet& set : _sets)
        addCaptures(set, leaves);
    addStep(CaptureLeaf::SORT, 0, false, leaves);
    addVolume(leaves);
    for (const CaptureSet& set : _sets)
        addRest(set, leaves);
    addDepths(leaves);
}

std::vector<std::size_t> CapturedSurfaces::surfacesOf(const CaptureSet& set) const
{
    std::vector<std::size_t> surfaces;
    for (std::size_t s : set.surfaces)
        surfaces.push_back(_region.surfaces[s]);
    return surfaces;
}

void CapturedSurfaces::addStep(CaptureLeaf::Step step, int slot, bool conditional,
                               LeafList& leaves) const
{
    CaptureLeaf::Settings settings;
    settings.step = step;
    settings.slotCount = slotCount();
    settings.slot = slot;
    settings.conditional = conditional;
    settings.area = _group.areaOf(_region);
    _group.addStep(new CaptureLeaf(&_group.frame().accumulation, settings),
                   CaptureLeaf::stateSet(settings), _group.depth(), leaves);
}

void CapturedSurfaces::addCaptures(const CaptureSet& set, LeafList& leaves) const
{
    const std::vector<std::size_t> surfaces = surfacesOf(set);
    for (int k = 0; k < set.slotCount; ++k) {
        // Waiting for what the last pass drew costs; passes that are likely needed do not.
        const bool conditional = k > 1;
        addStep(CaptureLeaf::BEGIN_SLOT, set.firstSlot + k, conditional, leaves);
        _group.addCopies(surfaces, *captureState(k), _group.depth(), leaves);
        addStep(CaptureLeaf::END_SLOT, set.firstSlot + k, conditional, leaves);
    }
}

void CapturedSurfaces::addVolume(LeafList& leaves) const
{
    const MergedVolume& volume = _group.volumes().front();
    VolumePart part = _group.wholeIn(_region, volume);
    part.scissors = _region.rectangles; // surfaces may reach beyond the volumes
    part.covered = _group.frame().viewport;
    part.features.slotCount = slotCount();
    const Blending blending = blendingOf(_group.surfaces()[_region.surfaces.front()].graph());
    part.surfaceWeights = {blending.colorWeighted ? 1.0f : 0.0f,
                           blending.alphaWeighted ? 1.0f : 0.0f};
    _group.addVolume(volume, _group.screenMeshOf(volume),
                     std::make_shared<const VolumePart>(std::move(part)), _group.depth(), leaves);
}

void CapturedSurfaces::addRest(const CaptureSet& set, LeafList& leaves) const
{
    const int slot = set.firstSlot + set.slotCount - 1;
    addStep(CaptureLeaf::BEGIN_REST, slot, false, leaves);
    _group.addCopies(surfacesOf(set), *captureRestState(set.slotCount), _group.depth(), leaves);
    addStep(CaptureLeaf::END_REST, slot, false, leaves);
}

// One pass where all surfaces write depth to the whole range.
void CapturedSurfaces::addDepths(LeafList& leaves) const
{
    const bool oneDepth =
        std::all_of(_region.surfaces.begin(), _region.surfaces.end(), [this](std::size_t s) {
            const osgUtil::StateGraph* graph = _group.surfaces()[s].graph();
            return writesDepth(graph) && hasUsualDepthRange(graph);
        });
    if (oneDepth)
        addStep(CaptureLeaf::WRITE_DEPTH, 0, false, leaves);
    else
        _group.addDepths(_region.surfaces, leaves);
}

} // namespace render
} // namespace osgVolumizer
