#include "SceneLights.h"

#include "../context/PositionedAttributes.h"

#include <osg/Light>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

glm::vec3 rgb(const osg::Vec4& c)
{
    return {c.r(), c.g(), c.b()};
}

EyeLight inEyeFrame(const osg::Light& light, const osg::Matrixd& toEye)
{
    EyeLight result;
    result.number = static_cast<unsigned>(light.getLightNum());
    const osg::Vec4d p = osg::Vec4d(light.getPosition()) * toEye;
    result.position = glm::vec4(p.x(), p.y(), p.z(), p.w());
    if (p.w() != 0.0) result.position /= result.position.w;
    result.ambient = rgb(light.getAmbient());
    result.diffuse = rgb(light.getDiffuse());
    result.specular = rgb(light.getSpecular());
    result.attenuation = {light.getConstantAttenuation(), light.getLinearAttenuation(),
                          light.getQuadraticAttenuation()};
    const osg::Vec3d d = osg::Matrixd::transform3x3(osg::Vec3d(light.getDirection()), toEye);
    const double length = d.length();
    if (light.getSpotCutoff() < 180.0f && p.w() != 0.0 && length > 0.0)
        result.spot = glm::vec4(d.x() / length, d.y() / length, d.z() / length,
                                std::cos(osg::DegreesToRadians(light.getSpotCutoff())));
    result.spotExponent = light.getSpotExponent();
    return result;
}

} // namespace

// A light that is set again replaces the one of the same number, as in GL.
std::vector<EyeLight> lightsOf(osgUtil::RenderStage& stage)
{
    std::vector<EyeLight> lights;
    for (const auto& positioned : positionedAttributes<osg::Light>(stage)) {
        const EyeLight made = inEyeFrame(*positioned.first, positioned.second);
        const auto same = std::find_if(lights.begin(), lights.end(),
                                       [&](const EyeLight& l) { return l.number == made.number; });
        if (same != lights.end())
            *same = made;
        else
            lights.push_back(made);
    }
    return lights;
}

double brightnessOf(const std::vector<EyeLight>& lights)
{
    double sum = 0.0;
    for (const EyeLight& light : lights) {
        const glm::vec3 most = glm::max(light.diffuse, light.specular);
        sum += std::max({most.r, most.g, most.b, 0.0f});
    }
    return sum;
}

std::vector<EyeLight> enabledLights(const std::vector<EyeLight>& lights, const osg::State& state)
{
    std::vector<EyeLight> result;
    for (const EyeLight& light : lights)
        if (state.getLastAppliedMode(GL_LIGHT0 + light.number) && result.size() < MAXIMUM_LIGHTS)
            result.push_back(light);
    if (!result.empty()) return result;
    EyeLight head;
    head.position = {0.0f, 0.0f, 1.0f, 0.0f};
    head.diffuse = head.specular = glm::vec3(1.0f);
    return {head};
}

} // namespace render
} // namespace osgVolumizer
