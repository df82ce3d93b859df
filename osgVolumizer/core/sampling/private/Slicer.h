#pragma once

#include "../../geometry/BoxIndex.h"
#include "../../geometry/TetraBlocks.h"
#include "../Polygonize.h"
#include "../SurfaceFamily.h"
#include "ClipRecords.h"

#include <array>
#include <cstdint>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Where the depths of a tetrahedron end.
struct DepthRange
{
    double nearest, farthest;
};

/// What one pass over a blocked tetra set has to know. Depths are relative to an anchor, positions
/// and clip boxes to the origin of the blocks.
struct SlicePlan
{
    const TetraBlocks* blocks = nullptr;
    const BoxIndex* boxes = nullptr;
    /// Depth of a vertex: dot(gradient, field - corner), unless `depths` gives it per source
    /// vertex.
    int depthField = 0;
    glm::dvec3 gradient{0.0};
    glm::dvec3 corner{0.0};
    const double* depths = nullptr;
    SurfaceLattice lattice;
    int firstSurface = 0, surfaceCount = 0; ///< those that get faces
    const int* order = nullptr; ///< place i of the output is for surface firstSurface + order[i]
    int brickCount = 1;
    bool primitive = false;
    /// PRIMITIVE: the depths over which the layers of each source tetrahedron are spread, where
    /// those are not its own because it is a piece of another; or null.
    const DepthRange* primitiveRanges = nullptr;
    /// Convex pieces, as half-spaces relative to the origin, that faces are cut down to; or null.
    const std::vector<std::vector<Plane>>* pieces = nullptr;
    /// Whether every face needs the general way.
    bool general() const { return primitive || pieces; }
    /// Blocks that lie outside one of these half-spaces are left out.
    std::vector<Plane> visible;
};

/// Why doubles suffice, however thin a tetrahedron is. Which surfaces meet it is decided by one
/// number per vertex, its layer coordinate, rounded once, by the same operations wherever the
/// vertex is used; comparing that with k + 1/2 is exact (see surfacesPassed()). From these bits all
/// else follows without arithmetic: the case of a tetrahedron, which of its edges carry points, and
/// which pair of edges is joined in each of its faces. The last depends on the face's own three
/// vertices, so the two tetrahedra at a face agree. The side on which faces are seen follows from
/// the sign of the tetrahedron, which is exact (orientationSign()). A point is computed from the
/// two ends of its edge, far to near, and lies between them (Between). So faces meet edge to edge,
/// with one orientation, for slivers as for any other: rounding can move a surface, but not tear
/// it.
///
/// How far: the layer coordinate is off by at most 8 u (|gradient| |p - corner| + |farDepth|) /
/// spacing, u = 2^-53, which moves the surface by as many layers; a point on its edge by as much
/// and 3 u of the edge's length. Areas of faces in double precision (sample()) add up to that of
/// the cross section to 1e-12 of it. Here points are rounded to float at last, relative to the
/// origin of the blocks: single faces are as accurate as that, but since they share their points,
/// the vector areas of a surface add up to that of its outline.
///
/// Cuts blocks of tetrahedra in two passes: the first finds out which surfaces meet which
/// tetrahedra and counts, the second writes points and faces to their final places. In a block
/// every point is made once, on its edge, and shared by the faces around that edge. Tetrahedra that
/// need clipping are cut in the first pass already and copied in the second. All memory is kept.
class Slicer
{
public:
    /// TOO_LARGE for more pairs of surface and brick than there is room for.
    static Status checkSize(const SlicePlan& plan);
    /// Expects checkSize(). Fills faces, ranges and faceSpacings of `out`. TOO_LARGE where they
    /// have too many corners or do not fit in memory; `out` is empty then.
    Status run(const SlicePlan& plan, PolygonizedFaces& out);

    /// Depth of a vertex, from its record.
    static double depthOf(const SlicePlan& plan, const double* record, std::uint32_t source)
    {
        if (plan.depths) return plan.depths[source];
        const double* p = record + plan.depthField;
        return plan.gradient.x * (p[0] - plan.corner.x) + plan.gradient.y * (p[1] - plan.corner.y) +
               plan.gradient.z * (p[2] - plan.corner.z);
    }

