#pragma once

#include <support/FloatImage.h>

#include <string>

namespace osgVolumizer {
namespace bench {

/// One way to draw a scene. All draw to a 32-bit float target unless stated, into contexts of their
/// own, and nothing of what comes before frame() is timed.
class FrameRenderer
{
public:
    virtual ~FrameRenderer() = default;

    /// Identifies the curve.
    virtual std::string name() const = 0;
    /// Draws one frame, to the end of glFinish.
    virtual void frame() = 0;
    /// Reads back what the last frame drew: premultiplied, bottom row first.
    virtual support::FloatImage picture() = 0;
};

} // namespace bench
} // namespace osgVolumizer
