#include "SectionMesh.h"

#include "../../core/sampling/Sample.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <map>

namespace osgVolumizer {
namespace render {

namespace SectionMeshMaking {

using Indices = std::vector<unsigned>;
using Bricks = std::vector<std::size_t>;

// Halvings of a piece whose slab reaches into too many bricks.
constexpr int DEEPEST = 9;

core::Box3d voxelBox(const core::PolygonSet& polygons, std::size_t face)
{
    core::Box3d box;
    for (std::size_t c = 0; c < polygons.size(face); ++c) {
        const double* record = polygons.record(face, c);
        box.expand({record[0], record[1], record[2]});
    }
    return box;
}

void copyPolygon(const core::PolygonSet& from, std::size_t face, core::PolygonSet& to)
{
    const double* first = from.record(face, 0);
    const std::size_t count = from.size(face) * std::size_t(from.format.stride());
    to.values.insert(to.values.end(), first, first + count);
    to.faceOffsets.push_back(to.faceOffsets.back() + std::uint32_t(from.size(face)));
}

core::PolygonSet emptySet(const core::VertexFormat& format)
{
    core::PolygonSet set;
    set.format = format;
    return set;
}

struct Builder
{
    const slices::SliceFaces& faces;
    const std::vector<core::Box3d>& boxes;
    double half; ///< of the thickness
    std::size_t mostBricks;
    SectionMesh& mesh;
    std::map<Bricks, Indices> triangles;

    void addPiece(const core::PolygonSet& polygons, std::size_t face, const Bricks& bricks)
    {
        std::vector<float>& vertices = mesh.arrays.vertices;
        Indices& indices = triangles[bricks];
        const auto first = unsigned(vertices.size()) / unsigned(mesh.arrays.stride);
        for (std::size_t c = 0; c < polygons.size(face); ++c) {
            const double* record = polygons.record(face, c);
            for (int i = 0; i < mesh.arrays.stride; ++i)
                vertices.push_back(
                    static_cast<float>(i < 3 ? record[i] - mesh.voxelBase[i] : record[i]));
            if (c >= 2)
                indices.insert(indices.end(),
                               {first, first + unsigned(c) - 1, first + unsigned(c)});
        }
    }

    core::Box3d reached(const core::PolygonSet& polygons, std::size_t face) const
    {
        constexpr double ROUNDING = 1e-3;
        const double* across = polygons.record(face, 0) + slices::SliceFaces::ACROSS;
        const glm::dvec3 reach =
            half * glm::abs(glm::dvec3(across[0], across[1], across[2])) + ROUNDING;
        core::Box3d box = voxelBox(polygons, face);
        box.min -= reach;
        box.max += reach;
        return box;
    }

    // Pieces of a slab that need few enough bricks, each.
    void addSlab(const core::PolygonSet& polygons, std::size_t face, int depth)
    {
        const core::Box3d reach = reached(polygons, face);
        Bricks bricks;
        for (std::size_t b = 0; b < boxes.size(); ++b)
            if (!intersection(boxes[b], reach).empty()) bricks.push_back(b);
        if (bricks.size() <= mostBricks) return addPiece(polygons, face, bricks);
        if (depth < DEEPEST) return addHalves(polygons, face, depth);
        mesh.leavesOut = true;
        const glm::dvec3 middle = reach.center();
        const auto distance = [&](std::size_t b) {
            return glm::length(glm::clamp(middle, boxes[b].min, boxes[b].max) - middle);
        };
        std::stable_sort(bricks.begin(), bricks.end(),
                         [&](std::size_t a, std::size_t b) { return distance(a) < distance(b); });
        bricks.resize(mostBricks);
        addPiece(polygons, face, bricks);
    }

    void addHalves(const core::PolygonSet& polygons, std::size_t face, int depth)
    {
        const core::Box3d box = voxelBox(polygons, face);
        const glm::dvec3 size = box.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        core::PolygonSet piece = emptySet(polygons.format);
        copyPolygon(polygons, face, piece);
        for (const bool upper : {false, true}) {
            core::Box3d part{box.min - 1.0, box.max + 1.0};
            (upper ? part.min : part.max)[axis] = box.center()[axis];
            core::PolygonSet cut = emptySet(polygons.format);
            core::clip(piece, part, cut);
            for (std::size_t f = 0; f < cut.faceCount(); ++f)
                addSlab(cut, f, depth + 1);
        }
    }

    void cutAt(std::size_t brick)
    {
        const core::Box3d& box = boxes[brick];
        core::PolygonSet near = emptySet(faces.polygons.format), cut = near;
        faces.boxes.visit(box.min, box.max, [&](int face, bool) {
            copyPolygon(faces.polygons, std::size_t(face), near);
        });
        core::clip(near, box, cut);
        for (std::size_t f = 0; f < cut.faceCount(); ++f) {
            if (half > 0.0)
                addSlab(cut, f, 0);
            else
                addPiece(cut, f, {brick});
        }
    }
};

} // namespace SectionMeshMaking

std::shared_ptr<const SectionMesh> makeSectionMesh(const slices::SliceFaces& faces,
                                                   const std::vector<core::Box3d>& boxes,
                                                   double thickness, std::size_t mostBricks)
{
    auto mesh = std::make_shared<SectionMesh>();
    VolumeMesh& arrays = mesh->arrays;
    arrays.stride = faces.polygons.format.stride();
    arrays.voxelCoordinateOffset = faces.polygons.format.voxelCoordinateOffset();
    arrays.positionOffset = faces.polygons.format.positionOffset();
    arrays.colorOffset = slices::SliceFaces::ACROSS;
    arrays.colorSize = 3;
    arrays.spacingOffset = slices::SliceFaces::DISTANCE;
    core::Box3d all;
    for (const core::Box3d& box : faces.boxes.boxes()) {
        all.expand(box.min);
        all.expand(box.max);
    }
    if (!all.empty()) mesh->voxelBase = glm::round(all.center());
    SectionMeshMaking::Builder builder{faces, boxes, 0.5 * thickness, mostBricks, *mesh, {}};
    for (std::size_t b = 0; b < boxes.size(); ++b)
        builder.cutAt(b);
    for (const auto& [bricks, indices] : builder.triangles) {
        mesh->batches.push_back(
            {bricks, unsigned(arrays.indices.size()), unsigned(indices.size())});
        arrays.indices.insert(arrays.indices.end(), indices.begin(), indices.end());
        mesh->mostBricks = std::max(mesh->mostBricks, bricks.size());
    }
    return mesh;
}

} // namespace render
} // namespace osgVolumizer
