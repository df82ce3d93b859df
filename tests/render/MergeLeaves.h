#pragma once

#include <osg/Node>

#include <glm/vec4.hpp>

#include <vector>

namespace osgVolumizer {
namespace test {

/// A way to put something translucent into the plane z = 0, within 0 <= x, y <= 32.
struct LeafKind
{
    const char* name;
    osg::ref_ptr<osg::Node> (*make)();
    /// What the leaf's blend function makes of its picture on nothing and of what is behind
    /// (premultiplied).
    glm::vec4 (*blend)(const glm::vec4& leaf, const glm::vec4& behind);
    bool light = false;
};

inline glm::vec4 blendOver(const glm::vec4& leaf, const glm::vec4& behind)
{
    return leaf + (1.0f - leaf.a) * behind;
}

const std::vector<LeafKind>& leafKinds();

} // namespace test
} // namespace osgVolumizer
