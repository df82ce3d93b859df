#include "VolumeDrawable.h"

#include "../../Error.h"
#include "../context/ContextRefusals.h"
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
#include "ComputeMarch.h"
#include "FusedDrawing.h"
#include "RayTarget.h"
#include "SubstituteProgram.h"
#include "VolumeUniforms.h"

#include "../../core/sampling/View.h"

#include <functional>
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

// Calls `draw` for each rectangle of a part, with a mesh bound.
void drawRectangles(osg::State& state, ContextResources& resources, const VolumeMesh& mesh,
                    const VolumePart& part, const std::function<void()>& draw)
{
    const BoundMesh bound(state, resources, mesh, static_cast<float>(part.step));
    if (part.scissors.empty()) return draw();
    const ScissorScope scissor;
    for (const glm::ivec4& rectangle : part.scissors)
        if (scissor.set(rectangle)) draw();
}

void drawRectangles(const BatchDrawing& drawing, ContextResources& resources,
                    const VolumeMesh& mesh, const VolumePart& part)
{
    drawRectangles(*drawing.renderInfo.getState(), resources, mesh, part,
                   [&]() { drawBatches(drawing, mesh); });
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

// Whether several volumes can be marched together by a program; if not, the next frames do without.
bool canMarch(const FusedDrawing& drawing, const osg::Program::PerContextProgram* program)
{
    if (program && setMembers(drawing, *program)) return true;
    refuse(drawing.renderInfo.getContextID(), Refusal::FUSED_VOLUMES);
    reportOnce({ErrorCode::NOT_SUPPORTED,
                "the context lacks texture units, memory or a compiler for volumes that overlap to "
                "be marched together; they are drawn in thin slabs, which takes longer"});
    return false;
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
    const SubstituteProgram substitute(state, buffers, *_part);
    const auto* program = state.getLastAppliedProgramObject();
    if (!substitute.isDrawn(*_part) || (!program && !_part->fused)) return;
    const core::View view{toGlm(state.getModelViewMatrix()), toGlm(state.getProjectionMatrix())};
    const glm::dvec4 viewport = currentViewport();
    std::optional<CoarseImage> image;
    if (_part->features.coarse) image.emplace(state, *resources, viewport, _part->rayDistance);
    if (image && !image->made()) image.reset();
    ComputeMarch compute(state, *resources, *_part, *_mesh, image.has_value());
    if (compute.isUsed()) program = state.getLastAppliedProgramObject();
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
    FusedDrawing fused{renderInfo, *resources, *_part, _part->above.toUsualClip * view.projection,
                       image ? image->viewport() : viewport};
    if (_part->fused && !canMarch(fused, program)) {
        image.reset();
        compute.leave();
        fused.viewport = viewport;
        drawRectangles(state, *resources, *_mesh, *_part,
                       [&]() { drawMembersApart(fused, _mesh->batches.front()); });
    } else {
        drawMarched(renderInfo, *program, *rays, view, image, compute);
    }
    count(renderInfo.getCurrentCamera(), state.getFrameStamp(), "osgVolumizer draw calls",
          static_cast<double>(_mesh->batches.size()));
    reapplyInNextFrame(state);
    // OSG compares attributes by address: make it bind its own again whatever ours were.
    for (unsigned unit = 0; unit < UNIT_COUNT; ++unit)
        state.haveAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE);
}

void VolumeDrawable::drawMarched(osg::RenderInfo& renderInfo,
                                 const osg::Program::PerContextProgram& program,
                                 const PixelRays& rays, const core::View& view,
                                 std::optional<CoarseImage>& image, ComputeMarch& compute) const
{
    osg::State& state = *renderInfo.getState();
    const std::shared_ptr<ContextResources> resources = contextResources(state);
    const VolumeLook& look = *_part->look;
    const Uniforms uniforms(*state.get<osg::GLExtensions>(), program);
    // Meshes of a triangle over all pixels are in device coordinates.
    const bool inDevice = _part->features.slotCount > 0 || _part->fused;
    uniforms.set("frameToClip", inDevice ? glm::dmat4(1.0) : view.projection * view.toEye);
    setSamplers(uniforms);
    setUniforms(state, uniforms, *_part, rays, view.toEye, resources->part<AccumulationBuffers>());
    if (look.table.texture && !applyTable(state, look.table.texture.get(), UNIT_TABLE)) return;
    if (_part->features.cutField) {
        const unsigned unit = cutUnitOf(_part->features);
        if (!applyCutField(state, look.cut, unit)) return;
        uniforms.set("cutField", static_cast<int>(unit));
    }
    if (_part->features.tetrahedra &&
        !setTetrahedra(state, uniforms, look, tetraUnitOf(_part->features)))
        return;
    if (_part->paints)
        setPaints(renderInfo, resources->limits, uniforms, *_part->paints, UNIT_FIRST_PAINT);
    BatchDrawing drawing{renderInfo, resources->limits, uniforms, _part->features, view};
    const AccumulationBuffers& buffers = resources->part<AccumulationBuffers>();
    if (_part->features.slab && buffers.hasOpaqueDepth) drawing.tests = resources.get();
    if (_part->features.coarse) setOneRayPerPixel(uniforms, currentViewport());
    if (compute.isUsed()) {
        if (compute.draw(drawing))
            return count(renderInfo.getCurrentCamera(), state.getFrameStamp(),
                         "osgVolumizer compute marches", 1.0);
        compute.leave();
        const auto* fragments = state.getLastAppliedProgramObject();
        if (fragments) drawMarched(renderInfo, *fragments, rays, view, image, compute);
        return;
    }
    if (image)
        drawCoarse(*image, glm::ivec4(currentViewport()), drawing, *resources, *_mesh, *_part);
    else if (_part->features.gathers())
        gather(drawing, *resources, *_mesh, *_part);
    else
        drawRectangles(drawing, *resources, *_mesh, *_part);
}

} // namespace render
} // namespace osgVolumizer
