#pragma once

#include <osg/ClipPlane>
#include <osg/Depth>
#include <osg/StateSet>
#include <osgUtil/RenderLeaf>
#include <osgUtil/StateGraph>

#include <glm/mat4x4.hpp>

#include <optional>
#include <vector>

namespace osgVolumizer {
namespace render {

/// What OSG applies for a graph of state sets, from the root down.

/// The attribute of a type: the last one on the way down that no override stops. Null where none is
/// set.
const osg::StateAttribute* effectiveAttribute(const osgUtil::StateGraph* graph,
                                              osg::StateAttribute::Type type, unsigned member = 0);
template <class Attribute>
const Attribute* effective(const osgUtil::StateGraph* graph, osg::StateAttribute::Type type)
{
    return static_cast<const Attribute*>(effectiveAttribute(graph, type));
}

/// The clip planes of state sets, likewise: of each number the one that counts, whose mode may be
/// off.
std::vector<const osg::ClipPlane*> effectiveClipPlanes(const osgUtil::StateGraph* graph);

/// Likewise for a mode.
bool isOn(const osgUtil::StateGraph* graph, GLenum mode, bool byDefault);

/// Whether the depth test is on, as OSG has it by default.
inline bool isDepthTested(const osgUtil::StateGraph* graph)
{
    return isOn(graph, GL_DEPTH_TEST, true);
}

/// Whether an osg::PolygonMode shows lines or points of what is drawn in a graph.
bool showsOutlines(const osgUtil::StateGraph* graph);

/// Whether what is drawn in a graph may change the depth buffer.
bool writesDepth(const osgUtil::StateGraph* graph);

/// Whether all channels of the first colour buffer are written.
bool writesAllChannels(const osgUtil::StateGraph* graph);

/// How fragments are tested against the depth of what was drawn before.
struct DepthTest
{
    osg::Depth::Function function = osg::Depth::LEQUAL; ///< ALWAYS where there is no test
    double zNear = 0.0, zFar = 1.0;                     ///< window depths of the clip planes

    bool isUsual() const
    {
        return (function == osg::Depth::LEQUAL || function == osg::Depth::LESS) && zNear == 0.0 &&
               zFar == 1.0;
    }
    /// Whether what lies nearer passes; if not, what lies farther.
    bool nearerPasses() const
    {
        return (function == osg::Depth::LEQUAL || function == osg::Depth::LESS) == (zNear <= zFar);
    }
};

/// osg::Fog without coordinates of its own: what a colour's share is at a depth.
struct FogAbove
{
    glm::vec3 color{0.0f};
    bool linear = false;
    glm::vec3 rates{0.0f}; ///< of depth to the powers 0, 1, 2; linear: the share; else its -log2

    float share(double depth) const;
};

/// The state that volumes take from above them, as other geometry does.
struct StateAbove
{
    std::optional<FogAbove> fog;
    DepthTest depthTest;
    bool stencilTested = false, allChannels = true;
    bool partly = false; ///< scissor, stipple or discarding keep it off pixels
    glm::dmat4 toUsualClip{1.0};

    /// Whether it can make no difference which drawable leaves a fragment.
    bool isUsual() const { return depthTest.isUsual() && !stencilTested && allChannels && !partly; }
};
StateAbove stateAbove(const osgUtil::StateGraph* graph);

/// From the clip space that osg::ClipControl asks for to the usual one: y up, -w <= z <= w.
/// Column-major.
glm::dmat4 toUsualClip(const osgUtil::StateGraph* graph);
/// A leaf's projection to the usual clip space.
osg::Matrixd usualProjection(const osgUtil::RenderLeaf& leaf);

} // namespace render
} // namespace osgVolumizer
