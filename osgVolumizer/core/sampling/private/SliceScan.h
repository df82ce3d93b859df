#pragma once

#include "../../private/LargePages.h"
#include "Slicer.h"
#include "TetraCases.h"

#include <array>

// The inner loops of Slicer: in plain C++, and with AVX2 and AVX-512 where the processor has them.
// All make the same faces of the same points to the bit; only the order of faces in a bin differs.
#if defined(__x86_64__)
#define OSGVOLUMIZER_DISPATCH_AVX2 1
#define OSGVOLUMIZER_AVX2 __attribute__((target("avx2")))
#endif

namespace osgVolumizer {
namespace core {

/// What the inner loops may use of what the processor has: all, unless a test asks for less.
enum class Instructions : int
{
    PLAIN,
    AVX2,
    AVX512
};
void limitInstructions(Instructions most);
Instructions instructionLimit();

/// What one face of each case adds to its bin: 4 indices where two vertices are on either side,
/// else 3. The cases without a face do not occur.
inline constexpr std::array<Slicer::Count, 16> FACE_COUNTS = [] {
    std::array<Slicer::Count, 16> counts{};
    for (std::size_t mask = 0; mask < 16; ++mask)
        counts[mask] = Slicer::count(1, static_cast<std::uint32_t>(TETRA_CASES[mask].count));
    return counts;
}();

/// What listLayers() finds in a block: surfaces base + [lowest, highest) meet it.
struct PassedRange
{
    int lowest, highest;
};

/// Fills in the layer coordinates of a block's vertices, and how many surfaces from `base` on,
/// `end` excluded, each has passed. Expects room for TetraBlocks::MAX_VERTICES in `passed`.
PassedRange listLayers(const SlicePlan& plan, const TetraBlocks::Block& block, int base, int end,
                       double* layers, int* passed);

/// To be called before listFaces() and listPoints() of a block.
/// \param highest the largest of the numbers that count
void packPassed(const int* passed, int highest, Slicer::Work& work);

/// Adds an entry to `work` for every surface that meets one of `count` tetrahedra of a block,
/// beginning with number `first`. `passed` belongs to the block's vertices.
void listFaces(const TetraBlocks::Tetra* tetrahedra, std::uint32_t first, std::uint32_t count,
               const int* passed, Slicer::Work& work);

/// Fills work.points and work.edgePoints for the edges of a block.
void listPoints(const TetraBlocks::Edge* edges, std::uint32_t count, const int* passed,
                Slicer::Work& work);

/// Makes work.points, and uses them up. Writes nothing beyond the last.
void writePoints(const TetraBlocks& blocks, const TetraBlocks::Block& block, const double* layers,
                 int base, Slicer::Work& work, float* to);

/// Where the faces of one block come from and go to.
struct Emission
{
    const std::uint32_t *entries, *endEntries;
    const TetraBlocks::TetraEdges* tetraEdges;
    const TetraBlocks::Place* places; ///< per tetrahedron; null where all are in one brick
    std::uint32_t brickCount;
    const std::uint32_t* edgePoints;
    Slicer::Count* cursors; ///< of surface `base`, and of the block's brick if that is one
    std::uint32_t *indices, *faceOffsets;
};

void emitFaces(const Emission& emission);

#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
namespace avx2 {

bool available();
PassedRange listLayers(const SlicePlan& plan, const double* record, std::size_t stride,
                       std::uint32_t count, int base, int end, double* layers, int* passed);
void listFaces(const TetraBlocks::Tetra* tetrahedra, std::uint32_t first, std::uint32_t end,
               const int* passed, Slicer::Work& work);
void listPoints(const TetraBlocks::Edge* edges, std::uint32_t count, const int* passed,
                Slicer::Work& work);
void weighPoints(const double* layers, int base, std::size_t count, std::uint32_t* points,
                 double* weights);
void emitFaces(const Emission& emission);

} // namespace avx2

namespace avx512 {

/// VBMI, which looks up bytes, and what comes with it: Ice Lake, Zen 4 and later.
bool available();
void packPassed(const int* passed, Slicer::Work& work);
std::uint32_t listFaces(const TetraBlocks::Tetra* tetrahedra, std::uint32_t first,
                        std::uint32_t end, const int* passed, Slicer::Work& work);
std::uint32_t listPoints(const TetraBlocks::Edge* edges, std::uint32_t count, const int* passed,
                         Slicer::Work& work);
std::size_t weighPoints(const double* layers, int base, std::size_t count, std::uint32_t* points,
                        double* weights);

} // namespace avx512
#endif

// One of each, for what is left over after groups of four or eight.

inline void listLayer(const SlicePlan& plan, double depth, int base, int end, double& layer,
                      int& passed, PassedRange& range)
{
    layer = (plan.lattice.farDepth - depth) * (1.0 / plan.lattice.spacing);
    passed = surfacesPassed(layer, base, end) - base;
    range.lowest = passed < range.lowest ? passed : range.lowest;
    range.highest = passed > range.highest ? passed : range.highest;
}

void listFace(const TetraBlocks::Tetra& tetra, std::uint32_t t, const int* passed,
              Slicer::Work& work);
void listEdge(const TetraBlocks::Edge& edge, std::uint32_t i, const int* passed,
              Slicer::Work& work);

/// Turns a point of Work::points into its far, near and nearer vertex (8 bits each, the latter 16
/// up), and sets the weight; see Between.
inline void weighPoint(const double* layers, int base, std::uint32_t& point, double& weight)
{
    const std::uint32_t a = point & 0xffu, b = point >> 8 & 0xffu;
    const double surface = base + static_cast<int>(point >> 16) + 0.5;
    const double t = (surface - layers[a]) / (layers[b] - layers[a]);
    weight = t < 0.5 ? t : t - 1.0;
    point = (point & 0xffffu) | (t < 0.5 ? a : b) << 16;
}

} // namespace core
} // namespace osgVolumizer
