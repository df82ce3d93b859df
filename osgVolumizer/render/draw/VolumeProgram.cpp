#include "VolumeProgram.h"

#include "../context/ShaderSource.h"
#include "../context/SharedStateSets.h"
#include "../context/Uniforms.h"
#include "FusedSource.h"
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

// The files of the shader that marches, or draws a slice.
std::string pixelSource(const ProgramFeatures& features,
                        const std::vector<ProgramFeatures>& members)
{
    const std::string source =
        shaderSource("pixel.glsl") + shaderSource("march.glsl") + shaderSource("segment.glsl");
    if (!members.empty())
        return source + marchSource(members, features.inOrder) + shaderSource("ray.glsl") +
               shaderSource("slab.glsl");
    if (features.slab) return source + marchSource(features) + shaderSource("slab.glsl");
    return source + volumeSource(features) +
           withRayFunction("slice.frag.glsl", features.rayFunction);
}

osg::ref_ptr<osg::Program> program(const ProgramFeatures& features,
                                   const std::vector<ProgramFeatures>& members)
{
    const std::string kind = features.slab ? "slab" : "slice";
    const std::string header = VERSION + features.defines() +
                               (features.slab ? "" : "#define SLICE\n") +
                               (members.empty() ? "" : "#define FUSED\n");
    osg::ref_ptr<osg::Program> result = new osg::Program;
    result->setName("osgVolumizer " + kind);
    result->addShader(makeShader(osg::Shader::VERTEX, header, shaderSource(kind + ".vert.glsl")));
    result->addShader(makeShader(osg::Shader::FRAGMENT, header, pixelSource(features, members)));
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

osg::ref_ptr<osg::StateSet> makeStateSet(const ProgramFeatures& features,
                                         const std::vector<ProgramFeatures>& members)
{
    using osg::StateAttribute;
    osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
    set->setName("osgVolumizer");
    set->setDataVariance(osg::Object::STATIC);
    set->setAttributeAndModes(program(features, members), KEPT);
    // What surfaces leave in the target's alpha need not be what they take of the light behind.
    constexpr GLenum SOURCE1_COLOR = 0x88F9;
    const bool captured = features.slotCount > 0;
    const bool twoOutputs = captured && !features.coarse;
    set->setAttributeAndModes(
        new osg::BlendFunc(osg::BlendFunc::ONE,
                           twoOutputs ? SOURCE1_COLOR : GLenum(GL_ONE_MINUS_SRC_ALPHA)),
        KEPT);
    set->setAttribute(new osg::BlendEquation(osg::BlendEquation::FUNC_ADD), KEPT);
    const bool overPixels = captured || !members.empty();
    set->setAttributeAndModes(
        new osg::Depth(overPixels ? osg::Depth::ALWAYS : osg::Depth::LEQUAL, 0.0, 1.0, false),
        KEPT);
    // OSG's transparent bins drop fragments of alpha 0, which may still carry colour.
    set->setAttributeAndModes(new osg::AlphaFunc(osg::AlphaFunc::ALWAYS, 0.0f), KEPT_OFF);
    // Segments end at near and far themselves: rounding must not cut off the face on the near
    // plane.
    if (features.slab) set->setMode(GL_DEPTH_CLAMP, KEPT);
    keepFacesWhole(*set);
    set->setRenderBinDetails(10, "DepthSortedBin");
    return set;
}

} // namespace

osg::ref_ptr<osg::StateSet> volumeStateSet(const ProgramFeatures& features)
{
    return volumeStateSet(features, {});
}

osg::ref_ptr<osg::StateSet> volumeStateSet(const ProgramFeatures& features,
                                           const std::vector<ProgramFeatures>& members)
{
    std::vector<std::uint64_t> key{features.key(), features.fieldKey()};
    for (const ProgramFeatures& member : members)
        key.insert(key.end(), {member.key(), member.fieldKey()});
    return sharedStateSet(key, [&]() { return makeStateSet(features, members); });
}

osg::ref_ptr<osg::Program> makeComputeProgram(const std::string& header,
                                              const ProgramFeatures& features,
                                              const std::vector<ProgramFeatures>& members)
{
    osg::ref_ptr<osg::Program> result = new osg::Program;
    result->setName("osgVolumizer compute");
    result->addShader(
        makeShader(osg::Shader::COMPUTE,
                   header + features.defines() + (members.empty() ? "" : "#define FUSED\n"),
                   pixelSource(features, members)));
    return result;
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
