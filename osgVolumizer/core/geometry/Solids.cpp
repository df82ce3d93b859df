#include "Solids.h"

#include "EdgeMap.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <string>

namespace osgVolumizer {
namespace core {

namespace {

constexpr double PI = 3.14159265358979323846;
constexpr double MAX_TETRAHEDRA = 16777216.0;
using Index = TetraSet::Index;

/// Checks what all solids have in common.
class Check
{
public:
    explicit Check(const char* solid) : _solid(solid) {}
    Check& positive(const char* field, double value)
    {
        if (!(value > 0.0) || !std::isfinite(value)) refuse(ErrorCode::VALUE_INVALID, field, value);
        return *this;
    }
    Check& finite(const char* field, const glm::dvec3& v)
    {
        for (int i = 0; i < 3; ++i)
            if (!std::isfinite(v[i])) refuse(ErrorCode::VALUE_INVALID, field, v[i]);
        return *this;
    }
    Check& atLeast(const char* field, int value, int least)
    {
        if (value < least) refuse(ErrorCode::VALUE_INVALID, field, value);
        return *this;
    }
    Check& tetrahedra(double count)
    {
        if (count > MAX_TETRAHEDRA) refuse(ErrorCode::TOO_LARGE, "number of tetrahedra", count);
        return *this;
    }
    void refuse(ErrorCode code, const char* field, double value)
    {
        if (status.ok())
            status = Status(code, std::string(_solid) + ": " + field + " is " +
                                      std::to_string(value) + ".");
    }
    Status status;

private:
    const char* _solid;
};

Index addVertex(TetraSet& set, const glm::dvec3& p)
{
    const std::size_t n = set.vertices.size();
    set.vertices.resize(n + 1);
    set.vertices.setPosition(n, p);
    return static_cast<Index>(n);
}

/// Two unit vectors that make a right-handed frame with a direction.
void frameAbout(const glm::dvec3& axis, glm::dvec3& u, glm::dvec3& v)
{
    const glm::dvec3 a = glm::normalize(axis);
    const glm::dvec3 other = std::abs(a.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    u = glm::normalize(glm::cross(other, a));
    v = glm::cross(a, u);
}

glm::dvec3 onCircle(const glm::dvec3& center, const glm::dvec3& u, const glm::dvec3& v,
                    double radius, int i, int n)
{
    const double angle = 2.0 * PI * i / n;
    return center + radius * (std::cos(angle) * u + std::sin(angle) * v);
}

// Each face of the box is cut into four triangles about its centre, each joined to the centre of
// the box. Expects the corners.
void addTwentyFour(TetraSet& set, const glm::dvec3& boxCenter)
{
    static constexpr Index rings[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    const Index middle = addVertex(set, boxCenter);
    for (const auto& ring : rings) {
        const Index center =
            addVertex(set, 0.5 * (set.vertices.position(ring[0]) + set.vertices.position(ring[2])));
        for (int i = 0; i < 4; ++i)
            set.indices.insert(set.indices.end(), {ring[i], center, ring[(i + 1) % 4], middle});
    }
}

} // namespace

TetraSet tessellateBox(const Box3d& box, BoxTessellation how)
{
    TetraSet set;
    if (how == BoxTessellation::ENCLOSING) {
        const glm::dvec3 legs = 3.0 * box.size();
        for (const glm::dvec3& leg :
             {glm::dvec3(0, 0, 0), {legs.x, 0, 0}, {0, legs.y, 0}, {0, 0, legs.z}})
            addVertex(set, box.min + leg);
        set.indices = {0, 1, 2, 3};
        return set;
    }
    for (int i = 0; i < 8; ++i)
        addVertex(set, box.corner(i));
    if (how == BoxTessellation::FIVE)
        set.indices = {0, 1, 2, 4, 3, 2, 1, 7, 5, 4, 7, 1, 6, 7, 4, 2, 1, 2, 4, 7};
    else
        addTwentyFour(set, box.center());
    return set;
}

Result<TetraSet> Cone::tessellate() const
{
    Check check("Cone");
    check.finite("base", base).finite("apex", apex).positive("radius", radius);
    check.positive("height", glm::length(apex - base)).atLeast("slices", slices, 3);
    check.tetrahedra(slices);
    if (!check.status) return check.status;
    glm::dvec3 u, v;
    frameAbout(apex - base, u, v);
    TetraSet set;
    addVertex(set, base);
    addVertex(set, apex);
    for (int i = 0; i < slices; ++i)
        addVertex(set, onCircle(base, u, v, radius, i, slices));
    for (int i = 0; i < slices; ++i)
        set.indices.insert(set.indices.end(), {0u, Index(2 + i), Index(2 + (i + 1) % slices), 1u});
    return set;
}

Result<TetraSet> Cylinder::tessellate() const
{
    Check check("Cylinder");
    check.finite("bottom", bottom).finite("top", top).positive("radius", radius);
    check.positive("height", glm::length(top - bottom));
    check.atLeast("slices", slices, 3).atLeast("stacks", stacks, 1);
    check.tetrahedra(3.0 * slices * stacks);
    if (!check.status) return check.status;
    glm::dvec3 u, v;
    frameAbout(top - bottom, u, v);
    TetraSet rings;
    CellSet cells;
    cells.kind = CellKind::PRISM;
    const int ring = slices + 1;
    for (int s = 0; s <= stacks; ++s) {
        const glm::dvec3 center = bottom + (top - bottom) * (double(s) / stacks);
        addVertex(rings, center);
        for (int i = 0; i < slices; ++i)
            addVertex(rings, onCircle(center, u, v, radius, i, slices));
    }
    for (int s = 0; s < stacks; ++s)
        for (int i = 0; i < slices; ++i)
            for (int layer = 0; layer < 2; ++layer) {
                const Index o = static_cast<Index>((s + layer) * ring);
                cells.indices.insert(cells.indices.end(),
                                     {o, o + Index(1 + i), o + Index(1 + (i + 1) % slices)});
            }
    cells.vertices = std::move(rings.vertices);
    return cells.tessellate();
}

Result<TetraSet> Sphere::tessellate() const
{
    Check check("Sphere");
    check.finite("center", center).positive("radius", radius);
    check.atLeast("slices", slices, 3).atLeast("stacks", stacks, 2);
    check.tetrahedra(2.0 * slices * (stacks - 1.0));
    if (!check.status) return check.status;
    TetraSet set;
    addVertex(set, center);
    addVertex(set, center - glm::dvec3(0.0, 0.0, radius));
    addVertex(set, center + glm::dvec3(0.0, 0.0, radius));
    const glm::dvec3 u(1, 0, 0), v(0, 1, 0);
    for (int s = 1; s < stacks; ++s) {
        const double latitude = PI * s / stacks;
        const glm::dvec3 c = center - glm::dvec3(0.0, 0.0, radius * std::cos(latitude));
        for (int i = 0; i < slices; ++i)
            addVertex(set, onCircle(c, u, v, radius * std::sin(latitude), i, slices));
    }
    const auto at = [&](int s, int i) { return Index(3 + (s - 1) * slices + i % slices); };
    const auto add = [&](Index a, Index b, Index c) {
        set.indices.insert(set.indices.end(), {a, c, b, 0u});
    };
    for (int i = 0; i < slices; ++i) {
        add(1u, at(1, i + 1), at(1, i));
        add(2u, at(stacks - 1, i), at(stacks - 1, i + 1));
        for (int s = 1; s + 1 < stacks; ++s) {
            add(at(s, i), at(s, i + 1), at(s + 1, i + 1));
            add(at(s, i), at(s + 1, i + 1), at(s + 1, i));
        }
    }
    return set;
}

Result<TetraSet> GeodesicSphere::tessellate() const
{
    Check check("GeodesicSphere");
    check.finite("center", center).positive("radius", radius).atLeast("frequency", frequency, 1);
    check.tetrahedra(20.0 * frequency * frequency);
    if (!check.status) return check.status;
    const double g = 0.5 * (1.0 + std::sqrt(5.0));
    const glm::dvec3 corners[12] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                    {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                    {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
    static constexpr int faces[20][3] = {
        {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
        {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
        {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    TetraSet set;
    addVertex(set, center);
    // Points on corners and edges are shared by faces: they are found by the pair of points that
    // they lie between and their distance from the lower one.
    EdgeMap known;
    const int n = frequency;
    const auto point = [&](const int* f, int i, int j) {
        const int weight[3] = {n - i - j, i, j};
        glm::dvec3 p(0.0);
        std::uint32_t key[2] = {0, 0};
        int used = 0;
        for (int k = 0; k < 3; ++k) {
            if (weight[k] == 0) continue;
            p += double(weight[k]) * corners[f[k]];
            if (used < 2) key[used] = static_cast<std::uint32_t>(f[k] * (n + 1) + weight[k]);
            ++used;
        }
        p = center + radius * glm::normalize(p);
        if (used == 3) return addVertex(set, p);
        std::uint32_t& index = known(key[0], used == 1 ? key[0] : key[1]);
        if (index == EdgeMap::NONE) index = addVertex(set, p);
        return static_cast<Index>(index);
    };
    std::vector<Index> row, above;
    for (const auto& f : faces) {
        for (int j = 0; j <= n; ++j) {
            row.clear();
            for (int i = 0; i + j <= n; ++i)
                row.push_back(point(f, i, j));
            for (std::size_t i = 0; j > 0 && i < row.size(); ++i) {
                set.indices.insert(set.indices.end(), {above[i], row[i], above[i + 1], 0u});
                if (i + 1 < row.size())
                    set.indices.insert(set.indices.end(), {above[i + 1], row[i], row[i + 1], 0u});
            }
            above.swap(row);
        }
    }
    return set;
}

} // namespace core
} // namespace osgVolumizer
