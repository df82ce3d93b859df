#include "Outlines.h"

#include "EdgeMap.h"

namespace osgVolumizer {
namespace core {

namespace {

/// Adds a segment between two points unless it is known in either direction.
void addOnce(EdgeMap& known, std::uint32_t a, std::uint32_t b, std::uint32_t firstPoint,
             LineSet& lines)
{
    std::uint32_t& seen = known(a, b);
    if (a == b || seen != EdgeMap::NONE) return;
    seen = 0;
    lines.indices.insert(lines.indices.end(), {firstPoint + a, firstPoint + b});
}

} // namespace

void outlineTetrahedra(const TetraSet& set, LineSet& lines)
{
    const auto first = static_cast<std::uint32_t>(lines.points.size());
    for (std::size_t i = 0; i < set.vertices.size(); ++i)
        lines.points.push_back(set.vertices.position(i));
    EdgeMap known;
    for (std::size_t t = 0; t < set.indices.size(); t += 4)
        for (std::size_t a = 0; a < 4; ++a)
            for (std::size_t b = a + 1; b < 4; ++b)
                addOnce(known, set.indices[t + a], set.indices[t + b], first, lines);
}

void outlineFaces(const FaceSet& faces, std::size_t firstFace, std::size_t count, LineSet& lines)
{
    const auto first = static_cast<std::uint32_t>(lines.points.size());
    for (std::uint32_t i = 0; i < faces.vertexCount(); ++i)
        lines.points.push_back(faces.position(i));
    EdgeMap known;
    for (std::size_t f = firstFace; f < firstFace + count; ++f) {
        const FaceView face = faces.face(f);
        for (std::size_t i = 0; i < face.size(); ++i)
            addOnce(known, face[i], face[i + 1 == face.size() ? 0 : i + 1], first, lines);
    }
}

void outlineBoxes(const std::vector<Box3d>& boxes, LineSet& lines)
{
    for (const Box3d& box : boxes) {
        const auto first = static_cast<std::uint32_t>(lines.points.size());
        for (int i = 0; i < 8; ++i)
            lines.points.push_back(box.corner(i));
        for (std::uint32_t corner = 0; corner < 8; ++corner)
            for (std::uint32_t bit = 1; bit < 8; bit *= 2)
                if (!(corner & bit))
                    lines.indices.insert(lines.indices.end(),
                                         {first + corner, first + corner + bit});
    }
}

} // namespace core
} // namespace osgVolumizer
