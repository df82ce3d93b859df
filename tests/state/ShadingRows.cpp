// What colours fixed function gives, and programs.

#include "StateRow.h"

#include <osg/ColorMatrix>
#include <osg/Fog>
#include <osg/FragmentProgram>
#include <osg/Light>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/Program>
#include <osg/ShaderAttribute>
#include <osg/VertexProgram>

namespace osgVolumizer {
namespace test {

namespace {

using osg::StateSet;

const char* const OWN_PROGRAM = "A volume is drawn by programs of its own.";
const char* const OWN_MATERIAL =
    "The appearance has ambient, diffuse and specular shares of its own.";

void setFog(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::Fog> fog = new osg::Fog;
    fog->setMode(osg::Fog::LINEAR);
    // So gradual that the depth of a volume is that of a sheet.
    fog->setStart(-6000.0f);
    fog->setEnd(6200.0f);
    fog->setColor(osg::Vec4(1.0f, 0.0f, 0.0f, 1.0f));
    set.setAttributeAndModes(fog, value);
}

void setLight(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::Light> light = new osg::Light(0);
    light->setDiffuse(osg::Vec4(0.9f, 0.1f, 0.1f, 1.0f));
    set.setAttributeAndModes(light, value);
    set.setMode(GL_LIGHTING, value);
}

void setLightModel(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::LightModel> model = new osg::LightModel;
    model->setAmbientIntensity(osg::Vec4(1.0f, 0.2f, 0.2f, 1.0f));
    set.setAttributeAndModes(model, value);
    set.setMode(GL_LIGHTING, value);
}

void setMaterial(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setEmission(osg::Material::FRONT_AND_BACK, osg::Vec4(0.9f, 0.1f, 0.9f, 1.0f));
    set.setAttributeAndModes(material, value);
    set.setMode(GL_LIGHTING, value);
}

void setColorMatrix(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::ColorMatrix> matrix = new osg::ColorMatrix;
    matrix->setMatrix(osg::Matrix::scale(0.5, 0.2, 0.1));
    set.setAttributeAndModes(matrix, value);
}

void setProgram(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::Program> program = new osg::Program;
    program->addShader(new osg::Shader(
        osg::Shader::FRAGMENT, "#version 120\nvoid main() { gl_FragColor = vec4(1.0); }\n"));
    set.setAttributeAndModes(program, value);
}

void setFragmentProgram(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::FragmentProgram> program = new osg::FragmentProgram;
    program->setFragmentProgram(
        "!!ARBfp1.0\nPARAM white = {1.0, 1.0, 1.0, 1.0};\nMOV result.color, white;\nEND\n");
    set.setAttributeAndModes(program, value);
}

void setVertexProgram(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::VertexProgram> program = new osg::VertexProgram;
    program->setVertexProgram("!!ARBvp1.0\nPARAM place = {2.0, 2.0, 2.0, 1.0};\n"
                              "MOV result.position, place;\nMOV result.color, place;\nEND\n");
    set.setAttributeAndModes(program, value);
}

void setShaderAttribute(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::ShaderAttribute> attribute = new osg::ShaderAttribute;
    attribute->setType(static_cast<osg::StateAttribute::Type>(200));
    set.setAttributeAndModes(attribute, value);
}

// Names and types as volumes have them, and the names with other types.
void setUniforms(StateSet& set, unsigned value)
{
    for (const char* name : {"voxels", "lookupTable", "opaqueDepth", "homogeneous", "rays", "rank"})
        set.addUniform(new osg::Uniform(name, 5), value);
    for (const char* name : {"clipMin", "clipMax", "valueToEntry", "frameToClip", "rayOrigin"})
        set.addUniform(new osg::Uniform(name, 0.5f), value);
}

void setDefines(StateSet& set, unsigned value)
{
    for (const char* name : {"VOXELS", "MAXIMUM", "PLANES", "SLOTS", "SHADING"})
        set.setDefine(name, "1", value);
}

} // namespace

std::vector<StateRow> shadingRows()
{
    return {
        {"Fog", setFog, Effect::AS_ON_GEOMETRY, true,
         "By the depth of each sample; where a ray function gathers, of the volume's middle."},
        {"`GL_LIGHTING`", mode(GL_LIGHTING), Effect::NONE, true,
         "Volumes are lit where their appearance says so, see `setShading()`."},
        {"Light", setLight, Effect::NONE, true,
         "Shaded volumes are lit by the lights of LightSources and of the viewer."},
        {"LightModel", setLightModel, Effect::NONE, true, OWN_MATERIAL},
        {"Material", setMaterial, Effect::NONE, true, OWN_MATERIAL},
        {"`GL_NORMALIZE`", mode(GL_NORMALIZE), Effect::NONE, false,
         "Gradients are normalised whatever the transform."},
        {"`GL_RESCALE_NORMAL`", mode(GL_RESCALE_NORMAL), Effect::NONE, false,
         "Gradients are normalised whatever the transform."},
        {"ColorMatrix", setColorMatrix, Effect::NONE, false, "Concerns copies of pixels only."},
        {"Program", setProgram, Effect::NONE, true, OWN_PROGRAM},
        {"VertexProgram", setVertexProgram, Effect::NONE, true, OWN_PROGRAM},
        {"FragmentProgram", setFragmentProgram, Effect::NONE, true, OWN_PROGRAM},
        {"ShaderAttribute", setShaderAttribute, Effect::NONE, false, OWN_PROGRAM},
        {"Uniforms", setUniforms, Effect::NONE, false,
         std::string(OWN_PROGRAM) + " Whatever the names."},
        {"Defines", setDefines, Effect::NONE, false, OWN_PROGRAM},
    };
}

} // namespace test
} // namespace osgVolumizer
