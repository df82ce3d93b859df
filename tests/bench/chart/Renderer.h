#pragma once

#include "../support/FrameRenderer.h"
#include "Scenes.h"

#include <map>
#include <memory>

namespace osgVolumizer {
namespace bench {

/// One way to draw a ChartScene.
class Renderer : public FrameRenderer
{
public:
    /// Makes everything that does not depend on the step. Not ok: this renderer cannot draw it.
    virtual Status open(const ChartScene& scene) = 0;
    /// Distance between samples along the view, in voxels. Not ok: it cannot draw at this one.
    virtual Status setStep(double stepVoxel) = 0;
    /// As finely as its own pictures are judged by, where no other renderer shades as it does.
    virtual Status setFinest() { return setStep(1.0 / 16.0); }
    /// Where the time of the last frame went, milliseconds by name; empty where that is not known.
    virtual std::map<std::string, double> split() { return {}; }
};

using RendererPtr = std::unique_ptr<Renderer>;

struct LibraryOptions
{
    bool slabs = true; ///< else slices
    /// Largest brick, samples per axis; 0: the library's default, which is one brick for all scenes
    /// here.
    int brickSize = 0;
    bool joined = true; ///< bricks may share a texture
    /// What setStep() sets is not a step but the error asked for, in thousandths.
    bool tolerance = false;
    bool cells = false; ///< lookup is cell by cell
};
RendererPtr makeLibraryRenderer(const LibraryOptions& options);
/// A fragment shader that marches through the box in one pass, without a scene graph: the
/// practical limit. With the colour at the middle of each step, or (better for tables with sharp
/// features) the mean of the table over the values that a step passes.
RendererPtr makeBareRenderer(bool integral = false);

enum class OsgVolumeTechnique
{
    FIXED_FUNCTION,
    RAY_TRACED,
    MULTIPASS
};
RendererPtr makeOsgVolumeRenderer(OsgVolumeTechnique technique);

/// VolPack, and OpenVDB's VolumeRender; only where their libraries were found.
RendererPtr makeVolPackRenderer();
RendererPtr makeOpenVdbRenderer();

/// By the name of the command line; null for an unknown one.
RendererPtr makeRenderer(const std::string& name);

} // namespace bench
} // namespace osgVolumizer
