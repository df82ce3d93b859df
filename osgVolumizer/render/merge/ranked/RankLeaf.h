#pragma once

#include "../SortingLeaf.h"
#include "RankBuffers.h"

#include <osg/StateSet>

#include <glm/vec4.hpp>

namespace osgVolumizer {
namespace render {

/// Sorts the fragments of any surfaces by depth, pixel by pixel, without touching their shaders.
///
/// K times only the k-th fragment of a pixel to be rasterised leaves its depth in buffer k, by
/// stencil (the stencil-routed A-buffer of Myers and Bavoil, "Stencil Routed A-Buffer", SIGGRAPH
/// Sketches 2007, one buffer a pass). A full-screen pass sorts the K depths. Then, for each
/// rank from far to near, the volume's segment behind that depth is drawn, and the surfaces again,
/// where their depth equals it: exact order with any blend function, and no clipping, so no seams.
/// Passes that no pixel needs are skipped by the GPU (conditional rendering on the
/// occlusion query of its pass). Fragments beyond the K-th of a pixel are drawn last, in the order
/// that they come.
class RankLeaf : public SortingLeaf
{
public:
    static constexpr int RANK_COUNT = RankBuffers::COUNT;

    enum Step
    {
        BEGIN_DEPTHS, ///< of the `index`-th fragments
        END_DEPTHS,
        SORT,
        BEGIN_SEGMENT, ///< of the volume: before rank `index`
        END_SEGMENT,
        BEGIN_RANK, ///< surfaces of rank `index`
        END_RANK,
        BEGIN_REST, ///< fragments beyond the last rank
        END_REST
    };

    RankLeaf(Accumulation* accumulation, Step step, int index, const glm::ivec4& area);
    osg::Object* cloneType() const override;
    const char* className() const override { return "RankLeaf"; }
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

    /// The state that a step is drawn with.
    static osg::ref_ptr<osg::StateSet> stateSet(Step step);

private:
    RankBuffers* buffersIn(osg::State& state) const;
    void draw(osg::State& state, const RankBuffers& buffers) const;
    void sort(osg::State& state, const RankBuffers& buffers) const;
    void fill(osg::State& state, const RankBuffers& buffers) const;

    Step _step;
    int _index;
};

/// How surfaces are drawn in a step that begins with them.
osg::ref_ptr<osg::StateSet> rankedSurfaceState(RankLeaf::Step step, int index);

} // namespace render
} // namespace osgVolumizer
