#pragma once

#include "Field.h"
#include "Grid.h"
#include "Table.h"

#include <support/FloatImage.h>

#include <osgVolumizer/core/geometry/Box.h>

#include <glm/mat4x4.hpp>

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

namespace osgVolumizer {
namespace oracle {

/// A view, as GL has it: column-major matrices, rays through pixel centres, pixel (0, 0) at the
/// bottom left. Any projection whose rays are lines in the eye frame: perspective, orthographic,
/// off-axis.
struct Camera
{
    glm::dmat4 view{1.0}; ///< world to eye, looking down -z
    glm::dmat4 projection{1.0};
    int width = 0;
    int height = 0;
    double nearDepth = 0.0; ///< depth (-z in the eye frame) where rays start; may be -infinity
    double farDepth = std::numeric_limits<double>::infinity();
};

/// A convex region filled with a field, looked up in a table. Where regions overlap, extinctions
/// add and colours are weighted by extinction; so the tetrahedra of a set are one Volume each.
struct Volume
{
    std::vector<core::Plane> region; ///< half-spaces in the object frame
    glm::dmat4 objectToWorld{1.0};   ///< lengths are measured in the object frame
    glm::dmat4 objectToField{1.0};   ///< affine
    std::shared_ptr<const Field> field;
    Table table;       ///< of the field's values
    double unit = 1.0; ///< opacity unit, in object units
    /// Neither emits nor absorbs: what others emit in its region is multiplied by
    /// 1 - alpha + alpha * colour of its table.
    bool paint = false;
    /// Where set, these take the place of field and table: extinction times red, green and blue,
    /// and extinction, per unit.
    std::array<std::shared_ptr<const Field>, 4> medium;
    /// Where set: what a colour becomes at a place in the field frame that lies there in the eye
    /// frame.
    std::function<glm::dvec3(const glm::dvec3& color, const glm::dvec3& field,
                             const glm::dvec3& eye)>
        shade;
};

/// The volume of a box of voxels of `size` samples: object = origin + spacing * voxel, filled by a
/// field in the voxel frame; the unit is the mean spacing.
Volume voxelVolume(std::shared_ptr<const Field> field, const glm::ivec3& size, const Table& table,
                   const glm::dvec3& spacing = glm::dvec3(1.0),
                   const glm::dvec3& origin = glm::dvec3(0.0));
/// Lookup before interpolation: each sample of a grid is classified by the volume's table;
/// extinction times colour, and extinction, are then interpolated. Sets the volume's medium.
void classifySamples(Volume& volume, const Grid& samples, Grid::Interpolation how);
/// A box in the object frame, filled by a field in that frame.
Volume boxVolume(std::shared_ptr<const Field> field, const core::Box3d& box, const Table& table,
                 double unit = 1.0);
/// The half-spaces of a box, and of a tetrahedron in either orientation; a degenerate tetrahedron
/// gives an empty region.
std::vector<core::Plane> boxRegion(const core::Box3d& box);
std::vector<core::Plane> tetraRegion(const std::array<glm::dvec3, 4>& corners);
/// The affine map that takes the corners of a tetrahedron to four points. Expects a volume.
glm::dmat4 tetraMap(const std::array<glm::dvec3, 4>& from, const std::array<glm::dvec3, 4>& to);

/// Two-sided, unlit; colours are straight RGBA and interpolated linearly in the plane. One that is
/// opaque ends rays, others are composited with 'over'.
struct Triangle
{
    std::array<glm::dvec3, 3> corner; ///< world frame
    std::array<glm::dvec4, 3> color;
    bool opaque = false;
    int surface = 0; ///< triangles of one surface share edges that are not silhouettes
};

struct Scene
{
    std::vector<Volume> volumes;
    std::vector<Triangle> triangles;
    glm::dvec4 background{0.0}; ///< premultiplied
    /// Bound on the error of one smooth piece of a ray. A picture of 128^3 voxels is then good to
    /// better than 1e-9 (see SceneTest), which float pixels round to 6e-8.
    double tolerance = 1e-11;

    /// A surface of triangles of one colour (straight RGBA); corners by their number.
    void addMesh(const std::vector<glm::vec3>& points,
                 const std::vector<std::array<unsigned, 3>>& corners, const glm::dvec4& color,
                 bool opaque = false);
    /// Two triangles of one colour; corners in order.
    void addQuad(const std::array<glm::dvec3, 4>& corners, const glm::dvec4& color,
                 bool opaque = false);
};

/// Premultiplied RGBA along the ray through window position (x, y); pixel centres are at
/// half-integers. On coplanar triangles the first in the list is in front.
glm::dvec4 trace(const Scene& scene, const Camera& camera, double x, double y);
/// trace() for every pixel, in as many threads as there are cores.
support::FloatImage render(const Scene& scene, const Camera& camera);
/// Alpha 1 where no silhouette of a volume's region or of a surface passes within `margin` pixels
/// of the centre, else 0: there, rasterisers may rightly disagree.
support::FloatImage awayFromSilhouettes(const Scene& scene, const Camera& camera,
                                        double margin = 0.51);

} // namespace oracle
} // namespace osgVolumizer
