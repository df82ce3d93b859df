#include "RayFunctions.h"

#include "../context/ShaderSource.h"

#include <osg/BlendEquation>

#include <iterator>

namespace osgVolumizer {
namespace render {

namespace {

using A = VolumeAppearance;

// Beyond every value, and still a float.
constexpr float LOWEST = -3e38f, HIGHEST = 3e38f;

RayFunctionRow composite()
{
    RayFunctionRow row{A::COMPOSITE, {"rays/composite.glsl"}};
    row.integratesLight = true;
    return row;
}

RayFunctionRow isosurface()
{
    RayFunctionRow row{A::ISOSURFACE, {"rays/isosurface.glsl"}};
    row.needsSlabs = row.needsOneComponent = row.showsIsoValueOnly = true;
    return row;
}

RayFunctionRow extreme(A::RayFunction function, const char* shader, GLenum equation, float empty)
{
    RayFunctionRow row{function, {shader, "rays/extreme.glsl"}};
    row.gathers = true;
    row.blendEquation = equation;
    row.emptyValue = empty;
    return row;
}

RayFunctionRow integral(A::RayFunction function, const char* shader)
{
    RayFunctionRow row{function, {shader, "rays/integral.glsl"}};
    row.needsOneComponent = row.gathers = true;
    row.blendEquation = osg::BlendEquation::FUNC_ADD;
    return row;
}

} // namespace

const RayFunctionRow& rowOf(VolumeAppearance::RayFunction function)
{
    using osg::BlendEquation;
    static const RayFunctionRow rows[] = {
        composite(),
        extreme(A::MAXIMUM, "rays/maximum.glsl", BlendEquation::RGBA_MAX, LOWEST),
        extreme(A::MINIMUM, "rays/minimum.glsl", BlendEquation::RGBA_MIN, HIGHEST),
        integral(A::AVERAGE, "rays/average.glsl"),
        integral(A::SUM, "rays/sum.glsl"),
        isosurface(),
    };
    static_assert(std::size(rows) == std::size(A::RAY_FUNCTION_NAMES), "a row for each name");
    return rows[function];
}

std::string rayShaderSource(VolumeAppearance::RayFunction function)
{
    std::string source;
    for (const std::string& file : rowOf(function).shaders)
        source += shaderSource(file);
    return source;
}

} // namespace render
} // namespace osgVolumizer
