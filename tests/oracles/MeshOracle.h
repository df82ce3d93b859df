#pragma once

#include "BoxTree.h"
#include "MeshSegment.h"
#include "Quadrature.h"
#include "Scene.h"
#include "TetraMesh.h"

namespace osgVolumizer {
namespace oracle {

/// The light along any ray through a mesh of tetrahedra, by clipping the ray with each cell on its
/// own: nothing is walked and nothing is shared between cells. Cells without volume, or with a
/// point, scalar or colour that is not finite, are left out. Where cells overlap, the one entered
/// first is in sight until the ray leaves it, and others only from there on.
class MeshOracle
{
public:
    /// Expects as many scalars, or colours, as the mesh says, and indices within range. The table
    /// is one of data values. `unit`: opacity unit, object units. `tolerance`: bound on the error
    /// of each piece of a ray.
    MeshOracle(TetraMesh mesh, Table table, double unit, double tolerance = 1e-12);

    /// Premultiplied RGBA of what lies at origin + t direction (object frame) for t in
    /// [tNear, tFar]; these may be infinite.
    glm::dvec4 light(const glm::dvec3& origin, const glm::dvec3& direction, double tNear,
                     double tFar) const;
    /// The same along the ray through window position (x, y), over the camera's depths.
    glm::dvec4 light(const Camera& camera, const glm::dmat4& objectToWorld, double x,
                     double y) const;
    /// The segments in sight, front to back: none begins before the one before it ends.
    std::vector<MeshSegment> segments(const glm::dvec3& origin, const glm::dvec3& direction,
                                      double tNear, double tFar) const;

    const TetraMesh& mesh() const { return _mesh; }

private:
    bool isDrawn(const TetraMesh::Cell& cell, std::size_t number) const;
    void integrateSegment(const MeshSegment& segment, double length, Light& result) const;

    TetraMesh _mesh;
    Table _table;
    double _unit;
    double _tolerance;
    std::vector<std::uint32_t> _drawn; ///< numbers of cells, in the order of the tree's boxes
    BoxTree _tree;
};

/// Every `stride`-th pixel in x and y: pixel (x, y) of the result is pixel stride * (x, y) +
/// stride / 2 (rounded down) of the camera's picture.
support::FloatImage render(const MeshOracle& mesh, const Camera& camera,
                           const glm::dmat4& objectToWorld = glm::dmat4(1.0), int stride = 1);

} // namespace oracle
} // namespace osgVolumizer
