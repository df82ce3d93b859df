#pragma once

#include <osg/GL>

#include <glm/vec4.hpp>

#include <algorithm>

namespace osgVolumizer {
namespace render {

/// What two rectangles (x, y, width, height) share; width or height is not positive where that is
/// nothing.
inline glm::ivec4 intersection(const glm::ivec4& a, const glm::ivec4& b)
{
    const int x = std::max(a[0], b[0]), y = std::max(a[1], b[1]);
    return {x, y, std::min(a[0] + a[2], b[0] + b[2]) - x, std::min(a[1] + a[3], b[1] + b[3]) - y};
}

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
        const glm::ivec4 box = _enabled ? intersection(r, {_box[0], _box[1], _box[2], _box[3]}) : r;
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
