#include "TetraBlocks.h"

#include "../private/LargePages.h"
#include "Orientation.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace osgVolumizer {
namespace core {

namespace {

constexpr std::uint32_t NO_VERTEX = 0xffffffffu;
constexpr std::size_t RECORD_PADDING = 4;

/// Puts two zero bits after each of the low 10 bits.
std::uint64_t spread(std::uint64_t v)
{
    v = (v | (v << 16)) & 0x030000ffu;
    v = (v | (v << 8)) & 0x0300f00fu;
    v = (v | (v << 4)) & 0x030c30c3u;
    return (v | (v << 2)) & 0x09249249u;
}

} // namespace

void TetraBlocks::sortTetrahedra(const TetraSet& set)
{
    const std::size_t n = set.tetraCount();
    sourceTetrahedra.resize(n);
    std::iota(sourceTetrahedra.begin(), sourceTetrahedra.end(), 0u);
    if (n <= MAX_TETRAHEDRA && set.vertices.size() <= MAX_VERTICES) return;
    const Box3d bounds = set.bounds();
    glm::dvec3 scale(0.0);
    for (int a = 0; a < 3; ++a)
        if (bounds.size()[a] > 0.0) scale[a] = 1023.0 / bounds.size()[a];
    _codes.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        glm::dvec3 c(0.0);
        for (std::size_t k = 0; k < 4; ++k)
            c += 0.25 * (set.vertices.position(set.indices[4 * i + k]) - bounds.min) * scale;
        std::uint64_t code = 0;
        for (int a = 0; a < 3; ++a)
            code |= spread(static_cast<std::uint64_t>(std::min(1023.0, std::max(0.0, c[a])))) << a;
        _codes[i] = code << 32 | i;
    }
    std::sort(_codes.begin(), _codes.end());
    for (std::size_t i = 0; i < n; ++i)
        sourceTetrahedra[i] = static_cast<std::uint32_t>(_codes[i] & 0xffffffffu);
}

void TetraBlocks::build(const TetraSet& set, const glm::dvec3& origin)
{
    _format = set.vertices.format();
    _origin = origin;
    places.clear();
    blocks.clear();
    sourceVertices.clear();
    sortTetrahedra(set);
    resizeLarge(tetrahedra, set.tetraCount());
    _stamps.assign(set.vertices.size(), NO_VERTEX);
    _local.resize(set.vertices.size());
    for (std::size_t i = 0; i < tetrahedra.size(); ++i) {
        const TetraSet::Index* source = set.indices.data() + std::size_t(4) * sourceTetrahedra[i];
        const auto current = static_cast<std::uint32_t>(blocks.size() - 1);
        std::size_t fresh = 0;
        for (int k = 0; k < 4; ++k)
            fresh += blocks.empty() || _stamps[source[k]] != current ? 1u : 0u;
        if (blocks.empty() || blocks.back().tetraCount == MAX_TETRAHEDRA ||
            blocks.back().vertexCount + fresh > MAX_VERTICES) {
            Block b;
            b.firstVertex = static_cast<std::uint32_t>(sourceVertices.size());
            b.firstTetra = static_cast<std::uint32_t>(i);
            blocks.push_back(b);
        }
        Block& block = blocks.back();
        ++block.tetraCount;
        for (int k = 0; k < 4; ++k) {
            const TetraSet::Index v = source[k];
            if (_stamps[v] != blocks.size() - 1) {
                _stamps[v] = static_cast<std::uint32_t>(blocks.size() - 1);
                _local[v] = block.vertexCount++;
                sourceVertices.push_back(v);
            }
            tetrahedra[i].v[k] = static_cast<std::uint8_t>(_local[v]);
        }
        if (orientationSign(set.vertices.position(source[0]), set.vertices.position(source[1]),
                            set.vertices.position(source[2]), set.vertices.position(source[3])) < 0)
            std::swap(tetrahedra[i].v[0], tetrahedra[i].v[1]);
    }
    findEdges();
    const std::size_t stride = recordSize();
    const auto position = static_cast<std::size_t>(_format.positionOffset());
    resizeLarge(records, sourceVertices.size() * stride + RECORD_PADDING);
    for (Block& block : blocks)
        for (std::uint32_t i = block.firstVertex; i < block.firstVertex + block.vertexCount; ++i) {
            const double* from = set.vertices.record(sourceVertices[i]);
            double* to = records.data() + i * stride;
            std::copy(from, from + stride, to);
            for (std::size_t a = 0; a < 3; ++a)
                to[position + a] -= origin[static_cast<int>(a)];
            const double *p = to + position, *c = to + clipField();
            block.bounds.expand({p[0], p[1], p[2]});
            block.clipBounds.expand({c[0], c[1], c[2]});
        }
}

