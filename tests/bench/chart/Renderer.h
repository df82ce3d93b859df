#pragma once

#include "Scenes.h"

#include <memory>

namespace osgVolumizer {
namespace bench {

/// One way to draw a ChartScene. All draw to a 32-bit float target unless stated, into contexts of
/// their own, and nothing of what comes before frame() is timed.
class Renderer
{
public:
    virtual ~Renderer() = default;

    /// Identifies the curve.
    virtual std::string name() const = 0;
    /// Makes everything that does not depend on the step. Not ok: this renderer cannot draw it.
    virtual Status open(const ChartScene& scene) = 0;
    /// Distance between samples along the view, in voxels.
    virtual Status setStep(double stepVoxel) = 0;
    /// Draws one frame, to the end of glFinish.
    virtual void frame() = 0;
    /// Reads back what the last frame drew: premultiplied, bottom row first.
    virtual support::FloatImage picture() = 0;
};

using RendererPtr = std::unique_ptr<Renderer>;

RendererPtr makeLibraryRenderer(bool slabs);
/// A fragment shader that marches through the box in one pass, without a scene graph: the
/// practical limit. `variant` names a set of #defines of march.frag.glsl, "" the best known.
RendererPtr makeBareRenderer(const std::string& variant = "");

enum class OsgVolumeTechnique { FIXED_FUNCTION, RAY_TRACED, MULTIPASS };
RendererPtr makeOsgVolumeRenderer(OsgVolumeTechnique technique);

} // namespace bench
} // namespace osgVolumizer
