#include "SectionProgram.h"

#include "../context/ShaderSource.h"
#include "../context/SharedStateSets.h"
#include "FusedSource.h"

#include <osg/BlendFunc>
#include <osg/Program>

namespace osgVolumizer {
namespace render {

namespace SectionPrograms {

constexpr char VERSION[] = "#version 330\n";

std::string replaced(std::string code, const std::string& line, const std::string& by)
{
    for (std::size_t at = 0; (at = code.find(line, at)) != std::string::npos; at += by.size())
        code.replace(at, line.size(), by);
    return code;
}

std::string fragmentSource(const SectionFeatures& features)
{
    std::string code = shaderSource("filtering.glsl"), takes;
    const std::string brick = shaderSource("voxels.glsl") + shaderSource("sectionbrick.glsl");
    for (int i = 0; i < features.brickCount; ++i) {
        const std::string suffix = memberSuffix(std::size_t(i));
        code += withSuffix(brick, suffix);
        takes += "        take" + suffix + "(place, total, counted);\n";
    }
    code += shaderSource("fog.glsl") + shaderSource("cut.glsl");
    return code + replaced(shaderSource("section.frag.glsl"), "#pragma take\n", takes);
}

std::string headerOf(const SectionFeatures& features)
{
    static const char* const reductions[] = {"MEAN", "MAXIMUM", "MINIMUM"};
    return VERSION + features.voxels.defines() + "#define REDUCTION_" +
           reductions[features.reduction] + "\n" + (features.slab ? "#define THICK\n" : "") +
           (features.ramp ? "#define RAMP\n" : "");
}

osg::ref_ptr<osg::StateSet> make(const SectionFeatures& features)
{
    using osg::StateAttribute;
    const std::string header = headerOf(features);
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->setName("osgVolumizer section");
    program->addShader(makeShader(osg::Shader::VERTEX, header, shaderSource("section.vert.glsl")));
    program->addShader(makeShader(osg::Shader::FRAGMENT, header, fragmentSource(features)));
    osg::ref_ptr<osg::StateSet> set = new osg::StateSet;
    set->setName("osgVolumizer section");
    set->setDataVariance(osg::Object::STATIC);
    set->setAttributeAndModes(program, StateAttribute::ON | StateAttribute::PROTECTED);
    // The shader cuts.
    for (GLenum plane = 0; plane < 8; ++plane)
        set->setMode(GL_CLIP_PLANE0 + plane, StateAttribute::OFF | StateAttribute::PROTECTED);
    if (!features.translucent) return set;
    set->setAttributeAndModes(
        new osg::BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA));
    set->setRenderingHint(osg::StateSet::TRANSPARENT_BIN);
    return set;
}

} // namespace SectionPrograms

osg::ref_ptr<osg::StateSet> sectionStateSet(const SectionFeatures& features)
{
    std::uint64_t own = std::uint64_t(features.brickCount);
    own = own << 2 | std::uint64_t(features.reduction);
    own = own << 1 | std::uint64_t(features.slab);
    own = own << 1 | std::uint64_t(features.ramp);
    own = own << 1 | std::uint64_t(features.translucent);
    const std::vector<std::uint64_t> key{std::uint64_t(SharedState::SECTIONS),
                                         features.voxels.key(), own};
    return sharedStateSet(key, [&]() { return SectionPrograms::make(features); });
}

} // namespace render
} // namespace osgVolumizer
