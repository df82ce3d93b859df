#pragma once

#include "../context/ContextResources.h"
#include "../context/TargetBuffers.h"
#include "TargetScope.h"

#include <osg/Program>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

namespace osgVolumizer {
namespace render {

class Uniforms;

/// What coarse images are drawn into. One a context.
struct CoarseBuffers : ContextPart
{
    FloatTarget target;
    osg::ref_ptr<osg::Program> program; ///< fills pixels

    void release(osg::GLExtensions& gl) override;
};

/// A part of a volume with fewer rays than pixels, for views that move: drawn to a smaller image,
/// from which the pixels are filled. Filling is linear between rays that end at about the same
/// opaque depth, so that edges of opaque geometry stay where they are. Between construction and
/// destruction nothing but the volume may be drawn. In the draw thread, within one drawable.
class CoarseImage
{
public:
    /// \param viewport of the window: x, y, width, height \param distance pixels between rays, >= 1
    CoarseImage(osg::State& state, ContextResources& resources, const glm::dvec4& viewport,
                double distance);
    ~CoarseImage();
    CoarseImage(const CoarseImage&) = delete;
    CoarseImage& operator=(const CoarseImage&) = delete;

    /// False where the card has no memory for it.
    bool made() const { return _made; }
    /// Of the image, for its rays.
    glm::dvec4 viewport() const { return {0.0, 0.0, double(_size.x), double(_size.y)}; }

    /// Starts with an empty image of a window rectangle; false where nothing of it may be drawn.
    /// Tells the volume's program what it needs.
    bool begin(const Uniforms& uniforms, const glm::ivec4& rectangle);
    /// Draws the image over the target; not while a mesh is bound.
    void end();

private:
    osg::State& _state;
    ContextResources& _resources;
    TargetScope _scope;
    glm::dvec4 _window;       ///< viewport
    glm::ivec2 _size;         ///< of the image
    glm::vec4 _toWindow;      ///< scale, offset: image -> window coordinates
    glm::ivec4 _rectangle{0}; ///< window; that is being drawn
    glm::ivec4 _texels{0};    ///< of the image: first and last, that belong to it
    GLint _viewport[4] = {}, _scissor[4] = {};
    GLboolean _scissored;
    bool _made = false;
};

/// Tells a volume's program of a window that has one ray for each pixel.
void setOneRayPerPixel(const Uniforms& uniforms, const glm::dvec4& viewport);

} // namespace render
} // namespace osgVolumizer