    /// Bounds of the depths in a block, by one box test; a little wider than rounding needs. All
    /// depths there may be, where they are not those of planes.
    static void depthRange(const SlicePlan& plan, const TetraBlocks::Block& block, double& nearest,
                           double& farthest);

    /// Faces and indices of a bin in one number, so that one addition counts both. A bin is a pair
    /// of surface and brick: (surface - firstSurface) * brickCount + brick.
    using Count = std::uint64_t;
    static constexpr Count count(std::uint32_t faces, std::uint32_t indices)
    {
        return Count(faces) << 32 | indices;
    }
    static std::uint32_t faceCount(Count c) { return static_cast<std::uint32_t>(c >> 32); }
    static std::uint32_t indexCount(Count c) { return static_cast<std::uint32_t>(c); }

    /// What the first pass leaves to the second about a block.
    struct BlockFaces
    {
        std::size_t endEntry = 0; ///< in Work::entries
        int base = 0;             ///< the surface that entries and points count from
        int highest = 0;          ///< the most that a vertex has passed, from there on
    };
    /// A block that spans more surfaces takes the general way, so that 16 bits hold the number.
    static constexpr int MAX_BLOCK_SURFACES = 0xffff;

    /// What is under way between the passes.
    struct Work
    {
        /// Faces to make, block after block: surface << 14 | tetrahedron of the block << 4 | case.
        std::vector<std::uint32_t> entries;
        std::size_t entryCount = 0;
        std::vector<BlockFaces> blockFaces; ///< points are made only where there are any
        std::vector<Count> fast, clipped;   ///< per bin: first counts, then cursors
        std::size_t vertexCount = 0;        ///< made so far
        // Faces that were clipped, in the order of making. Their points come before the shared
        // ones.
        std::vector<std::uint32_t> bins;
        std::vector<std::uint16_t> sizes;
        std::vector<float> vertices; ///< those of the faces to be, while blocks are counted
        std::size_t valueCount = 0;  ///< in `vertices`
        std::vector<float> spacings;
        RecordPolygon polygon;
        RecordPolygon::Shape whole, uncut; ///< before it is cut to a box, and to a piece
        /// Scratch of one block: its points (surface << 16 | near vertex << 8 | far vertex), and
        /// for each edge the number of its point on surface 0, if it had one.
        std::vector<std::uint32_t> points;
        std::size_t pointCount = 0;
        std::vector<std::uint32_t> edgePoints;
        std::vector<double> weights;
        /// How many surfaces the block's vertices have passed, where all numbers fit into bytes and
        /// the processor can look them up; see packPassed().
        alignas(64) std::array<std::uint8_t, TetraBlocks::MAX_VERTICES> passedBytes;
        bool hasPassedBytes = false;
    };

private:
    void countBlocks(const SlicePlan& plan);
    BlockFaces countBlock(const SlicePlan& plan, const TetraBlocks::Block& block);
    bool placeBins(const SlicePlan& plan, PolygonizedFaces& out);
    bool emitBlocks(const SlicePlan& plan, PolygonizedFaces& out);
    void emitClipped(const SlicePlan& plan, PolygonizedFaces& out);

    Work _work;
    // Per vertex of the blocks:
    std::vector<double> _layers; ///< layer coordinate: surface k is at k + 1/2
    std::vector<int>
        _passed; ///< surfaces from the block's base on, on the near side of which it is
};

/// Number of surfaces on the near side of which a vertex with layer coordinate f lies. Surface k is
/// at k + 1/2, and a vertex on it belongs to its far side. The subtraction is exact wherever the
/// result matters: for f in [1/4, 1] by Sterbenz' lemma, above because f - 1/2 has no finer
/// digits than f.
inline int surfacesPassed(double f, int first, int last)
{
    double g = f - 0.5;
    g = g < first ? first : g;
    g = g > last ? last : g;
    const int n = static_cast<int>(g);
    return n + (g > n ? 1 : 0);
}

/// Cuts one tetrahedron the general way, clips the faces to the boxes and appends them to the
/// work.
/// \param layers layer coordinates of the block's vertices
void clipTetra(const SlicePlan& plan, const TetraBlocks::Block& block, std::uint32_t tetrahedron,
               const double* layers, Slicer::Work& work);

} // namespace core
} // namespace osgVolumizer
