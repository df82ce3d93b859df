#pragma once

#include <oracles/Scene.h>
#include <support/SceneRenderer.h>

#include <cstring>
#include <limits>

namespace osgVolumizer {
namespace support {

/// The same map: OSG's row vectors times row-major matrices are GLM's column-major matrices times
/// columns.
inline glm::dmat4 toGlm(const osg::Matrixd& m)
{
    glm::dmat4 result;
    std::memcpy(&result[0][0], m.ptr(), sizeof(result));
    return result;
}

/// The oracle's camera for what renderScene() does with `options`. Rays start at the eye in
/// perspective, and infinitely far behind it in orthographic views.
inline oracle::Camera oracleCamera(const RenderOptions& options)
{
    oracle::Camera camera;
    camera.view = toGlm(options.view);
    camera.projection = toGlm(options.projection);
    camera.width = options.width;
    camera.height = options.height;
    if (options.projection(3, 3) != 0.0)
        camera.nearDepth = -std::numeric_limits<double>::infinity();
    return camera;
}

} // namespace support
} // namespace osgVolumizer