void TetraBlocks::findEdges()
{
    static constexpr int ends[6][2] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};
    edges.clear();
    resizeLarge(tetraEdges, tetrahedra.size() + 1);
    std::size_t width = 0;
    for (const Block& b : blocks)
        width = std::max<std::size_t>(width, b.vertexCount);
    _edgeTable.assign(width * width, {NO_VERTEX, 0});
    for (std::uint32_t i = 0; i < blocks.size(); ++i) {
        Block& block = blocks[i];
        block.firstEdge = static_cast<std::uint32_t>(edges.size());
        for (std::uint32_t t = block.firstTetra; t < block.firstTetra + block.tetraCount; ++t)
            for (int e = 0; e < 6; ++e) {
                std::uint8_t a = tetrahedra[t].v[ends[e][0]], b = tetrahedra[t].v[ends[e][1]];
                if (a > b) std::swap(a, b);
                EdgeEntry& entry = _edgeTable[a * width + b];
                if (entry.block != i) {
                    entry = {i, static_cast<std::uint16_t>(block.edgeCount++)};
                    edges.push_back({a, b});
                }
                tetraEdges[t].e[e] = entry.edge;
            }
    }
}

TetraBlocks::Place TetraBlocks::placeOf(const BoxIndex& boxes, const Block& block,
                                        const Tetra& tetra) const
{
    glm::dvec3 p[4];
    Box3d extent;
    for (int k = 0; k < 4; ++k) {
        const double* r = record(block.firstVertex + tetra.v[k]) + clipField();
        p[k] = {r[0], r[1], r[2]};
        extent.expand(p[k]);
    }
    Place place = OUTSIDE;
    bool several = false;
    boxes.visit(extent.min, extent.max, [&](int box, bool needsClipping) {
        several = several || place != OUTSIDE || needsClipping;
        place = static_cast<Place>(box);
    });
    if (several) return CLIP;
    if (place == OUTSIDE) return place;
    const glm::dvec3 upper = boxes.boxes()[place].max;
    Place faces = 0;
    for (int a = 0; a < 3; ++a)
        for (int opposite = 0; opposite < 4; ++opposite) {
            bool flush = true;
            for (int k = 0; k < 4; ++k)
                flush = flush && (k == opposite || p[k][a] == upper[a]);
            if (flush) faces |= 1u << opposite;
        }
    return place | faces << FACE_SHIFT;
}

void TetraBlocks::place(const BoxIndex& boxes)
{
    places.clear();
    for (Block& b : blocks)
        b.place = 0;
    if (boxes.boxes().empty()) return;
    places.resize(tetrahedra.size());
    for (Block& b : blocks) {
        for (std::uint32_t t = b.firstTetra; t < b.firstTetra + b.tetraCount; ++t)
            places[t] = placeOf(boxes, b, tetrahedra[t]);
        b.place = places[b.firstTetra];
        for (std::uint32_t t = b.firstTetra; t < b.firstTetra + b.tetraCount; ++t)
            if (places[t] != b.place || (places[t] > BOX_MASK && places[t] != OUTSIDE))
                b.place = CLIP;
    }
}

} // namespace core
} // namespace osgVolumizer
