#pragma once

#include "../support/FrameRenderer.h"
#include "MeshScene.h"

#include <osgVolumizer/core/Status.h>

#include <memory>

namespace osgVolumizer {
namespace bench {

/// One way to draw a MeshScene.
class MeshRenderer : public FrameRenderer
{
public:
    /// Makes everything that does not depend on the view. Not ok: this renderer cannot draw it.
    virtual Status open(const MeshScene& scene) = 0;
    /// What frame() draws from now on. Not timed, so that it only says so.
    virtual void setView(const support::RenderOptions& view) = 0;
};

using MeshRendererPtr = std::unique_ptr<MeshRenderer>;

MeshRendererPtr makeLibraryMeshRenderer();

/// By the name of the command line; null for an unknown one.
MeshRendererPtr makeMeshRenderer(const std::string& name);

} // namespace bench
} // namespace osgVolumizer
