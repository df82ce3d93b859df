#include "VolumeDrawable.h"

#include "../../Error.h"
#include "../context/ContextResources.h"
#include "../context/ForeignState.h"
#include "../context/Framebuffer.h"
#include "../context/Matrices.h"
#include "../context/ProgramInterface.h"
#include "../context/ReportOnce.h"
#include "../context/ScissorScope.h"
#include "../context/Statistics.h"
#include "../context/Uniforms.h"
#include "BatchDrawing.h"
#include "PixelRays.h"
#include "RayTarget.h"
#include "VolumeProgram.h"

#include "../../core/sampling/View.h"

#include <osg/Program>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <cmath>
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

void setTable(const Uniforms& uniforms, const VolumeLook& look)
{
    uniforms.set("valueToEntry", look.valueToEntry);
    uniforms.set("lastEntry", static_cast<float>(look.table.count - 1));
    if (!look.features.preIntegrated) return;
    uniforms.set("tableLow", look.table.low);
    uniforms.set("tableHigh", look.table.high);
}

// Normals are to be seen in the eye frame, and their length in ranges per opacity unit.
glm::dmat3 gradientToEye(const VolumeLook& look, const glm::dmat3& frameToEye)
{
    const double unitsToEye =
        std::cbrt(std::abs(glm::determinant(frameToEye) / glm::determinant(look.frameToUnits)));
    return glm::inverse(glm::transpose(frameToEye)) * (unitsToEye * look.texelToFraction);
}

void setShading(const Uniforms& uniforms, const VolumeLook& look, const PixelRays& rays,
                const glm::dmat4& frameToEye, const osg::State& state)
{
    const std::vector<EyeLight> lights = enabledLights(look.lights, state);
    std::vector<glm::vec4> positions, spots;
    std::vector<glm::vec3> ambients, diffuses, speculars, attenuations;
    std::vector<float> exponents;
    for (const EyeLight& light : lights) {
        positions.push_back(light.position);
        spots.push_back(light.spot);
        ambients.push_back(light.ambient);
        diffuses.push_back(light.diffuse);
        speculars.push_back(light.specular);
        attenuations.push_back(light.attenuation);
        exponents.push_back(light.spotExponent);
    }
    uniforms.set("lightCount", static_cast<int>(lights.size()));
    uniforms.set("lightPosition", positions);
    uniforms.set("lightSpot", spots);
    uniforms.set("lightAmbient", ambients);
    uniforms.set("lightDiffuse", diffuses);
    uniforms.set("lightSpecular", speculars);
    uniforms.set("lightAttenuation", attenuations);
    uniforms.set("lightSpotExponent", exponents);
    uniforms.set("material", look.material);
    uniforms.set("gradientToEye", gradientToEye(look, glm::dmat3(frameToEye)));
    uniforms.set("gradientDecode", look.gradientDecode);
    uniforms.set("rayOriginEye", rays.originEye);
    uniforms.set("rayDirectionEye", rays.directionEye);
    if (!look.features.slab) uniforms.set("frameToEye", frameToEye);
}

void setLook(const Uniforms& uniforms, const VolumeLook& look, const PixelRays& rays)
{
    uniforms.set("windowCenter", glm::vec2(rays.windowCenter));
    uniforms.set("rayOrigin", rays.origin);
    uniforms.set("rayDirection", rays.direction);
    uniforms.set("frameToUnits", look.frameToUnits);
    if (look.table.texture) setTable(uniforms, look);
    if (look.features.slab) {
        uniforms.set("stepsPerDepth", static_cast<float>(1.0 / look.step));
        uniforms.set("maximumSteps", static_cast<float>(look.maximumSteps));
        if (look.features.layerDepth) uniforms.set("inFrontOfLayer", look.inFrontOfLayer ? 1 : 0);
        if (look.features.ranked) uniforms.set("rank", look.rank);
        uniforms.set("regionMin", look.regionMin);
        uniforms.set("regionMax", look.regionMax);
        uniforms.set("planes", look.planes);
        uniforms.set("isoTexel", look.isoTexel);
    } else {
        uniforms.set("surfaceNormal", glm::vec3(look.surfaceNormal));
        if (look.features.spherical) uniforms.set("rayDirectionEye", rays.directionEye);
    }
}

// For the shader of slabs; a volume whose range is one depth lies just before that.
glm::vec2 depthRange(const DepthTest& test)
{
    if (test.zNear == test.zFar) return {static_cast<float>(test.zNear) - 1e-7f, 1e30f};
    return glm::vec2(test.zNear, 1.0 / (test.zFar - test.zNear));
}

