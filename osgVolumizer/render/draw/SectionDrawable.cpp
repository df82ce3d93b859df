#include "SectionDrawable.h"

#include "../context/ContextResources.h"
#include "../context/ForeignState.h"
#include "../context/Matrices.h"
#include "../context/ReportOnce.h"
#include "../context/Statistics.h"
#include "../context/Uniforms.h"
#include "../textures/JoinedBricks.h"
#include "../textures/TableTextures.h"
#include "BatchDrawing.h"
#include "BoundMesh.h"
#include "FusedSource.h"
#include "PixelRays.h"

namespace osgVolumizer {
namespace render {

namespace SectionDrawing {

// The unit of the texture of a brick of a batch, and of its second time step.
unsigned unitOf(std::size_t slot, bool next, const SectionFeatures& features)
{
    const auto i = unsigned(slot) + (next ? unsigned(features.brickCount) : 0u);
    return i == 0 ? UNIT_VOXELS : UNIT_TABLE + i;
}

// After those of bricks and table.
unsigned unitOfCut(const SectionFeatures& features)
{
    return 1 + unsigned(features.brickCount) * (features.voxels.blendsSteps ? 2 : 1);
}

unsigned unitCount(const SectionFeatures& features)
{
    return unitOfCut(features) + (features.voxels.cutField ? 1 : 0);
}

// Where a pixel's ray meets the plane of a face, which is more precise than what rasterisers
// interpolate.
void setRays(const Uniforms& uniforms, const SectionPart& part, const osg::State& state)
{
    GLfloat v[4];
    glGetFloatv(GL_VIEWPORT, v); // which more than one attribute of OSG can set
    const glm::dmat4 toEye = toGlm(state.getModelViewMatrix());
    const Result<PixelRays> rays =
        pixelRays(toEye, part.toUsualClip * toGlm(state.getProjectionMatrix()),
                  {v[0], v[1], v[2], v[3]}, -toEye[3].z, glm::dvec3(0.0));
    const bool known = part.inPlace && rays.ok();
    uniforms.set("hasRays", known ? 1 : 0);
    if (!known) return;
    uniforms.set("windowCenter", glm::vec2(rays->windowCenter));
    uniforms.set("rayOrigin", rays->origin);
    uniforms.set("rayDirection", rays->direction);
    uniforms.set("positionScale", glm::vec3(part.positionScale));
    uniforms.set("positionOffset", glm::vec3(part.positionOffset - part.mesh->voxelBase));
}

void setAll(const Uniforms& uniforms, const SectionPart& part, const osg::State& state)
{
    const glm::dmat4 toEye = toGlm(state.getModelViewMatrix());
    uniforms.set("frameToClip", toGlm(state.getProjectionMatrix()) * toEye);
    uniforms.set("colorPoints", int(UNIT_TABLE));
    uniforms.set("pointCount", part.colors.count);
    const auto* ramp = part.colors.ramp;
    if (part.features.ramp) {
        uniforms.set("rampEnds", glm::vec2(ramp[0].value, ramp[1].value));
        uniforms.set("rampLow", glm::vec4(ramp[0].color));
        uniforms.set("rampHigh", glm::vec4(ramp[1].color));
    }
    uniforms.set("texelToFraction", part.texelToFraction);
    uniforms.set("opacity", part.opacity);
    uniforms.set("voxelBase", glm::vec3(part.mesh->voxelBase));
    uniforms.set("usesTableOpacity", part.usesTableOpacity ? 1 : 0);
    uniforms.set("thickness", part.thickness);
    uniforms.set("period", part.period);
    setRays(uniforms, part, state);
    if (!part.planes.empty()) uniforms.set("planes", part.planes);
    if (part.features.voxels.cut) {
        setCut(uniforms, part.cut);
        uniforms.set("cutField", int(unitOfCut(part.features)));
        uniforms.set("cutTolerance", part.cutTolerance);
    }
    if (!part.features.voxels.fog) return;
    uniforms.set("frameToEye", toEye);
    uniforms.set("fogColor", part.fog.color);
    uniforms.set("fogIsLinear", part.fog.linear ? 1 : 0);
    uniforms.set("fogRates", part.fog.rates);
    uniforms.set("fogDepth", 0.0f);
}

glm::dmat4 voxelToTexture(const SelectedBrick& brick, const CoarseTexture& texture)
{
    const glm::dvec3 scale(brick.textureScale * texture.scale);
    const glm::dvec3 offset(brick.textureOffset * texture.scale + texture.offset);
    glm::dmat4 m(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        m[axis][axis] = scale[axis];
        m[3][axis] = offset[axis];
    }
    return m;
}

osg::Vec3d toVec3d(const glm::dvec3& v)
{
    return {v.x, v.y, v.z};
}

// The texture of a brick, applied; null where the card refuses it.
CoarseTexture applyTo(osg::RenderInfo& renderInfo, const ContextLimits& limits,
                      const SelectedBrick& brick, unsigned unit)
{
    if (!brick.joined) return brick.texels.apply(renderInfo, limits, unit);
    CoarseTexture texture;
    if (brick.joined->apply(renderInfo, limits, unit))
        texture.texture = dynamic_cast<osg::Texture3D*>(
            const_cast<osg::StateAttribute*>(renderInfo.getState()->getLastAppliedTextureAttribute(
                unit, osg::StateAttribute::TEXTURE)));
    return texture;
}

} // namespace SectionDrawing

SectionDrawable::SectionDrawable(std::shared_ptr<const SectionPart> part,
                                 const osg::BoundingBox& bounds)
    : _part(std::move(part))
{
    setSupportsDisplayList(false);
    setUseDisplayList(false);
    setUseVertexBufferObjects(false);
    setDataVariance(osg::Object::STATIC);
    setInitialBound(bounds);
}

void SectionDrawable::drawImplementation(osg::RenderInfo& renderInfo) const
{
    if (!_part) return;
    const Status supported = contextResources(*renderInfo.getState())->limits.check();
    reportOnce(supported);
    if (!supported) return;
    if (_part->callback)
        callBack(renderInfo);
    else
        drawFaces(renderInfo);
}

void SectionDrawable::drawFaces(osg::RenderInfo& renderInfo) const
{
    using namespace SectionDrawing;
    osg::State& state = *renderInfo.getState();
    const auto* program = state.getLastAppliedProgramObject();
    if (!program) return;
    const std::shared_ptr<ContextResources> resources = contextResources(state);
    osg::GLExtensions& gl = *state.get<osg::GLExtensions>();
    const ForeignStateScope foreign(state, _part->features.translucent);
    const SectionFeatures& features = _part->features;
    setAll(Uniforms(gl, *program), *_part, state);
    const core::View view;
    const auto slots = std::size_t(features.brickCount);
    const auto setBricks = [&](const std::vector<std::size_t>& bricks) {
        bool any = false;
        for (std::size_t slot = 0; slot < slots; ++slot) {
            const Uniforms uniforms(gl, *program, memberSuffix(slot));
            BatchDrawing drawing{renderInfo, resources->limits, uniforms, features.voxels, view};
            drawing.voxelUnit = unitOf(slot, false, features);
            drawing.nextVoxelUnit = unitOf(slot, true, features);
            uniforms.set("voxels", int(drawing.voxelUnit));
            uniforms.set("nextVoxels", int(drawing.nextVoxelUnit));
            const bool there =
                slot < bricks.size() && setBatch(drawing, batchOf(_part->bricks[bricks[slot]]));
            if (!there) {
                uniforms.set("clipMin", glm::vec3(1.0f));
                uniforms.set("clipMax", glm::vec3(0.0f));
            }
            any = any || there;
        }
        return any;
    };
    const bool isCut =
        !features.voxels.cutField || applyCutField(state, _part->cut, unitOfCut(features));
    if (isCut && applyTable(state, _part->colors.texture.get(), UNIT_TABLE)) {
        const BoundMesh bound(state, *resources, _part->mesh->arrays, 0.0f);
        for (const SectionBatch& batch : _part->mesh->batches)
            if (setBricks(batch.bricks))
                glDrawElements(GL_TRIANGLES, GLsizei(batch.indexCount), GL_UNSIGNED_INT,
                               reinterpret_cast<const void*>(std::size_t(batch.firstIndex) *
                                                             sizeof(unsigned)));
    }
    reapplyInNextFrame(state);
    for (unsigned unit = 0; unit < unitCount(features); ++unit)
        state.haveAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE);
    count(renderInfo.getCurrentCamera(), state.getFrameStamp(), "osgVolumizer slice draw calls",
          double(_part->mesh->batches.size()));
}

void SectionDrawable::callBack(osg::RenderInfo& renderInfo) const
{
    using namespace SectionDrawing;
    osg::State& state = *renderInfo.getState();
    const std::shared_ptr<ContextResources> resources = contextResources(state);
    const unsigned unit = _part->callback->textureUnit();
    const glm::dmat4 toVoxel = toGlm(_part->objectToVoxel);
    const osg::Matrixd toObject = osg::Matrixd::inverse(_part->objectToVoxel);
    for (const SelectedBrick& brick : _part->bricks) {
        const CoarseTexture texture = applyTo(renderInfo, resources->limits, brick, unit);
        const auto* object =
            texture.texture ? texture.texture->getTextureObject(state.getContextID()) : nullptr;
        if (!object) continue;
        BoundBrick bound;
        bound.voxels = _part->voxels.get();
        bound.textureUnit = unit;
        bound.textureName = object->id();
        const glm::dmat4 toTexture = voxelToTexture(brick, texture);
        bound.voxelToTexture = toOsg(toTexture);
        bound.objectToTexture = toOsg(toTexture * toVoxel);
        for (const int corner : {0, 7}) {
            const osg::Vec3d p = toVec3d(brick.clipBox.corner(corner));
            bound.boxVoxel.expandBy(p);
            bound.boxObject.expandBy(p * toObject);
        }
        bound.fractionScale = _part->texelToFraction.x;
        bound.fractionOffset = _part->texelToFraction.y;
        bound.valueInAlpha = _part->features.voxels.gradientTexture;
        bound.samplesApart =
            1.0 / (double(brick.textureScale.x) * texture.texture->getTextureWidth());
        _part->callback->drawBrick(renderInfo, bound);
        state.haveAppliedTextureAttribute(unit, osg::StateAttribute::TEXTURE);
    }
    reapplyInNextFrame(state);
}

} // namespace render
} // namespace osgVolumizer
