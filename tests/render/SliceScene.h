#pragma once

// Slices and what they should look like, in double precision.

#include "Volumes.h"

#include <osgVolumizer/VolumeSlice.h>

#include <oracles/Ray.h>

#include <glm/gtc/matrix_inverse.hpp>

#include <functional>
#include <optional>
#include <vector>

namespace osgVolumizer {
namespace test {

using support::FloatImage;
using support::RenderOptions;

/// Slices through the voxels of an appearance that has nothing else.
inline osg::ref_ptr<VolumeAppearance> slicedOnly(Voxels* voxels, const Points& points,
                                                 VolumeSlice* slice)
{
    osg::ref_ptr<VolumeAppearance> appearance = new VolumeAppearance;
    appearance->setVoxels(voxels);
    appearance->setLookupTable(makeTable(points));
    appearance->addChild(slice);
    return appearance;
}

/// What a pixel whose ray (world frame) meets a surface shows, premultiplied; nothing elsewhere.
using ColorOfRay =
    std::function<std::optional<glm::dvec4>(const glm::dvec3& origin, const glm::dvec3& direction)>;

inline FloatImage pictureOf(const RenderOptions& view, const ColorOfRay& color)
{
    const oracle::Camera camera = support::oracleCamera(view);
    const glm::dmat4 toWorld = glm::inverse(camera.view);
    FloatImage image(camera.width, camera.height);
    for (int y = 0; y < camera.height; ++y)
        for (int x = 0; x < camera.width; ++x) {
            const oracle::Ray ray = oracle::rayThrough(camera, x + 0.5, y + 0.5);
            const auto result = color(glm::dvec3(toWorld * glm::dvec4(ray.origin, 1.0)),
                                      glm::dvec3(toWorld * glm::dvec4(ray.direction, 0.0)));
            if (result) image.at(x, y) = glm::vec4(*result);
        }
    return image;
}

/// Where a ray meets the plane of the points p with dot(normal, p) + offset = 0.
inline glm::dvec3 meet(const core::Plane& plane, const glm::dvec3& origin,
                       const glm::dvec3& direction)
{
    return origin - plane.distance(origin) / glm::dot(plane.normal, direction) * direction;
}

inline bool isWithin(const glm::dvec3& p, const glm::dvec3& low, const glm::dvec3& high)
{
    for (int axis = 0; axis < 3; ++axis)
        if (p[axis] < low[axis] || p[axis] > high[axis]) return false;
    return true;
}

/// A plane through a point, normal of length 1.
inline core::Plane planeThrough(const glm::dvec3& point, const glm::dvec3& normal)
{
    const glm::dvec3 n = glm::normalize(normal);
    return {n, -glm::dot(n, point)};
}

/// The pixels that both pictures cover, with all about them.
inline support::Mask innerPixels(const FloatImage& a, const FloatImage& b)
{
    return support::eroded(support::coveredPixels(a), 1) &
           support::eroded(support::coveredPixels(b), 1);
}

/// How far two pictures are apart where both are covered, and how many pixels only one covers.
struct SliceDifference
{
    double maximum = 0.0;
    std::size_t pixels = 0, edge = 0;
};
inline SliceDifference differenceOf(const FloatImage& a, const FloatImage& b)
{
    SliceDifference result;
    const support::Mask inner = innerPixels(a, b);
    result.pixels = inner.count();
    result.maximum = support::compare(a, b, inner).maximum;
    const std::size_t either = (support::coveredPixels(a) | support::coveredPixels(b)).count();
    result.edge = either - (support::coveredPixels(a) & support::coveredPixels(b)).count();
    return result;
}

inline osg::Vec3d toOsgVec(const glm::dvec3& v)
{
    return {v.x, v.y, v.z};
}

} // namespace test
} // namespace osgVolumizer
