#include "VolumeDrawable.h"

#include "../../Error.h"
#include "../context/ForeignState.h"
#include "../context/Framebuffer.h"
#include "../context/Matrices.h"
#include "../context/ProgramInterface.h"
#include "../context/ReportOnce.h"
#include "../context/ScissorScope.h"
#include "../context/Statistics.h"
#include "BatchDrawing.h"
#include "BoundMesh.h"
#include "CoarseImage.h"
#include "RayTarget.h"
#include "SubstituteProgram.h"
#include "VolumeUniforms.h"

#include "../../core/sampling/View.h"

#include <optional>

namespace osgVolumizer {
namespace render {

namespace {

glm::dvec4 currentViewport()
{
    GLfloat v[4];
    glGetFloatv(GL_VIEWPORT, v); // which more than one attribute of OSG can set
    return {v[0], v[1], v[2], v[3]};
}

void drawBatches(const BatchDrawing& drawing, const VolumeMesh& mesh)
{
    for (const BrickBatch& batch : mesh.batches)
        drawBatch(drawing, batch);
}

void drawRectangles(const BatchDrawing& drawing, ContextResources& resources,
                    const VolumeMesh& mesh, const VolumePart& part)
{
    const BoundMesh bound(*drawing.renderInfo.getState(), resources, mesh,
                          static_cast<float>(part.step));
    if (part.scissors.empty()) return drawBatches(drawing, mesh);
    const ScissorScope scissor;
    for (const glm::ivec4& rectangle : part.scissors)
        if (scissor.set(rectangle)) drawBatches(drawing, mesh);
}

// Gathered values hide nothing, so they need no order, and no parts.
void gather(const BatchDrawing& drawing, ContextResources& resources, const VolumeMesh& mesh,
            const VolumePart& part)
{
    const osg::Depth::Function test = part.above.depthTest.function;
    if (test == osg::Depth::NEVER || test == osg::Depth::EQUAL) return;
    RayTarget target(*drawing.renderInfo.getState(), resources, part.features,
                     glm::ivec4(currentViewport()));
    if (!target.made()) return;
    drawRectangles(drawing, resources, mesh, part);
    target.resolve(*part.look);
}

void drawCoarse(CoarseImage& image, const glm::ivec4& viewport, const BatchDrawing& drawing,
                ContextResources& resources, const VolumeMesh& mesh, const VolumePart& part)
{
    std::vector<glm::ivec4> rectangles = part.scissors;
    if (rectangles.empty()) rectangles.push_back(viewport);
    for (const glm::ivec4& rectangle : rectangles) {
        if (!image.begin(drawing.uniforms, rectangle)) continue;
        {
            const BoundMesh bound(*drawing.renderInfo.getState(), resources, mesh,
                                  static_cast<float>(part.step));
            drawBatches(drawing, mesh);
        }
        image.end();
    }
}

} // namespace

VolumeDrawable::VolumeDrawable()
{
    setSupportsDisplayList(false);
    setUseDisplayList(false);
    setUseVertexBufferObjects(false);
    setDataVariance(osg::Object::STATIC);
}

void VolumeDrawable::drawImplementation(osg::RenderInfo& renderInfo) const
{
    osg::State& state = *renderInfo.getState();
    const std::shared_ptr<ContextResources> resources = contextResources(state);
    const Status supported = resources->limits.check();
    reportOnce(supported);
    if (!supported || !_mesh || !_part || _mesh->batches.empty()) return;
    const AccumulationBuffers& buffers = resources->part<AccumulationBuffers>();
    if (buffers.drawBuffers.empty() || buffers.drawBuffers.front() == GL_NONE) return;
    const VolumeLook& look = *_part->look;
    const SubstituteProgram substitute(state, buffers, _part->features);
    const auto* program = state.getLastAppliedProgramObject();
    if (!substitute.isDrawn(*_part) || !program) return;
    const core::View view{toGlm(state.getModelViewMatrix()), toGlm(state.getProjectionMatrix())};
    const glm::dvec4 viewport = currentViewport();
    std::optional<CoarseImage> image;
    if (_part->features.coarse) image.emplace(state, *resources, viewport, _part->rayDistance);
    if (image && !image->made()) image.reset();
    const Result<PixelRays> rays =
        pixelRays(view.toEye, _part->above.toUsualClip * view.projection,
                  image ? image->viewport() : viewport, look.referenceDepth, look.center);
    if (!rays) {
        reportError(rays.status);
        return;
    }
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const FirstDrawBufferScope first(gl, buffers.drawBuffers);
    const ForeignStateScope foreign(state, true);
    const Uniforms uniforms(gl, *program);
    // Meshes for captured surfaces are in device coordinates.
    const bool inDevice = _part->features.slotCount > 0;
    uniforms.set("frameToClip", inDevice ? glm::dmat4(1.0) : view.projection * view.toEye);
    setUniforms(state, uniforms, *_part, *rays, view.toEye, buffers);
    if (look.table.texture && !applyTable(state, look.table.texture.get(), UNIT_TABLE)) return;
    if (_part->paints)
        setPaints(renderInfo, resources->limits, uniforms, *_part->paints, UNIT_FIRST_PAINT);
    const BatchDrawing drawing{renderInfo, resources->limits, uniforms, _part->features, view};
    if (_part->features.coarse) setOneRayPerPixel(uniforms, viewport);
    if (image)
        drawCoarse(*image, glm::ivec4(viewport), drawing, *resources, *_mesh, *_part);
    else if (_part->features.gathers())
        gather(drawing, *resources, *_mesh, *_part);
    else
        drawRectangles(drawing, *resources, *_mesh, *_part);
    count(renderInfo.getCurrentCamera(), state.getFrameStamp(), "osgVolumizer draw calls",
          static_cast<double>(_mesh->batches.size()));
    reapplyInNextFrame(state);
    // OSG compares attributes by address: make it bind its own again whatever ours were.
    for (unsigned unit : {UNIT_VOXELS, UNIT_TABLE, UNIT_OPAQUE_DEPTH, UNIT_SPLIT_DEPTH,
                          UNIT_SORTED_FAR, UNIT_SORTED_NEAR, UNIT_CELLS})
        state.haveAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE);
}

} // namespace render
} // namespace osgVolumizer
