#include "VolumeDrawable.h"

#include "../Error.h"
#include "BatchDrawing.h"
#include "ContextResources.h"
#include "Matrices.h"
#include "PixelRays.h"
#include "RayTarget.h"
#include "ReportOnce.h"
#include "ScissorScope.h"
#include "Statistics.h"
#include "Uniforms.h"

#include "../core/sampling/View.h"

#include <osg/Program>

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <cmath>
#include <optional>

namespace osgVolumizer {
namespace render {

namespace {

glm::dvec4 viewportOf(osg::State& state)
{
    if (const osg::Viewport* v = state.getCurrentViewport())
        return {v->x(), v->y(), v->width(), v->height()};
    GLint v[4];
    glGetIntegerv(GL_VIEWPORT, v);
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

void setDepthTextures(osg::State& state, const Uniforms& uniforms, const PixelRays& rays,
                      const VolumeLook& look, const ContextResources& resources)
{
    const ProgramFeatures& features = look.features;
    const AccumulationBuffers& buffers = resources.accumulation;
    uniforms.set("opaqueDrawn", buffers.hasOpaqueDepth ? 1 : 0);
    if (!buffers.opaqueDepth) return;
    state.applyTextureAttribute(UNIT_OPAQUE_DEPTH, buffers.opaqueDepth.get());
    if (features.layerDepth)
        state.applyTextureAttribute(UNIT_LAYER_DEPTH, buffers.layerDepth.get());
    if (features.ranked) {
        state.applyTextureAttribute(UNIT_SORTED_FAR, buffers.layers.sorted[0].get());
        state.applyTextureAttribute(UNIT_SORTED_NEAR, buffers.layers.sorted[1].get());
    }
    if (features.slotCount > 0) {
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
    const auto* program = state.getLastAppliedProgramObject();
    if (!supported || !_mesh || !_look || _mesh->batches.empty() || !program) return;
    const glm::dmat4 toEye = toGlm(state.getModelViewMatrix());
    const glm::dmat4 projection = toGlm(state.getProjectionMatrix());
    const Result<PixelRays> rays =
        pixelRays(toEye, projection, viewportOf(state), _look->referenceDepth, _look->center);
    if (!rays) {
        reportError(rays.status);
        return;
    }
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const Uniforms uniforms(gl, *program);
    uniforms.set("frameToClip", projection * toEye);
    setLook(uniforms, *_look, *rays);
    if (_look->features.shading) setShading(uniforms, *_look, *rays, toEye, state);
    if (_look->features.opaqueDepth) setDepthTextures(state, uniforms, *rays, *_look, *resources);
    if (_look->table.texture && !applyTable(state, _look->table.texture.get(), UNIT_TABLE)) return;
    setPaints(renderInfo, resources->limits, uniforms, _look->paints, UNIT_FIRST_PAINT);
    // Gathered values hide nothing, so they need no order, and no parts.
    std::optional<RayTarget> target;
    if (_look->features.gathers())
        target.emplace(state, *resources, _look->features, glm::ivec4(viewportOf(state)));
    {
        const BoundMesh bound(state, gl, *resources, *_mesh, static_cast<float>(_look->step));
        const core::View view{toEye, projection};
        const BatchDrawing drawing{renderInfo, resources->limits, uniforms, _look->features, view};
        const auto drawBatches = [&]() {
            for (const BrickBatch& batch : _mesh->batches)
                drawBatch(drawing, batch);
        };
        if (_look->scissors.empty()) {
            drawBatches();
        } else {
            const ScissorScope scissor;
            for (const glm::ivec4& rectangle : _look->scissors)
                if (scissor.set(rectangle)) drawBatches();
        }
    }
    if (target) target->resolve(*_look);
    count(renderInfo.getCurrentCamera(), state.getFrameStamp(), "osgVolumizer draw calls",
          static_cast<double>(_mesh->batches.size()));
    // OSG compares attributes by address: make it bind its own again whatever ours were.
    for (unsigned unit : {UNIT_VOXELS, UNIT_TABLE, UNIT_OPAQUE_DEPTH, UNIT_LAYER_DEPTH,
                          UNIT_SORTED_FAR, UNIT_SORTED_NEAR, UNIT_CELLS})
        state.haveAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE);
}

} // namespace render
} // namespace osgVolumizer
