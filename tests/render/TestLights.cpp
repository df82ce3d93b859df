#include "TestLights.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace osgVolumizer {
namespace test {

namespace blinn {
namespace {

// Central differences over a step, less at the last samples; in field units.
glm::dvec3 gradientOf(const oracle::Grid& grid, const glm::dvec3& p, double step)
{
    glm::dvec3 g;
    for (int a = 0; a < 3; ++a) {
        glm::dvec3 low = p, high = p;
        low[a] = std::max(p[a] - step, 0.0);
        high[a] = std::min(p[a] + step, double(grid.size()[a] - 1));
        g[a] = (grid.value(high) - grid.value(low)) / (high[a] - low[a]);
    }
    return g;
}

// The documented formula, in the eye frame.
glm::dvec3 lit(const glm::dvec3& color, const glm::dvec3& n, const glm::dvec3& eye,
               const glm::dvec3& toEye, const std::vector<TestLight>& lights,
               const glm::dmat4& view, const VolumeAppearance::Material& m)
{
    glm::dvec3 diffuse(m.ambient), specular(0.0);
    for (const TestLight& light : lights) {
        const glm::dvec4 position = view * light.position;
        glm::dvec3 l = glm::dvec3(position) - position.w * eye;
        const double d = glm::length(l);
        l /= d;
        double strength = 1.0;
        if (position.w != 0.0) strength /= glm::dot(light.attenuation, glm::dvec3(1.0, d, d * d));
        if (light.cutoffDegrees < 180.0) {
            const glm::dvec3 axis =
                glm::normalize(glm::dvec3(view * glm::dvec4(light.direction, 0.0)));
            const double cosine = glm::dot(-l, axis);
            strength *= cosine < std::cos(light.cutoffDegrees * M_PI / 180.0)
                            ? 0.0
                            : std::pow(std::max(cosine, 0.0), light.exponent);
        }
        diffuse += strength * (light.ambient + m.diffuse * std::abs(glm::dot(n, l)) * light.color);
        const glm::dvec3 h = glm::normalize(l + toEye);
        specular +=
            strength * m.specular * std::pow(std::abs(glm::dot(n, h)), m.shininess) * light.color;
    }
    return color * diffuse + specular;
}

} // namespace
} // namespace blinn

osg::ref_ptr<osg::LightSource> makeSource(const TestLight& light, int number, osg::StateSet& lit)
{
    osg::ref_ptr<osg::Light> l = new osg::Light(number);
    l->setPosition(
        osg::Vec4(light.position.x, light.position.y, light.position.z, light.position.w));
    l->setDirection(osg::Vec3(light.direction.x, light.direction.y, light.direction.z));
    l->setAmbient(osg::Vec4(light.ambient.r, light.ambient.g, light.ambient.b, 1));
    l->setDiffuse(osg::Vec4(light.color.r, light.color.g, light.color.b, 1));
    l->setSpecular(osg::Vec4(light.color.r, light.color.g, light.color.b, 1));
    l->setConstantAttenuation(light.attenuation.x);
    l->setLinearAttenuation(light.attenuation.y);
    l->setQuadraticAttenuation(light.attenuation.z);
    l->setSpotCutoff(light.cutoffDegrees);
    l->setSpotExponent(light.exponent);
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->setLight(l);
    source->setStateSetModes(lit, osg::StateAttribute::ON);
    return source;
}

std::vector<TestLight> someLights()
{
    TestLight point, sun, spot;
    point.position = {60, 10, 50, 1};
    point.attenuation = {0.5, 0.01, 0.0002};
    point.ambient = {0.05, 0.0, 0.1};
    sun.position = {-0.6, -0.5, 0.8, 0};
    sun.color = {0.2, 0.5, 0.9};
    spot.position = {10, -40, 10, 1};
    spot.direction = {0.1, 1, 0.05};
    spot.cutoffDegrees = 60.0; // all of the volume: its edge is not smooth
    spot.exponent = 4.0;
    spot.color = {0.9, 0.8, 0.1};
    return {point, sun, spot};
}

void lightOracle(oracle::Volume& volume, std::shared_ptr<oracle::Grid> grid,
                 const std::vector<TestLight>& lights, const support::RenderOptions& options,
                 const VolumeAppearance::Material& material, bool derivative)
{
    const glm::dmat4 view = support::toGlm(options.view);
    const glm::dmat3 toEye(view * volume.objectToWorld * glm::inverse(volume.objectToField));
    const glm::dmat3 normalToEye = glm::inverse(glm::transpose(toEye));
    const bool perspective = options.projection(3, 3) == 0.0;
    volume.shade = [=](const glm::dvec3& color, const glm::dvec3& field, const glm::dvec3& eye) {
        const glm::dvec3 g = normalToEye * blinn::gradientOf(*grid, field, derivative ? 1e-5 : 1.0);
        const double length = glm::length(g);
        const glm::dvec3 n = length > 0.0 ? g / length : g;
        const glm::dvec3 toViewer = perspective ? -glm::normalize(eye) : glm::dvec3(0, 0, 1);
        return blinn::lit(color, n, eye, toViewer, lights, view, material);
    };
}

} // namespace test
} // namespace osgVolumizer
