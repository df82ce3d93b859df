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
    for (std::size_t i = 1; i < faces.size(); ++i)
        // Of one tetrahedron the lowest vertex is opposite to one face only.
        for (std::size_t k = i;
             k-- > 0 && faces[i].opposite == 0 && faces[k].vertices == faces[i].vertices;)
            if (apex(faces[k]) == apex(faces[i])) {
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

constexpr std::size_t LEAF_FACES = 2;

struct BoxedFace
{
    Box3d box;
    std::array<std::uint32_t, TetraGraph::FACE_WORDS> words;
};

std::vector<BoxedFace> boxedFaces(const TetraSet& set, const TetraGraph& graph)
{
    std::vector<BoxedFace> faces(graph.faceCount);
    for (std::size_t f = 0; f < faces.size(); ++f) {
        std::copy_n(&graph.words[graph.facesBegin + TetraGraph::FACE_WORDS * f],
                    TetraGraph::FACE_WORDS, faces[f].words.begin());
        for (std::size_t i = 0; i < 3; ++i)
            faces[f].box.expand(set.vertices.position(faces[f].words[i]));
    }
    return faces;
}

/// Sorts faces to the leaves of a tree: in the middle of the longest side.
class TreeBuilder
{
public:
    TreeBuilder(std::vector<BoxedFace>& faces, double margin, TetraGraph& graph)
        : _faces(faces), _margin(margin), _graph(graph)
    {
    }
    // A node of so many leaves.
    void build(std::size_t node, std::size_t begin, std::size_t end, std::size_t leaves)
    {
        if (begin >= end) return; // far away, as all boxes are at first
        Box3d box;
        for (std::size_t f = begin; f < end; ++f) {
            box.expand(_faces[f].box.min);
            box.expand(_faces[f].box.max);
        }
        _graph.boxes[2 * node] = glm::vec3(box.min - _margin);
        _graph.boxes[2 * node + 1] = glm::vec3(box.max + _margin);
        if (leaves == 1) return;
        const std::size_t middle = std::min(begin + leaves / 2 * _graph.leafFaces, end);
        const glm::dvec3 size = box.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        if (middle < end)
            std::nth_element(
                at(begin), at(middle), at(end), [axis](const BoxedFace& a, const BoxedFace& b) {
                    return a.box.min[axis] + a.box.max[axis] < b.box.min[axis] + b.box.max[axis];
                });
        build(2 * node, begin, middle, leaves / 2);
        build(2 * node + 1, middle, end, leaves / 2);
    }

private:
    std::vector<BoxedFace>::iterator at(std::size_t f)
    {
        return _faces.begin() + static_cast<std::ptrdiff_t>(f);
    }

    std::vector<BoxedFace>& _faces;
    double _margin;
    TetraGraph& _graph;
};

// Boxes are a little larger than what floats make of their faces.
void growTree(const TetraSet& set, TetraGraph& graph)
{
    std::vector<BoxedFace> faces = boxedFaces(set, graph);
    const Box3d all = set.bounds();
    const glm::dvec3 reach = glm::max(glm::abs(all.min), glm::abs(all.max));
    const double margin = 1e-6 * std::max({reach.x, reach.y, reach.z, 1e-30});
    graph.leafFaces = LEAF_FACES;
    while (graph.leafCount * LEAF_FACES < faces.size())
        graph.leafCount *= 2;
    graph.boxes.assign(4 * graph.leafCount, glm::vec3(1e30f));
    TreeBuilder(faces, margin, graph).build(1, 0, faces.size(), graph.leafCount);
    for (std::size_t f = 0; f < faces.size(); ++f)
        std::copy(faces[f].words.begin(), faces[f].words.end(),
                  graph.words.begin() +
                      static_cast<std::ptrdiff_t>(graph.facesBegin + TetraGraph::FACE_WORDS * f));
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
    growTree(set, graph);
    return graph;
}

} // namespace core
} // namespace osgVolumizer
