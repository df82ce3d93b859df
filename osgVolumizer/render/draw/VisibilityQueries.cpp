#include "VisibilityQueries.h"

namespace osgVolumizer {
namespace render {

namespace {

// Of OpenGL 1.5 on; that a sample passed is all that is asked for, but the count is what every
// context tells.
constexpr GLenum QUERY = 0x8914;     // GL_SAMPLES_PASSED
constexpr GLenum RESULT = 0x8866;    // GL_QUERY_RESULT
constexpr GLenum AVAILABLE = 0x8867; // GL_QUERY_RESULT_AVAILABLE
constexpr std::size_t MOST = 16384;  // that are open

} // namespace

void VisibilityQueries::begin(osg::State& state, const std::shared_ptr<VisibilityTest>& test,
                              std::int64_t page)
{
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    if (!gl.isARBOcclusionQuerySupported) return;
    if (!_open.empty()) fetch(gl, test->frame());
    if (_open.size() >= MOST) return;
    if (_free.empty()) {
        GLuint name = 0;
        gl.glGenQueries(1, &name);
        if (!name) return;
        _free.push_back(name);
    }
    _open.push_back({_free.back(), test, page});
    _free.pop_back();
    ++test->open;
    gl.glBeginQuery(QUERY, _open.back().name);
    _begun = true;
}

void VisibilityQueries::end(osg::State& state)
{
    if (_begun) state.get<osg::GLExtensions>()->glEndQuery(QUERY);
    _begun = false;
}

// Of frames before the last one: those have been drawn, and asking does not make a software
// rasteriser finish in the middle of a frame. Queries end in order.
void VisibilityQueries::fetch(osg::GLExtensions& gl, unsigned frame)
{
    while (!_open.empty() && _open.front().test->frame() + 1 < frame) {
        GLuint value = 0;
        gl.glGetQueryObjectuiv(_open.front().name, AVAILABLE, &value);
        if (!value) return;
        gl.glGetQueryObjectuiv(_open.front().name, RESULT, &value);
        const Open answered = _open.front();
        _open.pop_front();
        _free.push_back(answered.name);
        answered.test->add(answered.page, value > 0);
        if (--answered.test->open == 0) answered.test->close();
    }
}

void VisibilityQueries::release(osg::GLExtensions& gl)
{
    for (const Open& open : _open)
        _free.push_back(open.name);
    if (!_free.empty()) gl.glDeleteQueries(static_cast<GLsizei>(_free.size()), _free.data());
    _free.clear();
    _open.clear();
}

} // namespace render
} // namespace osgVolumizer
