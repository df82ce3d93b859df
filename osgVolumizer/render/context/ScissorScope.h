#pragma once

#include <osg/GL>

#include <glm/vec4.hpp>

#include <algorithm>

namespace osgVolumizer {
namespace render {

/// Narrows the scissor rectangle for a while, and puts back what it found, so that OSG's idea of
/// the state stays true.
class ScissorScope
{
public:
    ScissorScope() : _enabled(glIsEnabled(GL_SCISSOR_TEST))
    {
        glGetIntegerv(GL_SCISSOR_BOX, &_box[0]);
        glEnable(GL_SCISSOR_TEST);
    }
    ScissorScope(const ScissorScope&) = delete;
    ScissorScope& operator=(const ScissorScope&) = delete;
    ~ScissorScope()
    {
        glScissor(_box[0], _box[1], _box[2], _box[3]);
        if (!_enabled) glDisable(GL_SCISSOR_TEST);
    }

    /// To the part of a rectangle (x, y, width, height) that could be drawn to before; false if
    /// none.
    bool set(const glm::ivec4& r) const
    {
        glm::ivec4 box = r;
        if (_enabled) {
            const int x0 = std::max(r[0], _box[0]), y0 = std::max(r[1], _box[1]);
            const int x1 = std::min(r[0] + r[2], _box[0] + _box[2]);
            const int y1 = std::min(r[1] + r[3], _box[1] + _box[3]);
            box = {x0, y0, x1 - x0, y1 - y0};
        }
        if (box[2] <= 0 || box[3] <= 0) return false;
        glScissor(box[0], box[1], box[2], box[3]);
        return true;
    }

private:
    const GLboolean _enabled;
    GLint _box[4] = {0, 0, 0, 0};
};

} // namespace render
} // namespace osgVolumizer