void setDepthTextures(osg::State& state, const Uniforms& uniforms, const PixelRays& rays,
                      const VolumeLook& look, const ContextResources& resources)
{
    const ProgramFeatures& features = look.features;
    const AccumulationBuffers& buffers = resources.accumulation;
    const DepthTest& test = look.above.depthTest;
    const bool ends = buffers.hasOpaqueDepth && test.function != osg::Depth::ALWAYS &&
                      test.function != osg::Depth::NOTEQUAL;
    uniforms.set("opaqueRule", !ends ? 0 : test.nearerPasses() ? 1 : 2);
    uniforms.set("depthRange", depthRange(test));
    if (!buffers.opaqueDepth) return;
    state.applyTextureAttribute(UNIT_OPAQUE_DEPTH, buffers.opaqueDepth.get());
    if (features.layerDepth)
        state.applyTextureAttribute(UNIT_LAYER_DEPTH, buffers.layerDepth.get());
    if (features.ranked && buffers.layers.rankDepth) {
        state.applyTextureAttribute(UNIT_SORTED_FAR, buffers.layers.sorted[0].get());
        state.applyTextureAttribute(UNIT_SORTED_NEAR, buffers.layers.sorted[1].get());
    }
    if (features.slotCount > 0 && resources.capture.sorted) {
        state.applyTextureAttribute(UNIT_SORTED_FAR, resources.capture.sorted.get());
        state.applyTextureAttribute(UNIT_SORTED_NEAR, resources.capture.colors.get());
        uniforms.set("surfaceWeights", look.surfaceWeights);
    }
    uniforms.set("clipZOrigin", glm::vec3(rays.clipZOrigin));
    uniforms.set("clipZDirection", glm::vec3(rays.clipZDirection));
    uniforms.set("clipWOrigin", glm::vec3(rays.clipWOrigin));
    uniforms.set("clipWDirection", glm::vec3(rays.clipWDirection));
}

// Vertex attributes straight from our stream buffers, left disabled again for OSG.
class BoundMesh
{
public:
    BoundMesh(osg::State& state, osg::GLExtensions& gl, ContextResources& resources,
              const VolumeMesh& mesh, float spacing)
        : _state(state), _gl(gl)
    {
        state.lazyDisablingOfVertexAttributes();
        state.applyDisablingOfVertexAttributes();
        const std::vector<float>& vertices = mesh.vertexArray();
        const std::vector<unsigned>& indices = mesh.indexArray();
        resources.vertices.stream(gl, GL_ARRAY_BUFFER_ARB, vertices.data(),
                                  vertices.size() * sizeof(float));
        resources.indices.stream(gl, GL_ELEMENT_ARRAY_BUFFER_ARB, indices.data(),
                                 indices.size() * sizeof(unsigned));
        enable(ATTRIBUTE_POSITION, 3, mesh.positionOffset, mesh.stride);
        if (mesh.slabOffset >= 0) enable(ATTRIBUTE_SLAB, 2, mesh.slabOffset, mesh.stride);
        if (mesh.voxelCoordinateOffset >= 0)
            enable(ATTRIBUTE_VOXEL_COORDINATE, 3, mesh.voxelCoordinateOffset, mesh.stride);
        if (mesh.colorOffset >= 0)
            enable(ATTRIBUTE_COLOR, mesh.colorSize, mesh.colorOffset, mesh.stride);
        if (mesh.spacingOffset >= 0)
            enable(ATTRIBUTE_SPACING, 1, mesh.spacingOffset, mesh.stride);
        else
            gl.glVertexAttrib1f(ATTRIBUTE_SPACING, spacing);
    }
    BoundMesh(const BoundMesh&) = delete;
    BoundMesh& operator=(const BoundMesh&) = delete;
    ~BoundMesh()
    {
        for (unsigned a = 0; a < ATTRIBUTE_COUNT; ++a)
            if (_enabled[a]) _gl.glDisableVertexAttribArray(a);
        _gl.glBindBuffer(GL_ARRAY_BUFFER_ARB, 0);
        _gl.glBindBuffer(GL_ELEMENT_ARRAY_BUFFER_ARB, 0);
        _state.unbindVertexBufferObject();
        _state.unbindElementBufferObject();
    }

private:
    void enable(unsigned attribute, int size, int offset, int stride)
    {
        _gl.glEnableVertexAttribArray(attribute);
        _gl.glVertexAttribPointer(attribute, size, GL_FLOAT, GL_FALSE,
                                  static_cast<GLsizei>(stride * sizeof(float)),
                                  reinterpret_cast<const void*>(offset * sizeof(float)));
        _enabled[attribute] = true;
    }

    osg::State& _state;
    osg::GLExtensions& _gl;
    bool _enabled[ATTRIBUTE_COUNT] = {};
};

