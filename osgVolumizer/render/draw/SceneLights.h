#pragma once

#include <osg/State>
#include <osgUtil/RenderStage>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <vector>

namespace osgVolumizer {
namespace render {

/// One osg::Light in the eye frame.
struct EyeLight
{
    unsigned number = 0;      ///< GL_LIGHT0 + number switches it
    glm::vec4 position{0.0f}; ///< w = 0: the direction to it
    glm::vec3 ambient{0.0f}, diffuse{0.0f}, specular{0.0f};
    glm::vec3 attenuation{1.0f, 0.0f, 0.0f};  ///< constant, linear, quadratic
    glm::vec4 spot{0.0f, 0.0f, -1.0f, -1.0f}; ///< direction, cosine of the cone; -1: none
    float spotExponent = 0.0f;
};

/// Most lights that a volume is lit by, as in OpenGL's fixed pipeline.
constexpr std::size_t MAXIMUM_LIGHTS = 8;

/// The lights of a render stage and of the stages it inherits from, once the cull traversal is
/// over. OSG keeps them per stage, with the model-view of each; no GL state is read, so core
/// profiles work too.
std::vector<EyeLight> lightsOf(osgUtil::RenderStage& stage);

/// All of them together: the sum of the strongest colour component of each, diffuse or specular.
double brightnessOf(const std::vector<EyeLight>& lights);

/// Those of them that are switched on for what is drawn now, at most MAXIMUM_LIGHTS; a white head
/// light where none is, so that a lit volume is seen in a scene without lights.
std::vector<EyeLight> enabledLights(const std::vector<EyeLight>& lights, const osg::State& state);

} // namespace render
} // namespace osgVolumizer
