#include "Slicer.h"
#include "TetraCases.h"

#include <cstring>

// Vector types of GCC and Clang: four doubles, in one register or two, whatever the target has. The
// same IEEE operations in the same order give the same bits either way.
#define OSGVOLUMIZER_INLINE inline __attribute__((always_inline))
#if defined(__x86_64__) && !defined(__AVX2__)
#define OSGVOLUMIZER_DISPATCH_AVX2 1
#endif

namespace osgVolumizer {
namespace core {

namespace {

using Double4 = double __attribute__((vector_size(32)));
using Float4 = float __attribute__((vector_size(16)));

OSGVOLUMIZER_INLINE void load(Double4& v, const double* p) { std::memcpy(&v, p, sizeof v); }

/// Interpolates a record of S values and writes it. The last group of four starts at S - 4, so that
/// nothing is written beyond the record.
template <int S>
OSGVOLUMIZER_INLINE void writeRecord(float* to, const double* a, const double* b, double t)
{
    if constexpr (S == 3) {
        // Four values are read, the spare one included; three are written.
        Double4 p, q;
        load(p, a);
        load(q, b);
        const Float4 r = __builtin_convertvector(p + t * (q - p), Float4);
        std::memcpy(to, &r, 8);
        const float z = r[2];
        std::memcpy(to + 2, &z, 4);
    } else {
        for (int k = 0; k < S; k += 4) {
            const int at = k + 4 > S ? S - 4 : k;
            Double4 p, q;
            load(p, a + at);
            load(q, b + at);
            const Float4 r = __builtin_convertvector(p + t * (q - p), Float4);
            std::memcpy(to + at, &r, sizeof r);
        }
    }
}

/// S values per record, or any number where S is 0.
template <int S>
OSGVOLUMIZER_INLINE void emitBlock(const SlicePlan& plan, Slicer::Chunk& chunk,
                                   const SliceTarget& target, const TetraBlocks::Block& block,
                                   std::size_t begin, std::size_t end)
{
    const TetraBlocks& blocks = *plan.blocks;
    const std::size_t stride = S > 0 ? S : blocks.recordSize() - 1;
    const std::size_t size = stride + 1;
    const double* records = blocks.record(block.firstVertex);
    const TetraBlocks::Tetra* tetrahedra = blocks.tetrahedra.data() + block.firstTetra;
    const TetraBlocks::Place* places =
        blocks.places.empty() ? nullptr : blocks.places.data() + block.firstTetra;
    const auto brickCount = static_cast<std::uint32_t>(plan.brickCount);
    const std::uint64_t* entries = chunk.entries.data();
    Slicer::Count* cursors = chunk.fast.data();
    for (std::size_t i = begin; i < end; ++i) {
        const std::uint64_t e = entries[i];
        const auto surface = static_cast<int>(e >> 32);
        const std::size_t t = e >> 8 & 0xffffffu;
        const TetraCase& which = TETRA_CASES[e & 15u];
        std::size_t bin =
            static_cast<std::uint32_t>(plan.rank[surface - plan.firstSurface]) * brickCount;
        if (places) bin += places[t] & TetraBlocks::BOX_MASK;
        const Slicer::Count cursor = cursors[bin];
        cursors[bin] = cursor + Slicer::count(1, static_cast<std::uint32_t>(which.count));
        target.faceOffsets[Slicer::faceCount(cursor)] = Slicer::vertexCount(cursor);
        float* to = target.vertices + Slicer::vertexCount(cursor) * stride;

        const double *a[4], *b[4];
        for (int c = 0; c < 4; ++c) {
            a[c] = records + size * tetrahedra[t].v[which.farVertex[static_cast<std::size_t>(c)]];
            b[c] = records + size * tetrahedra[t].v[which.nearVertex[static_cast<std::size_t>(c)]];
        }
        const Double4 fa{a[0][stride], a[1][stride], a[2][stride], a[3][stride]};
        const Double4 fb{b[0][stride], b[1][stride], b[2][stride], b[3][stride]};
        const Double4 weight = (surface + 0.5 - fa) / (fb - fa);
        if constexpr (S > 0) {
            writeRecord<S>(to, a[0], b[0], weight[0]);
            writeRecord<S>(to + S, a[1], b[1], weight[1]);
            writeRecord<S>(to + 2 * S, a[2], b[2], weight[2]);
            // Of a triangle the last corner is the third once more.
            writeRecord<S>(to + (which.count - 1) * S, a[3], b[3], weight[3]);
        } else {
            for (int c = 0; c < which.count; ++c)
                for (std::size_t k = 0; k < stride; ++k)
                    *to++ = static_cast<float>(a[c][k] + weight[c] * (b[c][k] - a[c][k]));
        }
    }
}

OSGVOLUMIZER_INLINE void emitAny(const SlicePlan& plan, Slicer::Chunk& chunk,
                                 const SliceTarget& target)
{
    std::size_t begin = 0;
    for (std::uint32_t i = chunk.firstBlock; i < chunk.endBlock; ++i) {
        const TetraBlocks::Block& block = plan.blocks->blocks[i];
        const std::size_t end = chunk.blockEntries[i - chunk.firstBlock];
        switch (plan.blocks->format().stride()) {
        case 3: emitBlock<3>(plan, chunk, target, block, begin, end); break;
        case 6: emitBlock<6>(plan, chunk, target, block, begin, end); break;
        case 7: emitBlock<7>(plan, chunk, target, block, begin, end); break;
        case 9: emitBlock<9>(plan, chunk, target, block, begin, end); break;
        case 10: emitBlock<10>(plan, chunk, target, block, begin, end); break;
        default: emitBlock<0>(plan, chunk, target, block, begin, end); break;
        }
        begin = end;
    }
}

#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
__attribute__((target("avx2"))) void emitAvx2(const SlicePlan& plan, Slicer::Chunk& chunk,
                                              const SliceTarget& target)
{
    emitAny(plan, chunk, target);
}
#endif

void emitBaseline(const SlicePlan& plan, Slicer::Chunk& chunk, const SliceTarget& target)
{
    emitAny(plan, chunk, target);
}

} // namespace

void emitFaces(const SlicePlan& plan, Slicer::Chunk& chunk, const SliceTarget& target)
{
#if defined(OSGVOLUMIZER_DISPATCH_AVX2)
    static const bool avx2 = __builtin_cpu_supports("avx2");
    if (avx2) {
        emitAvx2(plan, chunk, target);
        return;
    }
#endif
    emitBaseline(plan, chunk, target);
}

} // namespace core
} // namespace osgVolumizer
