#pragma once

#include "../SortingLeaf.h"
#include "CaptureBuffers.h"

#include <osg/StateSet>

#include <glm/vec4.hpp>

namespace osgVolumizer {
namespace render {

/// Captures the fragments of translucent surfaces, colour and depth, for a volume to composite them
/// while it marches: one pass over the volume, however many surfaces are in it.
///
/// Surfaces are drawn without blending into slots, the k-th fragment of a pixel into the k-th slot
/// of its set, by stencil (Myers and Bavoil, "Stencil Routed A-Buffer", SIGGRAPH Sketches 2007, one
/// slot a pass). Large meshes are sets of their own, since a pass of a set draws the set alone. A
/// full-screen pass sorts each pixel's fragments by a network (Batcher, "Sorting networks and their
/// applications", AFIPS 1968). So their shaders are left alone, but their blending has to be one
/// that is known: see blendingOf(). Fragments of a pixel beyond its set's last slot are drawn last.
class CaptureLeaf : public SortingLeaf
{
public:
    static constexpr int MAXIMUM_SLOTS = CaptureBuffers::MAXIMUM_SLOTS;

    enum Step
    {
        BEGIN_SLOT,
        END_SLOT,
        SORT,        ///< all slots
        WRITE_DEPTH, ///< of the nearest fragments, to the target
        BEGIN_REST,  ///< fragments beyond the set's last slot
        END_REST
    };
    struct Settings
    {
        Step step = SORT;
        int slotCount = 0; ///< of the region; multiple of 4
        int slot = 0;      ///< that is drawn to; the set's last one for the rest
        /// Of a slot: whether it is needed only if something was drawn to the one before.
        bool conditional = false;
        glm::ivec4 area{0}; ///< window rectangle: x, y, width, height
    };

    CaptureLeaf(Accumulation* accumulation, const Settings& settings);
    osg::Object* cloneType() const override;
    const char* className() const override { return "CaptureLeaf"; }
    void drawImplementation(osg::RenderInfo& renderInfo) const override;

    /// The state that a step is drawn with.
    static osg::ref_ptr<osg::StateSet> stateSet(const Settings& settings);

private:
    CaptureBuffers* buffersIn(osg::State& state) const;
    void draw(osg::State& state, const CaptureBuffers& buffers) const;
    void sort(osg::State& state, const CaptureBuffers& buffers) const;

    Settings _settings;
};

/// How surfaces are drawn into slots: `fragment` counts from 0 in their set.
osg::ref_ptr<osg::StateSet> captureState(int fragment);
/// How fragments from number `fragments` on are drawn to the target.
osg::ref_ptr<osg::StateSet> captureRestState(int fragments);

} // namespace render
} // namespace osgVolumizer
