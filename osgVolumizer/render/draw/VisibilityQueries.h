#pragma once

#include "../context/ContextResources.h"
#include "../textures/VisibilityTest.h"

#include <deque>
#include <memory>
#include <vector>

namespace osgVolumizer {
namespace render {

/// The occlusion queries of one context: each asks whether any fragment of a page's is drawn.
/// Answers are fetched once they are there, some frames later; nothing waits for them.
class VisibilityQueries : public ContextPart
{
public:
    /// Begins a query, if the context has them; what is drawn until end() counts.
    void begin(osg::State& state, const std::shared_ptr<VisibilityTest>& test, std::int64_t page);
    void end(osg::State& state);

    void release(osg::GLExtensions& gl) override;

private:
    struct Open
    {
        GLuint name = 0;
        std::shared_ptr<VisibilityTest> test;
        std::int64_t page = 0;
    };

    void fetch(osg::GLExtensions& gl, unsigned frame);

    std::vector<GLuint> _free;
    std::deque<Open> _open; ///< oldest first
    bool _begun = false;
};

} // namespace render
} // namespace osgVolumizer
