#include "VolumeUniforms.h"

#include "../context/Allocation.h"
#include "../context/ContextLimits.h"
#include "../context/ProgramInterface.h"
#include "../context/ReportOnce.h"

#include "../../core/accuracy/CellRay.h"

#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace osgVolumizer {
namespace render {

namespace {

void setTable(const Uniforms& uniforms, const VolumeLook& look)
{
    uniforms.set("valueToEntry", look.valueToEntry);
    uniforms.set("lastEntry", static_cast<float>(look.table.count - 1));
    if (look.features.cells) {
        uniforms.set("intervals", look.table.intervals->intervals);
        uniforms.set("longestPiece", static_cast<float>(look.step * core::PIECE_SLACK));
    }
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

void setLights(const Uniforms& uniforms, const std::vector<EyeLight>& lights)
{
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
}

void setShading(const Uniforms& uniforms, const VolumePart& part, const PixelRays& rays,
                const glm::dmat4& frameToEye, const osg::State& state)
{
    const VolumeLook& look = *part.look;
    setLights(uniforms, enabledLights(part.lights ? *part.lights : std::vector<EyeLight>(), state));
    uniforms.set("material", look.material);
    uniforms.set("gradientToEye", gradientToEye(look, glm::dmat3(frameToEye)));
    uniforms.set("gradientDecode", look.gradientDecode);
    uniforms.set("rayOriginEye", rays.originEye);
    uniforms.set("rayDirectionEye", rays.directionEye);
}

void setFog(const Uniforms& uniforms, const VolumeLook& look, const PixelRays& rays)
{
    uniforms.set("fogColor", look.fog.color);
    uniforms.set("fogIsLinear", look.fog.linear ? 1 : 0);
    uniforms.set("fogRates", look.fog.rates);
    uniforms.set("fogDepth", static_cast<float>(-rays.originEye[2].z));
}

void setSegment(const Uniforms& uniforms, const VolumePart& part)
{
    const VolumeLook& look = *part.look;
    uniforms.set("stepsPerDepth", static_cast<float>(1.0 / part.step));
    uniforms.set("stepsPerLength", static_cast<float>(look.stepsPerLength));
    uniforms.set("mostWeight", static_cast<float>(look.mostWeight));
    uniforms.set("maximumSteps", static_cast<float>(look.maximumSteps));
    uniforms.set("opaqueEnough", static_cast<float>(look.opaqueEnough));
    if (part.features.splitDepth) uniforms.set("inFrontOfSplit", part.inFrontOfSplit ? 1 : 0);
    if (part.features.ranked) uniforms.set("rank", part.rank);
    uniforms.set("regionMin", look.regionMin);
    uniforms.set("regionMax", look.regionMax);
    uniforms.set("isoTexel", look.isoTexel);
}

// For the shader of slabs; a volume whose range is one depth lies just before that.
glm::vec2 depthRange(const DepthTest& test)
{
    if (test.zNear == test.zFar) return {static_cast<float>(test.zNear) - 1e-7f, 1e30f};
    return glm::vec2(test.zNear, 1.0 / (test.zFar - test.zNear));
}

void setDepthTextures(osg::State& state, const Uniforms& uniforms, const PixelRays& rays,
                      const VolumePart& part, const AccumulationBuffers& buffers)
{
    const DepthTest& test = part.above.depthTest;
    const bool ends = buffers.hasOpaqueDepth && test.function != osg::Depth::ALWAYS &&
                      test.function != osg::Depth::NOTEQUAL;
    uniforms.set("opaqueRule", !ends ? 0 : test.nearerPasses() ? 1 : 2);
    uniforms.set("depthRange", depthRange(test));
    if (!buffers.opaqueDepth) return;
    state.applyTextureAttribute(UNIT_OPAQUE_DEPTH, buffers.opaqueDepth.get());
    if (part.features.splitDepth)
        state.applyTextureAttribute(UNIT_SPLIT_DEPTH, buffers.splitDepth.get());
    if (part.features.needsSortedSurfaces() && buffers.sortedSurfaces[0]) {
        state.applyTextureAttribute(UNIT_SORTED_FAR, buffers.sortedSurfaces[0].get());
        state.applyTextureAttribute(UNIT_SORTED_NEAR, buffers.sortedSurfaces[1].get());
        uniforms.set("surfaceWeights", part.surfaceWeights);
    }
    uniforms.set("clipZOrigin", glm::vec3(rays.clipZOrigin));
    uniforms.set("clipZDirection", glm::vec3(rays.clipZDirection));
    uniforms.set("clipWOrigin", glm::vec3(rays.clipWOrigin));
    uniforms.set("clipWDirection", glm::vec3(rays.clipWDirection));
}

GLint largestBufferTexture()
{
    constexpr GLenum MAX_TEXTURE_BUFFER_SIZE = 0x8C2B;
    GLint texels = 0;
    glGetIntegerv(MAX_TEXTURE_BUFFER_SIZE, &texels);
    return texels;
}

// That a ray may meet, in a mesh that is as odd as can be.
constexpr std::size_t MOST_TETRAHEDRA = 1 << 20;

// \param most texels of a buffer texture. False, reported once, where the card refuses it: what it
// is for is not drawn.
bool applyBuffer(osg::State& state, osg::TextureBuffer& buffer, unsigned unit, GLint most)
{
    const int units = textureUnitsOf(state);
    const bool fits =
        buffer.getImage()->s() <= most && (units == 0 || static_cast<int>(unit) < units);
    if (fits && applyAllocated(state, AllocationRequest::TETRAHEDRA, buffer, unit)) return true;
    reportOnce({ErrorCode::TOO_LARGE,
                "tetrahedra do not fit into the graphics card's memory, its buffer textures of " +
                    std::to_string(most) + " texels, or its " + std::to_string(units) +
                    " texture units; volumes of them are not drawn"});
    return false;
}

} // namespace

unsigned cutUnitOf(const ProgramFeatures& features)
{
    return UNIT_FIRST_PAINT + 2 * static_cast<unsigned>(features.paintCount);
}

unsigned tetraUnitOf(const ProgramFeatures& features)
{
    return cutUnitOf(features) + (features.cutField ? 1 : 0);
}

bool setTetrahedra(osg::State& state, const Uniforms& uniforms, const VolumeLook& look,
                   unsigned unit)
{
    const TetraTextures& t = *look.tetrahedra;
    const GLint most = largestBufferTexture();
    const std::pair<const char*, osg::TextureBuffer*> buffers[] = {
        {"tetraGraph", t.graph.get()},
        {"tetraPositions", t.positions.get()},
        {"tetraBoxes", t.boxes.get()},
        {"tetraScalars", look.features.scalars ? t.scalars.get() : nullptr},
        {"tetraFields", look.features.fieldCount > 0 ? t.fields.get() : nullptr},
        {"tetraPlaces", look.features.places ? t.places.get() : nullptr},
        {"tetraColors", look.features.vertexColors ? t.colors.get() : nullptr}};
    for (const auto& buffer : buffers) {
        if (!buffer.second) continue;
        if (!applyBuffer(state, *buffer.second, unit, most)) return false;
        uniforms.set(buffer.first, static_cast<int>(unit++));
    }
    uniforms.set("tetraFacesBegin", t.facesBegin);
    uniforms.set("tetraFaceCount", t.faceCount);
    uniforms.set("tetraLeafCount", t.leafCount);
    uniforms.set("tetraLeafFaces", t.leafFaces);
    uniforms.set("tetraSize", t.size);
    uniforms.set("mostTetrahedra",
                 static_cast<int>(std::min<std::size_t>(2 * t.cellCount + 16, MOST_TETRAHEDRA)));
    uniforms.set("lastPoint", look.table.count - 1);
    return true;
}

void setSamplers(const Uniforms& uniforms)
{
    static constexpr std::pair<const char*, unsigned> UNITS[] = {{"voxels", UNIT_VOXELS},
                                                                 {"lookupTable", UNIT_TABLE},
                                                                 {"opaqueDepth", UNIT_OPAQUE_DEPTH},
                                                                 {"splitDepth", UNIT_SPLIT_DEPTH},
                                                                 {"sortedSlots", UNIT_SORTED_FAR},
                                                                 {"slotColors", UNIT_SORTED_NEAR},
                                                                 {"sortedFar", UNIT_SORTED_FAR},
                                                                 {"sortedNear", UNIT_SORTED_NEAR},
                                                                 {"cells", UNIT_CELLS},
                                                                 {"nextVoxels", UNIT_NEXT_VOXELS}};
    for (const auto& unit : UNITS)
        uniforms.set(unit.first, static_cast<int>(unit.second));
}

void setUniforms(osg::State& state, const Uniforms& uniforms, const VolumePart& part,
                 const PixelRays& rays, const glm::dmat4& frameToEye,
                 const AccumulationBuffers& buffers)
{
    const VolumeLook& look = *part.look;
    uniforms.set("windowCenter", glm::vec2(rays.windowCenter));
    uniforms.set("rayOrigin", rays.origin);
    uniforms.set("rayDirection", rays.direction);
    uniforms.set("frameToUnits", look.frameToUnits);
    if (look.table.texture) setTable(uniforms, look);
    if (!look.planes.empty()) uniforms.set("planes", look.planes);
    if (part.features.slab) {
        setSegment(uniforms, part);
    } else {
        uniforms.set("surfaceNormal", glm::vec3(part.surfaceNormal));
        if (part.features.spherical) uniforms.set("rayDirectionEye", rays.directionEye);
    }
    if (part.features.shading) setShading(uniforms, part, rays, frameToEye, state);
    if (part.features.fog) setFog(uniforms, look, rays);
    if (part.features.cut) setCut(uniforms, look.cut);
    if (!part.features.slab && (part.features.shading || part.features.fog))
        uniforms.set("frameToEye", frameToEye);
    if (part.features.opaqueDepth) setDepthTextures(state, uniforms, rays, part, buffers);
}

} // namespace render
} // namespace osgVolumizer
