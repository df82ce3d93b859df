#pragma once

#include "Field.h"
#include "TetraMesh.h"

#include <osgVolumizer/core/geometry/TetraSet.h>

#include <glm/mat4x4.hpp>

#include <functional>

namespace osgVolumizer {
namespace oracle {

/// The tetrahedra that a hexahedron is cut into.
enum class HexahedronSplit
{
    FIVE, ///< mirrored in every other hexahedron, so that faces agree
    SIX   ///< around a diagonal (Kuhn)
};
/// Which hexahedra of a lattice there are.
using KeepHexahedron = std::function<bool(const glm::ivec3&)>;

/// The unit cube as a lattice of hexahedra, all or some of them, cut into tetrahedra of positive
/// volume. Points of no hexahedron are left out.
TetraMesh latticeMesh(const glm::ivec3& hexahedra, HexahedronSplit split = HexahedronSplit::FIVE,
                      const KeepHexahedron& keep = {});

/// Three quarters of the cube: without x and y above a half. Expects an even n.
TetraMesh cornerMesh(int n, HexahedronSplit split = HexahedronSplit::FIVE);
/// The cube with a square hole through its middle third along z. Expects a multiple of 3.
TetraMesh holeMesh(int n, HexahedronSplit split = HexahedronSplit::FIVE);
/// The cube's first and last third along x. Expects a multiple of 3.
TetraMesh twoPieceMesh(int n, HexahedronSplit split = HexahedronSplit::FIVE);
/// Three bars of length 1.8 in a triangle about the origin; seen from along +z each hides an end of
/// the next, so that no order of the bars is right. n hexahedra along each.
TetraMesh cyclicBars(int n);

/// Moves each point inside of the mesh by up to `amount` in each axis, by less where a cell would
/// lose more than nine tenths of its volume. Expects cells of positive volume, and keeps them so.
void jitter(TetraMesh& mesh, double amount, unsigned seed);
/// Makes slivers: of a fraction of the cells, moves one point inside of the mesh towards the face
/// opposite until `flatness` of the volume is left, where no other cell is inverted by that.
/// Returns how many cells it did that for; others that lie in one plane with them become flat too.
/// Expects cells of positive volume, and keeps them so.
std::size_t flatten(TetraMesh& mesh, double fraction, double flatness, unsigned seed);
/// Moves, turns, scales (affine map) all points.
void transform(TetraMesh& mesh, const glm::dmat4& map);
/// Adds the points and cells of another mesh.
void append(TetraMesh& mesh, const TetraMesh& other);

/// Points of faces that belong to one cell only: one flag a point.
std::vector<bool> boundaryPoints(const TetraMesh& mesh);

/// Sets the scalars of points, or of cells (at their centres), to those of a field in the object
/// frame, rounded to float, as the library takes them.
void sampleField(TetraMesh& mesh, const Field& field, bool perCell = false);
/// The points and cells, without scalars.
core::TetraSet tetraSet(const TetraMesh& mesh);

} // namespace oracle
} // namespace osgVolumizer
