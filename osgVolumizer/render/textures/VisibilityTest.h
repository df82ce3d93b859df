#pragma once

#include <osg/Matrixd>

#include <glm/vec4.hpp>

#include <atomic>
#include <cstdint>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace render {

/// Which pages of a view any ray of one frame met in front of opaque geometry, as the context found
/// out while it drew them. Written by the draw thread, read by the cull of later frames.
class VisibilityTest
{
public:
    enum Answer
    {
        UNKNOWN, ///< not drawn, or not as what it was chosen for
        HIDDEN,
        VISIBLE
    };

    /// \param toClip where the volume is in the view \param exact a ray for each pixel
    /// \param planes that cut the volume \param cutId of its core::Cut
    VisibilityTest(unsigned frame, const osg::Matrixd& toClip, bool exact,
                   std::vector<glm::vec4> planes, unsigned cutId)
        : _frame(frame), _toClip(toClip), _exact(exact), _planes(std::move(planes)), _cutId(cutId)
    {
    }
    unsigned frame() const { return _frame; }
    const osg::Matrixd& toClip() const { return _toClip; }
    bool isExact() const { return _exact; }
    bool isCutBy(const std::vector<glm::vec4>& planes, unsigned cutId) const
    {
        return _planes == planes && _cutId == cutId;
    }

    /// Tells that the frame had opaque geometry, before which nothing is found out.
    void setOpaque() { _opaque = true; }
    bool hadOpaque() const { return _opaque; }
    /// An answer; of several, where a page is drawn in parts, being visible counts.
    void add(std::int64_t page, bool visible)
    {
        std::lock_guard<std::mutex> lock(_mutex);
        bool& known = _visible[page];
        known = known || visible;
    }
    /// Tells that all answers are there.
    void close() { _closed = true; }
    bool isClosed() const { return _closed; }
    Answer answer(std::int64_t page) const
    {
        std::lock_guard<std::mutex> lock(_mutex);
        const auto found = _visible.find(page);
        return found == _visible.end() ? UNKNOWN : found->second ? VISIBLE : HIDDEN;
    }

    int open = 0; ///< answers that are awaited; of the draw thread

private:
    const unsigned _frame;
    const osg::Matrixd _toClip;
    const bool _exact;
    const std::vector<glm::vec4> _planes;
    const unsigned _cutId;
    std::atomic<bool> _opaque{false}, _closed{false};
    mutable std::mutex _mutex; ///< of what follows
    std::map<std::int64_t, bool> _visible;
};

} // namespace render
} // namespace osgVolumizer
