#pragma once

#include "../context/AttributeScope.h"
#include "../context/ContextResources.h"
#include "BatchDrawing.h"
#include "VolumePart.h"

#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

/// Draws a part by a compute shader over the pixels that it covers, where that is the faster march
/// of the context (see marchOf()) and nothing but the shader decides what is drawn: into the
/// target, one march a pixel, under the usual state. The same code as that of fragments, so that
/// the picture is the same.
class ComputeMarch
{
public:
    /// Makes the compute program the one in force, if it is to be used. In the draw thread.
    /// \param coarse whether there are fewer rays than pixels
    ComputeMarch(osg::State& state, ContextResources& resources, const VolumePart& part,
                 const VolumeMesh& mesh, bool coarse);
    /// Puts back the program that was in force.
    ~ComputeMarch() { leave(); }
    ComputeMarch(const ComputeMarch&) = delete;
    ComputeMarch& operator=(const ComputeMarch&) = delete;

    bool isUsed() const { return _before != nullptr; }
    /// Back to fragments.
    void leave() { _before.reset(); }
    /// Marches with the uniforms set; false, with nothing drawn, where the texels cannot be had.
    bool draw(const BatchDrawing& drawing);

private:
    std::vector<glm::ivec4> areas() const;

    osg::State& _state;
    ContextResources& _resources;
    const VolumePart& _part;
    const VolumeMesh& _mesh;
    glm::ivec4 _viewport{0}; // window pixels: x, y, width, height
    glm::vec2 _slab{0.0f};   // nearest and farthest depth, from the reference depth
    std::unique_ptr<AttributeScope> _before;
};

} // namespace render
} // namespace osgVolumizer
