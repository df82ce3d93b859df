#include "TetraGraph.h"

#include "TetraMesh.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace osgVolumizer {
namespace core {

namespace {

using Index = TetraSet::Index;

struct Face
{
    std::array<Index, 3> vertices; ///< ascending
    std::uint32_t cell;
    std::uint32_t opposite; ///< which of the cell's vertices, by ascending index
    bool operator<(const Face& o) const
    {
        return vertices != o.vertices ? vertices < o.vertices : cell < o.cell;
    }
};

std::array<Index, 4> sortedVertices(const TetraSet& set, std::size_t tetrahedron)
{
    std::array<Index, 4> v;
    std::copy_n(&set.indices[4 * tetrahedron], 4, v.begin());
    std::sort(v.begin(), v.end());
    return v;
}

std::array<Index, 3> without(const std::array<Index, 4>& v, std::size_t opposite)
{
    std::array<Index, 3> rest{};
    for (std::size_t i = 0, k = 0; i < 4; ++i)
        if (i != opposite) rest[k++] = v[i];
    return rest;
}

// Tetrahedra with four vertices.
std::vector<std::uint32_t> wholeCells(const TetraSet& set, TetraGraph& graph)
{
    std::vector<std::uint32_t> cells;
    for (std::uint32_t t = 0; t < set.tetraCount(); ++t) {
        const std::array<Index, 4> v = sortedVertices(set, t);
        if (std::adjacent_find(v.begin(), v.end()) == v.end())
            cells.push_back(t);
        else
            ++graph.repeatedVertices;
    }
    return cells;
}

// Of cells with the same vertices the first one stays.
void dropTwins(const TetraSet& set, const std::vector<Face>& faces, TetraGraph& graph)
{
    std::vector<std::uint32_t> twins;
    const auto apex = [&](const Face& face) {
        return sortedVertices(set, graph.numbers[face.cell])[face.opposite];
    };
    for (std::size_t i = 0; i < faces.size(); ++i)
        for (std::size_t k = i; k-- > 0 && faces[k].vertices == faces[i].vertices;)
            if (faces[i].opposite == 0 && apex(faces[k]) == apex(faces[i])) {
                twins.push_back(graph.numbers[faces[i].cell]);
                break;
            }
    std::sort(twins.begin(), twins.end());
    graph.twice = twins.size();
    graph.numbers.erase(std::remove_if(graph.numbers.begin(), graph.numbers.end(),
                                       [&twins](std::uint32_t t) {
                                           return std::binary_search(twins.begin(), twins.end(), t);
                                       }),
                        graph.numbers.end());
}

void layOutCells(const TetraSet& set, TetraGraph& graph)
{
    for (const std::uint32_t t : graph.numbers) {
        const std::array<Index, 4> v = sortedVertices(set, t);
        const double six = orientation(set, t);
        graph.flat += six == 0.0;
        graph.inverted += six < 0.0;
        graph.words.insert(graph.words.end(),
                           {v[0] ^ v[1] ^ v[2] ^ v[3], TetraGraph::OUTSIDE, TetraGraph::OUTSIDE,
                            TetraGraph::OUTSIDE, TetraGraph::OUTSIDE});
    }
    graph.cellCount = graph.numbers.size();
    graph.inverted = std::min(graph.inverted, graph.cellCount - graph.flat - graph.inverted);
}

std::vector<Face> facesOf(const TetraSet& set, const TetraGraph& graph)
{
    std::vector<Face> faces;
    faces.reserve(4 * graph.numbers.size());
    for (std::uint32_t cell = 0; cell < graph.numbers.size(); ++cell) {
        const std::array<Index, 4> v = sortedVertices(set, graph.numbers[cell]);
        for (std::uint32_t i = 0; i < 4; ++i)
            faces.push_back({without(v, i), cell, i});
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

// The vertices counter-clockwise from outside.
void addOuterFace(const TetraSet& set, const Face& face, TetraGraph& graph)
{
    const std::array<Index, 4> v = sortedVertices(set, graph.numbers[face.cell]);
    std::array<Index, 3> f = face.vertices;
    const auto position = [&set](Index i) { return set.vertices.position(i); };
    const glm::dvec3 a = position(f[0]);
    const glm::dvec3 normal = glm::cross(position(f[1]) - a, position(f[2]) - a);
    if (glm::dot(normal, position(v[face.opposite]) - a) > 0.0) std::swap(f[1], f[2]);
    graph.words.insert(graph.words.end(), {f[0], f[1], f[2], face.cell});
    ++graph.faceCount;
}

void joinCells(const TetraSet& set, const std::vector<Face>& faces, TetraGraph& graph)
{
    graph.facesBegin = graph.words.size();
    for (std::size_t i = 0; i < faces.size();) {
        std::size_t end = i + 1;
        while (end < faces.size() && faces[end].vertices == faces[i].vertices)
            ++end;
        const Face &a = faces[i], &b = faces[end - 1];
        if (end - i == 2) {
            graph.words[TetraGraph::CELL_WORDS * a.cell + 1 + a.opposite] = b.cell;
            graph.words[TetraGraph::CELL_WORDS * b.cell + 1 + b.opposite] = a.cell;
        } else {
            for (std::size_t k = i; k < end; ++k)
                addOuterFace(set, faces[k], graph);
        }
        graph.nonManifoldFaces += end - i > 2;
        i = end;
    }
}

// The grid's cells are about as large as outer faces, and as long as they are wide.
void layOutGrid(const TetraSet& set, TetraGraph& graph)
{
    constexpr double MOST = 128.0, MARGIN = 1e-5;
    Box3d box = set.bounds();
    const glm::dvec3 extent = box.size();
    const double longest = std::max({extent.x, extent.y, extent.z});
    const glm::dvec3 margin(MARGIN * std::max(longest, 1e-30));
    graph.gridBox = {box.min - margin, box.max + margin};
    const glm::dvec3 size = graph.gridBox.size();
    const double area = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
    const double edge = std::sqrt(2.0 * area / static_cast<double>(graph.faceCount + 1));
    graph.gridSize =
        glm::ivec3(glm::clamp(glm::ceil(size / edge), glm::dvec3(1.0), glm::dvec3(MOST)));
}

// Cells of the grid, both ends included, that a face may reach into.
struct CellSpan
{
    glm::ivec3 first, last;
};

CellSpan spanOf(const TetraSet& set, const TetraGraph& graph, std::size_t face)
{
    Box3d box;
    for (std::size_t i = 0; i < 3; ++i)
        box.expand(set.vertices.position(
            graph.words[graph.facesBegin + TetraGraph::FACE_WORDS * face + i]));
    const glm::dvec3 size = graph.gridBox.size(), cells(graph.gridSize);
    const glm::dvec3 margin = 1e-6 * size;
    const auto cellOf = [&](const glm::dvec3& p) {
        return glm::ivec3(glm::clamp(glm::floor((p - graph.gridBox.min) / size * cells),
                                     glm::dvec3(0.0), cells - 1.0));
    };
    return {cellOf(box.min - margin), cellOf(box.max + margin)};
}

template <class Visit>
void forEachCell(const CellSpan& span, const glm::ivec3& gridSize, const Visit& visit)
{
    for (int z = span.first.z; z <= span.last.z; ++z)
        for (int y = span.first.y; y <= span.last.y; ++y)
            for (int x = span.first.x; x <= span.last.x; ++x)
                visit(static_cast<std::size_t>(x) +
                      static_cast<std::size_t>(gridSize.x) *
                          (static_cast<std::size_t>(y) +
                           static_cast<std::size_t>(gridSize.y) * static_cast<std::size_t>(z)));
}

void fillGrid(const TetraSet& set, TetraGraph& graph)
{
    layOutGrid(set, graph);
    const std::size_t cells = std::size_t(graph.gridSize.x) * std::size_t(graph.gridSize.y) *
                              std::size_t(graph.gridSize.z);
    std::vector<std::uint32_t> ends(cells + 1, 0);
    std::vector<CellSpan> spans;
    for (std::size_t f = 0; f < graph.faceCount; ++f) {
        spans.push_back(spanOf(set, graph, f));
        forEachCell(spans.back(), graph.gridSize, [&](std::size_t cell) { ++ends[cell + 1]; });
    }
    graph.gridBegin = graph.words.size();
    const std::size_t listsBegin = graph.gridBegin + cells + 1;
    for (std::size_t i = 0; i < cells; ++i)
        ends[i + 1] += ends[i];
    graph.words.resize(listsBegin + ends[cells]);
    for (std::size_t i = 0; i <= cells; ++i)
        graph.words[graph.gridBegin + i] = static_cast<std::uint32_t>(listsBegin + ends[i]);
    for (std::size_t f = 0; f < graph.faceCount; ++f)
        forEachCell(spans[f], graph.gridSize, [&](std::size_t cell) {
            graph.words[listsBegin + ends[cell]++] = static_cast<std::uint32_t>(f);
        });
}

} // namespace

std::string TetraGraph::oddities() const
{
    std::string text;
    const auto add = [&text](std::size_t count, const char* what) {
        if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + what;
    };
    add(repeatedVertices, " with a vertex twice (left out)");
    add(twice, " of the same vertices as another (left out)");
    add(flat, " without volume (nothing of them is seen)");
    add(inverted, " inverted (drawn as any)");
    add(nonManifoldFaces, " faces of more than two (of what overlaps there, the first is drawn)");
    if (text.empty()) return text;
    return "of " + std::to_string(numbers.size() + repeatedVertices + twice) +
           " tetrahedra there are " + text;
}

TetraGraph makeTetraGraph(const TetraSet& set)
{
    TetraGraph graph;
    graph.numbers = wholeCells(set, graph);
    std::vector<Face> faces = facesOf(set, graph);
    dropTwins(set, faces, graph);
    if (graph.twice > 0) faces = facesOf(set, graph);
    layOutCells(set, graph);
    joinCells(set, faces, graph);
    fillGrid(set, graph);
    return graph;
}

} // namespace core
} // namespace osgVolumizer
