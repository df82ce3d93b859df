#pragma once

#include "../Export.h"
#include "../Status.h"
#include "../geometry/Box.h"
#include "../geometry/TetraSet.h"

#include <glm/mat4x4.hpp>

#include <cstdint>
#include <vector>

namespace osgVolumizer {

/// Which family of surfaces samples a volume.
enum class SamplingMode : int { VIEWPORT_ALIGNED, AXIS_ALIGNED, SPHERICAL };
/// Over which extent the family is spread, and so where its first surface lies.
enum class SamplingSpace : int { VIEW_VOLUME, OBJECT, PRIMITIVE };

namespace core {

/// A view of a tetra set: column-major matrices as in GLM. `toEye` maps the positions of the tetra
/// set to the eye frame (looking down -z); depth is -z.
struct View
{
    glm::dmat4 toEye{1.0};
    glm::dmat4 projection{1.0};
};

struct SamplingParameters
{
    SamplingMode mode = SamplingMode::VIEWPORT_ALIGNED;
    SamplingSpace space = SamplingSpace::OBJECT;
    /// Distance between samples along the view, in voxels, per voxel axis; 0.5 meets Nyquist.
    glm::dvec3 periodVoxel{1.0};
    /// No more surfaces than this, ever; the period grows to keep within it.
    int maximumSamples = 4096;
};

/// A run of faces, and the vertices and indices that they use.
struct FaceRange
{
    std::uint32_t firstFace = 0, faceCount = 0;
    std::uint32_t firstIndex = 0, indexCount = 0;
};

/// Convex polygons over shared vertex records (floats, ready for GL).
struct FaceSet
{
    VertexFormat format;
    std::vector<float> vertices;            ///< records of `format`
    std::vector<std::uint32_t> indices;     ///< polygons, one after another
    std::vector<std::uint32_t> faceOffsets; ///< face f is indices [faceOffsets[f], faceOffsets[f+1])
};

/// What polygonize() makes: faces per surface and brick, far to near.
struct PolygonizedFaces
{
    FaceSet faces;
    int surfaceCount = 0; ///< the number used, after bounding
    int brickCount = 0;
    /// Range of surface s (0 = farthest) and brick b: ranges[s * brickCount + b].
    std::vector<FaceRange> ranges;
    /// Depth of each surface (eye units; distance from the eye when SPHERICAL; position along the
    /// axis, in voxels, when AXIS_ALIGNED), descending in visibility.
    std::vector<double> surfaceDepths;
    /// Distance between neighbouring surfaces, in the units of surfaceDepths.
    double spacing = 0.0;
    /// AXIS_ALIGNED: 0, 1 or 2; else -1.
    int axis = -1;
};

} // namespace core
} // namespace osgVolumizer
