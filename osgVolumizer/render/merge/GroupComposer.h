#pragma once

#include "../draw/AccumulationLeaf.h"
#include "../volume/SlabMesh.h"
#include "../volume/SlicedVolume.h"
#include "CaptureLeaf.h"
#include "ForeignLeaf.h"
#include "RankLeaf.h"
#include "SurfaceMesh.h"

#include <osgUtil/RenderLeaf>

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

/// A leaf and the depth that it is sorted by.
struct OrderedLeaf
{
    double depth = 0.0;
    osgUtil::RenderLeaf* leaf = nullptr;
};

/// What a frame did, for the statistics.
struct FrameCounts
{
    double faces = 0.0, polygons = 0.0, polygonizations = 0.0, bricksDrawn = 0.0;
    double volumeLeaves = 0.0, surfacePieces = 0.0, intervals = 0.0;
};

/// Volumes and translucent leaves that overlap in depth and on the screen, directly or through each
/// other.
struct MergeGroup
{
    std::vector<VolumeInstance*> volumes;
    std::vector<const ForeignLeaf*> surfaces;
};

/// Makes the leaves of one group, far to near.
///
/// A volume by itself is one leaf. Where surfaces with usual blending are in one volume of one
/// brick, or of several in one texture, their fragments are captured and composited while the
/// volume is marched: see CaptureLeaf; exact, and the fastest. Where a few others are in volumes,
/// their fragments are sorted: see RankLeaf; that is exact too. Where there are many triangles,
/// depth is cut into intervals. An interval of a volume and surfaces is drawn as: the surfaces'
/// nearest depth into a layer buffer, the volume behind that depth, the surfaces, the volume in
/// front of it; this is exact where a pixel has one surface in the interval, and off by the
/// interval's thickness where it has more. Several volumes are drawn in slabs one step thick,
/// alternating who goes first: the error of drawing one slab of A behind one of B, ½ tauA tauB h²
/// (cA - cB), has the other sign in the next slab, so it cancels, and what remains is second order
/// in h and independent of who is A.
///
/// Only pixels that surfaces can touch pay for them: the viewport is cut into rectangles around
/// surfaces that overlap each other on the screen, each with intervals of its own, and the rest.
class GroupComposer
{
public:
    /// \param viewport x, y, width, height in pixels
    /// \param contextId of the context that will draw
    GroupComposer(const MergeGroup& group, const glm::ivec4& viewport, unsigned contextId,
                  Accumulation& accumulation, FrameCounts& counts)
        : _group(group), _viewport(viewport), _contextId(contextId), _accumulation(accumulation),
          _counts(counts)
    {
    }
    void compose(std::vector<OrderedLeaf>& leaves);

private:
    enum Part
    {
        WHOLE,
        BEHIND_LAYER,
        IN_FRONT_OF_LAYER
    };
    struct PreparedVolume
    {
        VolumeInstance* instance = nullptr;
        core::View view;
        std::unique_ptr<SlicedVolume> sliced; ///< slices only
        std::shared_ptr<const VolumeLook> looks[3];
        std::vector<core::DepthInterval> pending; ///< whole intervals, not yet a leaf
    };

    struct Surface
    {
        const ForeignLeaf* leaf = nullptr;
        std::unique_ptr<SurfaceMesh> mesh; ///< where its triangles are known
        BoxInView view;
        core::DepthInterval ends;                 ///< of the intervals that it is drawn in
        std::vector<SurfaceMesh::Indices> splits; ///< per interval of the schedule, with a mesh
    };
    /// A part of the viewport with a schedule of its own: only the surfaces that show there matter.
    struct Region
    {
        std::vector<glm::ivec4> rectangles; ///< none: everywhere
        std::vector<std::size_t> surfaces;
    };

    bool prepare(VolumeInstance& instance, PreparedVolume& volume);
    void prepareVolumes();
    VolumeOutline outlineOf(const VolumeInstance& volume) const;
    void prepareSurfaces(std::vector<OrderedLeaf>& leaves);
    std::vector<Region> findRegions() const;
    static bool leavesDepth(const Surface& surface);
    bool isWorthSorting(const Region& region) const;
    /// Surfaces whose fragments are captured together, in slots of their own.
    struct CaptureSet
    {
        std::vector<std::size_t> surfaces;
        int firstSlot = 0, slotCount = 0;
    };
    bool canBeCaptured(const Region& region) const;
    std::vector<CaptureSet> findCaptureSets(const Region& region) const;
    void composeCaptured(const Region& region, const std::vector<CaptureSet>& sets,
                         std::vector<OrderedLeaf>& leaves);
    void addCaptureStep(const CaptureLeaf::Settings& settings, double depth,
                        std::vector<OrderedLeaf>& leaves);
    void addCopies(const std::vector<std::size_t>& surfaces, osg::StateSet& state, double depth,
                   std::vector<OrderedLeaf>& leaves);
    void composeSorted(const Region& region, std::vector<OrderedLeaf>& leaves);
    void composeVolumes(const std::vector<core::ScheduledInterval>& intervals,
                        std::vector<OrderedLeaf>& leaves);
    void addPending(const core::ScheduledInterval& interval, bool reversed,
                    std::vector<OrderedLeaf>& leaves);
    void addLayerStep(RankLeaf::Step step, int index, const Region& region, double depth,
                      std::vector<OrderedLeaf>& leaves);
    void addSurfaces(RankLeaf::Step step, int index, const Region& region, double depth,
                     std::vector<OrderedLeaf>& leaves);
    void composeRegion(const Region& region, std::vector<OrderedLeaf>& leaves);
    void makeLooks(PreparedVolume& volume, const Region& region);
    std::vector<core::ScheduledInterval> schedule(const Region& region) const;
    void splitSurfaces(const Region& region, const std::vector<core::ScheduledInterval>& intervals);
    void composeMixed(const Region& region, const std::vector<core::ScheduledInterval>& intervals,
                      std::size_t interval, const std::vector<int>& order,
                      std::vector<OrderedLeaf>& leaves);
    void flush(std::vector<OrderedLeaf>& leaves);
    void addVolume(PreparedVolume& volume, std::shared_ptr<const VolumeMesh> mesh,
                   const std::shared_ptr<const VolumeLook>& look, double depth,
                   std::vector<OrderedLeaf>& leaves);
    void addPieces(const Region& region, const std::vector<core::ScheduledInterval>& intervals,
                   std::size_t interval, bool layer, std::vector<OrderedLeaf>& leaves);
    void addStep(AccumulationLeaf::Step step, const Region& region, double depth,
                 std::vector<OrderedLeaf>& leaves);
    std::shared_ptr<const VolumeMesh>
    meshOf(const PreparedVolume& volume, const std::vector<core::DepthInterval>& intervals) const;
    glm::ivec4 areaOf(const Region& region) const;
    bool alone() const { return _volumes.size() == 1 && _surfaces.empty(); }

    const MergeGroup& _group;
    const glm::ivec4 _viewport;
    const unsigned _contextId;
    Accumulation& _accumulation;
    FrameCounts& _counts;
    std::vector<PreparedVolume> _volumes;
    std::vector<Surface> _surfaces;
    double _step = 0.0; ///< of the finest volume
    int _pendingVolume = -1;
};

} // namespace render
} // namespace osgVolumizer
