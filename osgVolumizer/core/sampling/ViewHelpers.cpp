#include "ViewHelpers.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

constexpr double SINGULAR = 1e-12;
constexpr double AFFINE = 1e-14; ///< what a few roundings can do to the last row

Status singular(const char* what)
{
    return {ErrorCode::SINGULAR_MATRIX, std::string("View: the ") + what + " matrix is singular."};
}

glm::dvec4 row(const glm::dmat4& m, int r)
{
    return {m[0][r], m[1][r], m[2][r], m[3][r]};
}

/// Determinant over the product of the column lengths, in [0, 1], whatever the scale of each axis.
/// Columns are normalised first, so that nothing overflows.
double relativeVolume(const glm::dmat3& m)
{
    glm::dmat3 n;
    for (int c = 0; c < 3; ++c) {
        const double largest = std::max({std::abs(m[c].x), std::abs(m[c].y), std::abs(m[c].z)});
        if (!(largest > 0.0) || !std::isfinite(largest)) return 0.0;
        const glm::dvec3 scaled = m[c] / largest;
        n[c] = scaled / glm::length(scaled);
    }
    return std::abs(glm::determinant(n));
}

/// Whether the matrix has no usable inverse.
bool isSingular(const glm::dmat3& m)
{
    // The negated test also catches NaN.
    return !(relativeVolume(m) > SINGULAR);
}

/// The vector that is orthogonal to three vectors of four dimensions.
glm::dvec4 cross4(const glm::dvec4& a, const glm::dvec4& b, const glm::dvec4& c)
{
    glm::dvec4 r;
    for (int i = 0; i < 4; ++i) {
        const int j = (i + 1) % 4, k = (i + 2) % 4, l = (i + 3) % 4;
        const double minor =
            glm::determinant(glm::dmat3(a[j], a[k], a[l], b[j], b[k], b[l], c[j], c[k], c[l]));
        r[i] = i % 2 == 0 ? minor : -minor;
    }
    return r;
}

double largest(const glm::dvec4& v)
{
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z), std::abs(v.w)});
}

/// Whether the last row is (0, 0, 0, 1), as it is after matrices were multiplied and inverted: an
/// entry counts in proportion to its column, since their ratio is a distance in the eye frame.
bool isAffine(const glm::dmat4& m)
{
    const glm::dvec4 r = row(m, 3);
    for (int c = 0; c < 3; ++c) {
        const glm::dvec3 a = glm::abs(glm::dvec3(m[c]));
        if (!(std::abs(r[c]) <= AFFINE * std::max({a.x, a.y, a.z}))) return false;
    }
    return std::abs(r.w - 1.0) <= AFFINE;
}

} // namespace

Result<glm::dmat4> fromEye(const View& view)
{
    const glm::dmat3 linear(view.toEye);
    const glm::dvec4& t = view.toEye[3];
    if (isSingular(linear) || !isAffine(view.toEye) || !std::isfinite(t.x) || !std::isfinite(t.y) ||
        !std::isfinite(t.z))
        return singular("model-view");
    const glm::dmat3 inverse = glm::inverse(linear);
    glm::dmat4 r(inverse);
    r[3] = glm::dvec4(-(inverse * glm::dvec3(t)), 1.0);
    return r;
}

Result<glm::dvec4> eyePosition(const View& view)
{
    const Result<glm::dmat4> inverse = fromEye(view);
    if (!inverse) return inverse.status;
    // The centre of projection is the only point whose x, y and w all vanish.
    glm::dvec4 rows[3] = {row(view.projection, 0), row(view.projection, 1),
                          row(view.projection, 3)};
    for (glm::dvec4& r : rows) {
        const double size = largest(r);
        if (!(size > 0.0) || !std::isfinite(size)) return singular("projection");
        r /= size;
    }
    glm::dvec4 eye = cross4(rows[0], rows[1], rows[2]);
    const double size = largest(eye);
    if (!(size > SINGULAR)) return singular("projection");
    eye /= size;
    if (std::abs(eye.w) > SINGULAR) {
        const glm::dvec4 p = *inverse * (eye / eye.w);
        return glm::dvec4(glm::dvec3(p), 1.0);
    }
    if (eye.z < 0.0) eye = -eye;
    const glm::dvec3 direction = glm::dmat3(*inverse) * glm::dvec3(eye);
    return glm::dvec4(glm::normalize(direction), 0.0);
}

Result<glm::dvec3> viewDirectionAt(const View& view, const glm::dvec3& position)
{
    const Result<glm::dvec4> eye = eyePosition(view);
    if (!eye) return eye.status;
    if (eye->w == 0.0) return -glm::dvec3(*eye);
    const glm::dvec3 ray = position - glm::dvec3(*eye);
    const double length = glm::length(ray);
    if (!(length > 0.0)) return glm::normalize(-glm::dvec3((*fromEye(view))[2]));
    return ray / length;
}

Result<ViewAxis> closestAxis(const View& view, const glm::dvec3& position,
                             const glm::dvec3& voxelSize)
{
    const Result<glm::dvec3> direction = viewDirectionAt(view, position);
    if (!direction) return direction.status;
    const glm::dvec3 voxels = *direction / voxelSize;
    ViewAxis r;
    r.axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(voxels[i]) > std::abs(voxels[r.axis])) r.axis = i;
    r.sign = voxels[r.axis] < 0.0 ? -1 : 1;
    return r;
}

Result<NearFar> nearFar(const glm::dmat4& projection)
{
    // On the axis x = y = 0 of the eye frame: z-row +- w-row vanish at -near and -far.
    const double zz = projection[2][2], zw = projection[3][2];
    const double wz = projection[2][3], ww = projection[3][3];
    const double nearSlope = zz + wz, farSlope = zz - wz;
    const double scale = std::max(std::abs(zz), std::abs(wz));
    if (!(scale > 0.0) || !std::isfinite(scale) || !std::isfinite(zw) || !std::isfinite(ww) ||
        nearSlope == 0.0)
        return singular("projection");
    NearFar r;
    r.nearDepth = (zw + ww) / nearSlope;
    r.farDepth = farSlope == 0.0 ? std::numeric_limits<double>::infinity() : (zw - ww) / farSlope;
    if (!(r.nearDepth < r.farDepth)) return singular("projection");
    return r;
}

} // namespace core
} // namespace osgVolumizer
