#include "VolumeProgram.h"

#include "../context/ProgramInterface.h"
#include "../context/ShaderSource.h"
#include "../context/SharedStateSets.h"
#include "../context/Uniforms.h"
#include "Paint.h"
#include "RayFunctions.h"

#include <osg/AlphaFunc>
#include <osg/BlendEquation>
#include <osg/BlendFunc>
#include <osg/CullFace>
#include <osg/Depth>
#include <osg/PolygonMode>
#include <osg/Program>

#include <cassert>
#include <string>

namespace osgVolumizer {
namespace render {

namespace {

constexpr char VERSION[] = "#version 330\n";

// A shader with the code of a ray function in its place: before what calls it, as compilers like
// it.
std::string withRayFunction(const char* file, VolumeAppearance::RayFunction function)
{
    static const std::string place = "#pragma ray_function\n";
    std::string source = shaderSource(file);
    const std::size_t at = source.find(place);
    assert(at != std::string::npos);
    return source.replace(at, place.size(), rayShaderSource(function));
}

osg::ref_ptr<osg::Program> program(const ProgramFeatures& features)
{
    const std::string kind = features.slab ? "slab" : "slice";
    const std::string header =
        VERSION + features.defines() + (features.slab ? "" : "#define SLICE\n");
    osg::ref_ptr<osg::Program> result = new osg::Program;
    result->setName("osgVolumizer " + kind);
    result->addShader(makeShader(osg::Shader::VERTEX, header, shaderSource(kind + ".vert.glsl")));
    std::string fragment;
    for (const char* file : {"filtering.glsl", "voxels.glsl", "transfer.glsl", "ray.glsl",
                             "shading.glsl", "skipping.glsl", "segment.glsl"})
        fragment += shaderSource(file);
    if (features.paintCount > 0) fragment += paintSource(features.paintCount);
    fragment +=
        withRayFunction(features.slab ? "slab.frag.glsl" : "slice.frag.glsl", features.rayFunction);
    result->addShader(makeShader(osg::Shader::FRAGMENT, header, fragment));
    return result;
}

// What holds against states above that override.
constexpr unsigned KEPT = osg::StateAttribute::ON | osg::StateAttribute::PROTECTED;
constexpr unsigned KEPT_OFF = osg::StateAttribute::OFF | osg::StateAttribute::PROTECTED;

// Faces only say which pixels there is something to integrate in: how geometry is rasterised or
// cut, and what logic does with it, is not for them.
void keepFacesWhole(osg::StateSet& set)
{
    constexpr GLenum PRIMITIVE_RESTART = 0x8F9D; // GL_PRIMITIVE_RESTART
    set.setAttribute(new osg::PolygonMode, KEPT);
    for (GLenum mode :
         {GLenum(GL_CULL_FACE), GLenum(GL_POLYGON_SMOOTH), GLenum(GL_POLYGON_OFFSET_FILL),
          GLenum(GL_POLYGON_OFFSET_LINE), GLenum(GL_POLYGON_OFFSET_POINT),
          GLenum(GL_COLOR_LOGIC_OP), PRIMITIVE_RESTART})
        set.setMode(mode, KEPT_OFF);
    for (GLenum plane = 0; plane < 8; ++plane)
        set.setMode(GL_CLIP_PLANE0 + plane, KEPT_OFF);
}

osg::ref_ptr<osg::StateSet> makeStateSet(const ProgramFeatures& features)
{
    using osg::StateAttribute;
    osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
    set->setName("osgVolumizer");
    set->setDataVariance(osg::Object::STATIC);
    set->setAttributeAndModes(program(features), KEPT);
    // What surfaces leave in the target's alpha need not be what they take of the light behind.
    constexpr GLenum SOURCE1_COLOR = 0x88F9;
    const bool captured = features.slotCount > 0;
    const bool twoOutputs = captured && !features.coarse;
    set->setAttributeAndModes(
        new osg::BlendFunc(osg::BlendFunc::ONE,
                           twoOutputs ? SOURCE1_COLOR : GLenum(GL_ONE_MINUS_SRC_ALPHA)),
        KEPT);
    set->setAttribute(new osg::BlendEquation(osg::BlendEquation::FUNC_ADD), KEPT);
    set->setAttributeAndModes(
        new osg::Depth(captured ? osg::Depth::ALWAYS : osg::Depth::LEQUAL, 0.0, 1.0, false), KEPT);
    // OSG's transparent bins drop fragments of alpha 0, which may still carry colour.
    set->setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::ALWAYS, 0.0f), KEPT_OFF);
    // Segments end at near and far themselves: rounding must not cut off the face on the near
    // plane.
    if (features.slab) set->setMode(GL_DEPTH_CLAMP, KEPT);
    keepFacesWhole(*set);
    set->addUniform(new osg::Uniform(uniformName("voxels").c_str(), int(UNIT_VOXELS)));
    set->addUniform(new osg::Uniform(uniformName("lookupTable").c_str(), int(UNIT_TABLE)));
    set->addUniform(new osg::Uniform(uniformName("opaqueDepth").c_str(), int(UNIT_OPAQUE_DEPTH)));
    set->addUniform(new osg::Uniform(uniformName("splitDepth").c_str(), int(UNIT_SPLIT_DEPTH)));
    set->addUniform(new osg::Uniform(uniformName("sortedSlots").c_str(), int(UNIT_SORTED_FAR)));
    set->addUniform(new osg::Uniform(uniformName("slotColors").c_str(), int(UNIT_SORTED_NEAR)));
    set->addUniform(new osg::Uniform(uniformName("sortedFar").c_str(), int(UNIT_SORTED_FAR)));
    set->addUniform(new osg::Uniform(uniformName("sortedNear").c_str(), int(UNIT_SORTED_NEAR)));
    set->addUniform(new osg::Uniform(uniformName("cells").c_str(), int(UNIT_CELLS)));
    set->setRenderBinDetails(10, "DepthSortedBin");
    return set;
}

} // namespace

osg::ref_ptr<osg::StateSet> volumeStateSet(const ProgramFeatures& features)
{
    return sharedStateSet(features.key(), [&features]() { return makeStateSet(features); });
}

osg::ref_ptr<osg::StateSet> depthTestStateSet(const DepthTest& test)
{
    using osg::StateAttribute;
    osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
    set->setAttributeAndModes(new osg::Depth(test.function, test.zNear, test.zFar, false),
                              StateAttribute::ON | StateAttribute::PROTECTED);
    return set;
}

osg::ref_ptr<osg::Program> makeFillProgram()
{
    osg::ref_ptr<osg::Program> result = new osg::Program;
    result->setName("osgVolumizer fill");
    result->addShader(makeShader(osg::Shader::VERTEX, VERSION, shaderSource("screen.vert.glsl")));
    result->addShader(makeShader(osg::Shader::FRAGMENT, VERSION, shaderSource("fill.frag.glsl")));
    return result;
}

osg::ref_ptr<osg::Program> makeResolveProgram(VolumeAppearance::RayFunction function, bool rgba)
{
    const std::string header =
        std::string(VERSION) + "#define RESOLVE\n" + (rgba ? "#define RGBA\n" : "");
    osg::ref_ptr<osg::Program> result = new osg::Program;
    result->setName("osgVolumizer resolve");
    result->addShader(makeShader(osg::Shader::VERTEX, header, shaderSource("screen.vert.glsl")));
    result->addShader(
        makeShader(osg::Shader::FRAGMENT, header, withRayFunction("resolve.frag.glsl", function)));
    return result;
}

} // namespace render
} // namespace osgVolumizer
