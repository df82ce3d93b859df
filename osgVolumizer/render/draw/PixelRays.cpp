#include "PixelRays.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace render {

namespace {

bool finite(const glm::dmat3& m)
{
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            if (!std::isfinite(m[c][r])) return false;
    return true;
}

// The pixel centre nearest to the projection of a point, kept inside the viewport.
glm::dvec2 windowOf(const glm::dvec4& clip, const glm::dvec4& viewport)
{
    glm::dvec2 result;
    for (int i = 0; i < 2; ++i) {
        const double ndc = clip.w > 0.0 ? std::clamp(clip[i] / clip.w, -1.0, 1.0) : 0.0;
        const double offset = 0.5 * (ndc + 1.0) * viewport[2 + i];
        result[i] = viewport[i] + std::floor(std::isfinite(offset) ? offset : 0.0) + 0.5;
    }
    return result;
}

} // namespace

Result<PixelRays> pixelRays(const glm::dmat4& toEye, const glm::dmat4& projection,
                            const glm::dvec4& viewport, double referenceDepth,
                            const glm::dvec3& center)
{
    // Row r, column c of the projection is projection[c][r].
    const glm::dmat4& p = projection;
    if (p[0][3] != 0.0 || p[1][3] != 0.0)
        return Status(ErrorCode::NOT_SUPPORTED, "projection: clip w depends on x or y");
    const glm::dmat3 linear = glm::inverse(glm::dmat3(toEye));
    const glm::dmat2 xy = glm::inverse(glm::dmat2(p));
    if (!finite(linear)) return Status(ErrorCode::SINGULAR_MATRIX, "model-view matrix is singular");

    PixelRays rays;
    rays.windowCenter = windowOf(p * (toEye * glm::dvec4(center, 1.0)), viewport);
    const glm::dvec2 pixel(2.0 / viewport.z, 2.0 / viewport.w);
    const glm::dvec2 ndc = (rays.windowCenter - glm::dvec2(viewport)) * pixel - 1.0;
    // At z = -(reference + t): clip w = w0 + t w1, and A (x, y) = ndc w - B z - C.
    const double w0 = p[3][3] - p[2][3] * referenceDepth, w1 = -p[2][3];
    const glm::dvec2 b(p[2][0], p[2][1]), c(p[3][0], p[3][1]);
    glm::dmat3& originEye = rays.originEye;
    originEye = glm::dmat3(0.0);
    originEye[0] = glm::dvec3(xy * glm::dvec2(pixel.x * w0, 0.0), 0.0);
    originEye[1] = glm::dvec3(xy * glm::dvec2(0.0, pixel.y * w0), 0.0);
    originEye[2] = glm::dvec3(xy * (ndc * w0 + b * referenceDepth - c), -referenceDepth);
    rays.directionEye[0] = glm::dvec3(xy * glm::dvec2(pixel.x * w1, 0.0), 0.0);
    rays.directionEye[1] = glm::dvec3(xy * glm::dvec2(0.0, pixel.y * w1), 0.0);
    rays.directionEye[2] = glm::dvec3(xy * (ndc * w1 + b), -1.0);

    glm::dmat3 fromTranslation = originEye;
    fromTranslation[2] -= glm::dvec3(toEye[3]);
    rays.origin = linear * fromTranslation;
    rays.direction = linear * rays.directionEye;
    if (!finite(rays.origin) || !finite(rays.direction))
        return Status(ErrorCode::SINGULAR_MATRIX, "projection matrix is singular");

    const glm::dvec3 rowZ(p[0][2], p[1][2], p[2][2]);
    rays.clipZOrigin = rowZ * originEye + glm::dvec3(0.0, 0.0, p[3][2]);
    rays.clipZDirection = rowZ * rays.directionEye;
    rays.clipWOrigin = {0.0, 0.0, w0};
    rays.clipWDirection = {0.0, 0.0, w1};
    return rays;
}

} // namespace render
} // namespace osgVolumizer
