#include "ForeignLeaf.h"

#include "../context/LeafState.h"
#include "../context/Matrices.h"

#include <osg/BlendFunc>
#include <osg/ColorMask>
#include <osg/Drawable>
#include <osgText/TextBase>
#include <osgUtil/StateGraph>

#include <glm/common.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace render {

namespace {

using osg::StateAttribute;

// Whether two projections differ in their clip z alone.
bool sameRays(const osg::Matrixd& a, const osg::Matrixd& b)
{
    for (int row = 0; row < 4; ++row)
        for (int column : {0, 1, 3})
            if (a(row, column) != b(row, column)) return false;
    return true;
}

const osg::Depth* effectiveDepth(const osgUtil::StateGraph* graph)
{
    return effective<osg::Depth>(graph, StateAttribute::DEPTH);
}

// Normalised device z of the plane at a depth.
double deviceZ(const osg::Matrixd& p, double depth)
{
    const double z = -depth * p(2, 2) + p(3, 2), w = -depth * p(2, 3) + p(3, 3);
    return z / w;
}

// A projection whose near and far plane are where device z is zNear and zFar.
osg::Matrixd cutProjection(const osg::Matrixd& p, double zNear, double zFar)
{
    const double scale = 2.0 / (zFar - zNear), offset = -(zFar + zNear) / (zFar - zNear);
    osg::Matrixd cut = p;
    for (int row = 0; row < 4; ++row)
        cut(row, 2) = scale * p(row, 2) + offset * p(row, 3);
    return cut;
}

} // namespace

bool keepsState(const osg::Drawable& drawable)
{
    return (drawable.asGeometry() || dynamic_cast<const osgText::TextBase*>(&drawable)) &&
           !drawable.getDrawCallback();
}

Blending blendingOf(const osgUtil::StateGraph* graph)
{
    using osg::BlendFunc;
    const auto* function = effective<BlendFunc>(graph, StateAttribute::BLENDFUNC);
    if (!writesAllChannels(graph)) return {};
    if (!function || !isOn(graph, GL_BLEND, false) || isOn(graph, GL_COLOR_LOGIC_OP, false) ||
        isOn(graph, GL_STENCIL_TEST, false) ||
        effective<StateAttribute>(graph, StateAttribute::BLENDEQUATION) ||
        effective<StateAttribute>(graph,
                                  StateAttribute::Type(StateAttribute::CAPABILITY + GL_BLEND)))
        return {};
    const auto isWeight = [](GLenum f) { return f == BlendFunc::SRC_ALPHA || f == BlendFunc::ONE; };
    Blending blending;
    blending.over = function->getDestination() == BlendFunc::ONE_MINUS_SRC_ALPHA &&
                    function->getDestinationAlpha() == BlendFunc::ONE_MINUS_SRC_ALPHA &&
                    isWeight(function->getSource()) && isWeight(function->getSourceAlpha());
    blending.colorWeighted = function->getSource() == BlendFunc::SRC_ALPHA;
    blending.alphaWeighted = function->getSourceAlpha() == BlendFunc::SRC_ALPHA;
    return blending;
}

bool hasUsualDepthTest(const osgUtil::StateGraph* graph)
{
    const osg::Depth* depth = effectiveDepth(graph);
    return isDepthTested(graph) && (!depth || depth->getFunction() == osg::Depth::LESS ||
                                    depth->getFunction() == osg::Depth::LEQUAL);
}

bool hasUsualDepthRange(const osgUtil::StateGraph* graph)
{
    const osg::Depth* depth = effectiveDepth(graph);
    return !depth || (depth->getZNear() == 0.0 && depth->getZFar() == 1.0);
}

BoxInView boxInView(const osg::BoundingBoxd& box, const osg::Matrixd& modelView,
                    const osg::Matrixd& projection)
{
    BoxInView r;
    const double infinity = std::numeric_limits<double>::infinity();
    r.depth = {infinity, -infinity};
    r.screen = {glm::dvec2(infinity), glm::dvec2(-infinity)};
    bool behind = false;
    for (unsigned i = 0; i < 8; ++i) {
        const osg::Vec3d eye = box.corner(i) * modelView;
        const osg::Vec4d clip = osg::Vec4d(eye, 1.0) * projection;
        r.depth.nearDepth = std::min(r.depth.nearDepth, -eye.z());
        r.depth.farDepth = std::max(r.depth.farDepth, -eye.z());
        behind = behind || clip.w() <= 0.0;
        const glm::dvec2 device(clip.x() / clip.w(), clip.y() / clip.w());
        r.screen.min = glm::min(r.screen.min, device);
        r.screen.max = glm::max(r.screen.max, device);
    }
    if (behind) r.screen = {glm::dvec2(-infinity), glm::dvec2(infinity)};
    return r;
}

