#pragma once

#include "../../core/ordering/DepthSchedule.h"

#include <osg/Depth>
#include <osg/StateSet>
#include <osgUtil/RenderLeaf>

#include <glm/vec2.hpp>

#include <map>
#include <optional>

namespace osgVolumizer {
namespace render {

/// Rectangle of normalised device coordinates.
struct ScreenRectangle
{
    glm::dvec2 min{-1.0}, max{1.0};

    bool overlaps(const ScreenRectangle& o) const
    {
        return min.x < o.max.x && o.min.x < max.x && min.y < o.max.y && o.min.y < max.y;
    }
};

/// Screen rectangle and depth range of the corners of a box; what reaches behind the eye fills the
/// screen.
struct BoxInView
{
    ScreenRectangle screen;
    core::DepthInterval depth;
};
BoxInView boxInView(const osg::BoundingBoxd& box, const osg::Matrixd& modelView,
                    const osg::Matrixd& projection);

/// Whether a drawable is known to draw with the state of its graph; others may set GL state
/// themselves, as particle systems do.
bool keepsState(const osg::Drawable& drawable);

/// How fragments of a graph are blended.
struct Blending
{
    bool over =
        false; ///< all channels: source, perhaps weighted, plus (1 - alpha) of what is behind
    bool colorWeighted = false, alphaWeighted = false; ///< by the source's alpha

    bool operator==(const Blending& o) const
    {
        return over == o.over && colorWeighted == o.colorWeighted &&
               alphaWeighted == o.alphaWeighted;
    }
};
Blending blendingOf(const osgUtil::StateGraph* graph);
/// Whether the depth test is the usual one: on, nearer passes.
bool hasUsualDepthTest(const osgUtil::StateGraph* graph);
/// Whether depths go to the whole depth range, [0, 1].
bool hasUsualDepthRange(const osgUtil::StateGraph* graph);

/// A leaf that is not ours, in the same bin: never touched, but replaced by copies where it reaches
/// into a volume.
class ForeignLeaf
{
public:
    /// Nothing where the leaf cannot be ordered against volumes seen through `projection`: without
    /// matrices, without bounds, with a depth test that farther fragments pass, or in another
    /// projection (but for near and far).
    static std::optional<ForeignLeaf> examine(osgUtil::RenderLeaf& leaf,
                                              const osg::Matrixd& projection);

    osgUtil::RenderLeaf& leaf() const { return *_leaf; }
    const BoxInView& view() const { return _view; }

    /// A copy of the leaf that draws only what lies between two depths: the planes become those of
    /// its projection, and the window depths of these planes its depth range. Window z is affine in
    /// 1/z, so every fragment keeps its depth exactly, whatever the shader. An infinite end is left
    /// as it was. \param depthOnly no colour, and the nearest depth, whatever the leaf's own test
    /// \param drawable draws the part of the leaf's drawable that matters; null: all of it
    osgUtil::RenderLeaf* piece(const core::DepthInterval& interval, bool depthOnly,
                               osg::Drawable* drawable = nullptr) const;

    /// A copy of the whole leaf with a state of the caller's on top.
    osgUtil::RenderLeaf* copy(osg::StateSet& state) const;

private:
    explicit ForeignLeaf(osgUtil::RenderLeaf& leaf) : _leaf(&leaf) {}

    osgUtil::RenderLeaf* _leaf;
    BoxInView _view;
};

} // namespace render
} // namespace osgVolumizer