void drawMesh(osg::RenderInfo& renderInfo, ContextResources& resources, const Uniforms& uniforms,
              const core::View& view, const VolumeMesh& mesh, const VolumeLook& look)
{
    osg::State& state = *renderInfo.getState();
    const osg::Depth::Function test = look.above.depthTest.function;
    if (look.features.gathers() && (test == osg::Depth::NEVER || test == osg::Depth::EQUAL)) return;
    // Gathered values hide nothing, so they need no order, and no parts.
    std::optional<RayTarget> target;
    if (look.features.gathers())
        target.emplace(state, resources, look.features, glm::ivec4(currentViewport()));
    if (target && !target->made()) return;
    {
        const BoundMesh bound(state, *state.get<osg::GLExtensions>(), resources, mesh,
                              static_cast<float>(look.step));
        const BatchDrawing drawing{renderInfo, resources.limits, uniforms, look.features, view};
        const auto drawBatches = [&]() {
            for (const BrickBatch& batch : mesh.batches)
                drawBatch(drawing, batch);
        };
        if (look.scissors.empty()) {
            drawBatches();
        } else {
            const ScissorScope scissor;
            for (const glm::ivec4& rectangle : look.scissors)
                if (scissor.set(rectangle)) drawBatches();
        }
    }
    if (target) target->resolve(look);
}

// Takes the place of a program whose surfaces the card has no memory for: the volume is drawn
// without them, which come after it. Found in the frame that asks for the memory; the next ones are
// composed without.
class Substitute
{
public:
    Substitute(osg::State& state, const ContextResources& resources,
               const ProgramFeatures& features)
        : _state(state)
    {
        const bool captured = features.slotCount > 0 && !resources.capture.colors;
        const bool ranked = features.ranked && !resources.accumulation.layers.rankDepth;
        if (!captured && !ranked) return;
        ProgramFeatures plain = features;
        plain.slotCount = 0;
        plain.ranked = false;
        _before = state.getLastAppliedAttribute(osg::StateAttribute::PROGRAM);
        _set = volumeStateSet(plain);
        state.applyAttribute(_set->getAttribute(osg::StateAttribute::PROGRAM));
        state.applyAttribute(_set->getAttribute(osg::StateAttribute::BLENDFUNC));
        state.haveAppliedAttribute(osg::StateAttribute::BLENDFUNC);
    }
    Substitute(const Substitute&) = delete;
    Substitute& operator=(const Substitute&) = delete;
    ~Substitute()
    {
        if (_set && _before) _state.applyAttribute(_before);
    }

    /// Of the segments between ranks the first stands for all.
    bool isDrawn(const VolumeLook& look) const
    {
        return !_set || !look.features.ranked || look.rank == 0;
    }

private:
    osg::State& _state;
    osg::ref_ptr<osg::StateSet> _set;
    const osg::StateAttribute* _before = nullptr;
};

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
    if (!supported || !_mesh || !_look || _mesh->batches.empty()) return;
    const AccumulationBuffers& buffers = resources->accumulation;
    if (buffers.drawBuffers.empty() || buffers.drawBuffers.front() == GL_NONE) return;
    const Substitute substitute(state, *resources, _look->features);
    const auto* program = state.getLastAppliedProgramObject();
    if (!substitute.isDrawn(*_look) || !program) return;
    const glm::dmat4 toEye = toGlm(state.getModelViewMatrix());
    const glm::dmat4 projection = toGlm(state.getProjectionMatrix());
    const Result<PixelRays> rays =
        pixelRays(toEye, _look->above.toUsualClip * projection, currentViewport(),
                  _look->referenceDepth, _look->center);
    if (!rays) {
        reportError(rays.status);
        return;
    }
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const FirstDrawBufferScope first(gl, buffers.drawBuffers);
    const ForeignStateScope foreign(state, true);
    const Uniforms uniforms(gl, *program);
    // Meshes for captured surfaces are in device coordinates.
    uniforms.set("frameToClip",
                 _look->features.slotCount > 0 ? glm::dmat4(1.0) : projection * toEye);
    setLook(uniforms, *_look, *rays);
    if (_look->features.shading) setShading(uniforms, *_look, *rays, toEye, state);
    if (_look->features.opaqueDepth) setDepthTextures(state, uniforms, *rays, *_look, *resources);
    if (_look->table.texture && !applyTable(state, _look->table.texture.get(), UNIT_TABLE)) return;
    setPaints(renderInfo, resources->limits, uniforms, _look->paints, UNIT_FIRST_PAINT);
    drawMesh(renderInfo, *resources, uniforms, {toEye, projection}, *_mesh, *_look);
    count(renderInfo.getCurrentCamera(), state.getFrameStamp(), "osgVolumizer draw calls",
          static_cast<double>(_mesh->batches.size()));
    reapplyInNextFrame(state);
    // OSG compares attributes by address: make it bind its own again whatever ours were.
    for (unsigned unit : {UNIT_VOXELS, UNIT_TABLE, UNIT_OPAQUE_DEPTH, UNIT_LAYER_DEPTH,
                          UNIT_SORTED_FAR, UNIT_SORTED_NEAR, UNIT_CELLS})
        state.haveAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE);
}

} // namespace render
} // namespace osgVolumizer
