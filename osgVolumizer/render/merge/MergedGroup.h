#pragma once

#include "../draw/Accumulation.h"
#include "../draw/FusedVolumes.h"
#include "../volume/SlicedVolume.h"
#include "FrameCounts.h"
#include "LeafList.h"
#include "MergeGroups.h"
#include "SurfaceMesh.h"

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

/// What groups of one bin are merged with.
struct MergeFrame
{
    glm::ivec4 viewport{0}; ///< x, y, width, height in pixels
    unsigned contextId = 0; ///< of the context that will draw
    int textureUnits = 0;   ///< of its fragment shaders; 0 where that is not known yet
    Accumulation& accumulation;
    FrameCounts& counts;
};

/// A volume, or several that are marched together and so are as good as one.
struct MergedVolume
{
    VolumeInstance* instance = nullptr; ///< of several the one whose leaf stands for all
    core::View view;
    std::unique_ptr<SlicedVolume> sliced;      ///< null for slabs
    std::shared_ptr<const FusedVolumes> fused; ///< null for one volume by itself
    std::shared_ptr<const VolumeLook> look;    ///< of the volume, or of the march
    core::DepthInterval depth, wholeDepth;     ///< see VolumeInstance
    double step = 0.0;                         ///< eye units of depth
    double rayDistance = 1.0;                  ///< pixels
    ScreenRectangle screen;                    ///< that it covers

    /// Whether it is drawn by one program at once.
    bool isOne() const { return fused || (!sliced && instance->bricks.size() == 1); }
};

struct MergedSurface
{
    const ForeignLeaf* leaf = nullptr;
    std::unique_ptr<SurfaceMesh> mesh; ///< null where its triangles are not known
    BoxInView view;

    const osgUtil::StateGraph* graph() const { return leaf->leaf()._parent; }
    /// False of drawables that may set the depth mask themselves, as particle systems do.
    bool leavesDepth() const { return keepsState(*leaf->leaf().getDrawable()); }
};

/// A part of the viewport that is merged by itself: only the surfaces that show there matter.
struct MergeRegion
{
    std::vector<glm::ivec4> rectangles; ///< window; none: everywhere
    std::vector<std::size_t> surfaces;  ///< numbers of MergedGroup::surfaces()
};

/// The volumes and surfaces of one group, made ready for any way to merge them.
class MergedGroup
{
public:
    /// Surfaces that, looked at closely, reach into no volume stay the leaves they are, and are
    /// added to `untouched`.
    MergedGroup(const MergeGroup& group, const MergeFrame& frame, LeafList& untouched);

    const MergeFrame& frame() const { return _frame; }
    /// In an order that does not depend on that of the nodes.
    const std::vector<MergedVolume>& volumes() const { return _volumes; }
    const std::vector<MergedSurface>& surfaces() const { return _surfaces; }
    /// Of the finest volume: eye units of depth.
    double step() const { return _step; }
    /// That groups which are drawn as a whole are sorted by: eye units.
    double depth() const { return _volumes.front().look->referenceDepth; }
    /// Whether there is one volume, or one march, and nothing else.
    bool isAlone() const { return _volumes.size() == 1 && _surfaces.empty(); }

    /// Rectangles around surfaces that overlap each other on the screen, so that only pixels that
    /// surfaces can touch pay for them, and the rest.
    std::vector<MergeRegion> regions() const;
    /// The window rectangle that passes over a region with surfaces fill.
    glm::ivec4 areaOf(const MergeRegion& region) const;

    /// All of a volume in a region.
    VolumePart partIn(const MergeRegion& region, const MergedVolume& volume) const;
    /// The same for one leaf that draws it at once, perhaps with fewer rays than pixels.
    VolumePart wholeIn(const MergeRegion& region, const MergedVolume& volume) const;
    /// All of a volume for a shader that finds its part of the ray itself; expects isOne().
    std::shared_ptr<const VolumeMesh> screenMeshOf(const MergedVolume& volume) const;
    /// The faces of a volume in some intervals, far to near.
    std::shared_ptr<const VolumeMesh>
    meshOf(const MergedVolume& volume, const std::vector<core::DepthInterval>& farToNear) const;
    /// Adds a leaf that draws a part of a volume; none for a mesh without faces.
    void addVolume(const MergedVolume& volume, std::shared_ptr<const VolumeMesh> mesh,
                   std::shared_ptr<const VolumePart> part, double depth, LeafList& leaves) const;
    /// Adds a leaf of the renderer's own, beside those of the first volume.
    void addStep(osg::Drawable* drawable, osg::StateSet* state, double depth,
                 LeafList& leaves) const;
    /// Adds copies of a region's surfaces with a state of the caller's on top.
    void addCopies(const std::vector<std::size_t>& surfaces, osg::StateSet& state, double depth,
                   LeafList& leaves) const;
    /// Adds copies of those surfaces that write depth, which write it alone, for what is drawn
    /// after the bin.
    void addDepths(const std::vector<std::size_t>& surfaces, LeafList& leaves) const;

private:
    bool prepare(VolumeInstance& instance, bool mergeable, MergedVolume& volume) const;
    void prepareVolumes(const MergeGroup& group);
    void fuse(bool splitBricks);
    void prepareSurfaces(const MergeGroup& group, LeafList& untouched);
    std::vector<glm::ivec4> areasOf(const MergeRegion& region, const MergedVolume& volume) const;
    VolumeOutline outlineOf(const VolumeInstance& volume) const;

    const MergeFrame _frame;
    std::vector<MergedVolume> _volumes;
    std::vector<MergedSurface> _surfaces;
    double _step = 0.0;
};

} // namespace render
} // namespace osgVolumizer