std::optional<ForeignLeaf> ForeignLeaf::examine(osgUtil::RenderLeaf& leaf,
                                                const osg::Matrixd& projection)
{
    if (!leaf._modelview || !leaf._projection || !leaf.getDrawable()) return std::nullopt;
    const osg::BoundingBox& bounds = leaf.getDrawable()->getBoundingBox();
    if (!bounds.valid() || !sameRays(usualProjection(leaf), projection)) return std::nullopt;
    // A leaf that is drawn to other viewports does not lie where its matrices put it.
    if (effectiveAttribute(leaf._parent, StateAttribute::VIEWPORTINDEXED)) return std::nullopt;
    // Depth that grows towards the eye orders nothing of ours.
    const osg::Depth* test = effectiveDepth(leaf._parent);
    if (test &&
        (test->getFunction() == osg::Depth::GREATER || test->getFunction() == osg::Depth::GEQUAL))
        return std::nullopt;
    ForeignLeaf result(leaf);
    result._view = boxInView(bounds, *leaf._modelview, usualProjection(leaf));
    core::DepthInterval& depth = result._view.depth;
    // Bounds are rounded to float: what is flat and parallel to the view still has a range.
    const double slack = 1e-6 * std::max(std::abs(depth.nearDepth), std::abs(depth.farDepth)) +
                         1e-6 * bounds.radius();
    depth.nearDepth -= slack;
    depth.farDepth += slack;
    if (!std::isfinite(depth.nearDepth) || !std::isfinite(depth.farDepth)) return std::nullopt;
    return result;
}

osgUtil::RenderLeaf* ForeignLeaf::copy(osg::StateSet& state) const
{
    osg::ref_ptr<osgUtil::RenderLeaf> leaf = new osgUtil::RenderLeaf(
        const_cast<osg::Drawable*>(_leaf->getDrawable()), _leaf->_projection, _leaf->_modelview,
        _leaf->_depth, _leaf->_traversalOrderNumber);
    _leaf->_parent->find_or_insert(&state)->addLeaf(leaf);
    return leaf.get();
}

osgUtil::RenderLeaf* ForeignLeaf::piece(const core::DepthInterval& interval, bool depthOnly,
                                        osg::Drawable* drawable) const
{
    const osg::Matrixd p = usualProjection(*_leaf);
    const double zNear =
        std::isfinite(interval.nearDepth) ? std::max(-1.0, deviceZ(p, interval.nearDepth)) : -1.0;
    const double zFar =
        std::isfinite(interval.farDepth) ? std::min(1.0, deviceZ(p, interval.farDepth)) : 1.0;
    if (!(zNear < zFar)) return nullptr;
    const glm::dmat4 fromUsual = glm::inverse(toUsualClip(_leaf->_parent));
    osg::ref_ptr<osg::RefMatrix> projection =
        new osg::RefMatrix(toOsg(fromUsual * toGlm(cutProjection(p, zNear, zFar))));

    const osg::Depth* depth = effectiveDepth(_leaf->_parent);
    // Segments are split at true depths, whatever range the leaf draws to.
    const bool ownRange = depth && !depthOnly;
    const double rangeNear = ownRange ? depth->getZNear() : 0.0;
    const double rangeFar = ownRange ? depth->getZFar() : 1.0;
    const auto window = [&](double z) {
        return rangeNear + (rangeFar - rangeNear) * 0.5 * (z + 1.0);
    };
    osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
    const unsigned force =
        StateAttribute::ON | StateAttribute::OVERRIDE | StateAttribute::PROTECTED;
    const osg::Depth::Function function = depthOnly ? osg::Depth::LESS
                                          : depth   ? depth->getFunction()
                                                    : osg::Depth::LESS;
    osg::ref_ptr<osg::Depth> own = new osg::Depth(function, window(zNear), window(zFar),
                                                  depthOnly || !depth || depth->getWriteMask());
    if (depthOnly) {
        set->setAttributeAndModes(own, force);
        set->setAttribute(new osg::ColorMask(false, false, false, false), force);
    } else {
        set->setAttribute(own, force); // whether there is a depth test at all stays as it was
    }
    osg::ref_ptr<osgUtil::RenderLeaf> copy = new osgUtil::RenderLeaf(
        drawable ? drawable : const_cast<osg::Drawable*>(_leaf->getDrawable()), projection,
        _leaf->_modelview, _leaf->_depth, _leaf->_traversalOrderNumber);
    _leaf->_parent->find_or_insert(set)->addLeaf(copy);
    return copy.get();
}

} // namespace render
} // namespace osgVolumizer
