#include "PolytopeSearch.h"

#include "../../core/geometry/ConvexPolytope.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <limits>
#include <queue>

namespace osgVolumizer {
namespace picking {

namespace {

using A = VolumeAppearance;

constexpr double INFINITE = std::numeric_limits<double>::infinity();

/// A convex part of the region within which the voxel coordinate is affine.
struct Piece
{
    std::vector<core::Plane> planes; ///< voxel frame: of the region, the polytope
    core::Box3d bounds;              ///< voxel frame
    glm::dmat4 toObject{1.0};        ///< voxel frame -> object frame
    core::Plane reference;           ///< voxel frame; distances are those of the object frame
    std::uint32_t tetrahedron = 0;
    bool inTetrahedron = false;
};

// A half-space of the points that `map` leads to, as one of those that it leads from.
core::Plane pulledBack(const core::Plane& plane, const glm::dmat4& map)
{
    return {glm::transpose(glm::dmat3(map)) * plane.normal, plane.distance(glm::dvec3(map[3]))};
}

// The largest distance of a box from a plane; the smallest with -1.
double boxDistance(const core::Plane& plane, const core::Box3d& box, double sign)
{
    double distance = plane.offset;
    for (int a = 0; a < 3; ++a)
        distance += plane.normal[a] * (sign * plane.normal[a] > 0.0 ? box.max[a] : box.min[a]);
    return distance;
}

bool touches(const std::vector<core::Plane>& planes, const core::Box3d& box)
{
    return std::all_of(planes.begin(), planes.end(), [&](const core::Plane& plane) {
        return boxDistance(plane, box, 1.0) >= 0.0;
    });
}

// Clips a polytope by half-spaces; false where nothing is left.
bool clip(core::ConvexPolytope& polytope, const std::vector<core::Plane>& planes)
{
    for (const core::Plane& plane : planes) {
        const double length = glm::length(plane.normal);
        if (!(length > 0.0)) continue;
        polytope.clip({plane.normal / length, plane.offset / length}, 0);
        if (polytope.empty()) return false;
    }
    return true;
}

PolytopeHit hitOf(const core::ConvexPolytope& part, const Piece& piece)
{
    PolytopeHit hit;
    hit.found = true;
    hit.tetrahedron = piece.tetrahedron;
    hit.farthest = -INFINITE;
    std::vector<std::uint32_t> used = part.indices;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    glm::dvec3 center(0.0);
    for (const std::uint32_t i : used) {
        const glm::dvec3 p = part.vertices[i];
        hit.corners.push_back(glm::dvec3(piece.toObject * glm::dvec4(p, 1.0)));
        hit.farthest = std::max(hit.farthest, piece.reference.distance(p));
        center += p / static_cast<double>(used.size());
    }
    hit.center = glm::dvec3(piece.toObject * glm::dvec4(center, 1.0));
    hit.distance = piece.reference.distance(center);
    return hit;
}

std::array<glm::dvec3, 4> cornersOf(const core::TetraSet& set, std::size_t tetrahedron,
                                    const glm::dmat4& map)
{
    std::array<glm::dvec3, 4> corners;
    for (std::size_t i = 0; i < 4; ++i)
        corners[i] = glm::dvec3(
            map * glm::dvec4(set.vertices.position(set.indices[4 * tetrahedron + i]), 1.0));
    return corners;
}

void addTetrahedron(const std::array<glm::dvec3, 4>& p, Piece& piece)
{
    for (std::size_t i = 0; i < 4; ++i) {
        piece.bounds.expand(p[i]);
        const glm::dvec3 &a = p[(i + 1) % 4], &b = p[(i + 2) % 4], &c = p[(i + 3) % 4];
        glm::dvec3 normal = glm::cross(b - a, c - a);
        if (glm::dot(normal, p[i] - a) < 0.0) normal = -normal;
        piece.planes.push_back({normal, -glm::dot(normal, a)});
    }
}

// Of a region that is convex in one frame: all of it; else a tetrahedron.
bool makePiece(const VolumeView& view, std::size_t tetrahedron, bool whole, Piece& piece)
{
    const render::PreparedGeometry& prepared = view.region->prepared();
    glm::dmat4 map(1.0);
    if (view.voxels && !view.region->voxelMap(tetrahedron, map)) return false;
    if (!(std::fabs(glm::determinant(glm::dmat3(map))) > 0.0)) return false;
    piece.toObject = prepared.frameToObject * glm::inverse(map);
    if (whole) {
        piece.planes = prepared.obliquePlanes;
        piece.bounds = prepared.regionBox;
        return true;
    }
    piece.tetrahedron = static_cast<std::uint32_t>(tetrahedron);
    piece.inTetrahedron = true;
    addTetrahedron(cornersOf(prepared.tetras, tetrahedron, map), piece);
    piece.bounds = core::intersection(piece.bounds, view.region->extent());
    return true;
}

std::vector<Piece> makePieces(const VolumeView& view, const std::vector<core::Plane>& polytope,
                              const core::Plane& reference)
{
    const render::PreparedGeometry& prepared = view.region->prepared();
    const bool whole = prepared.region.has_value() && !view.region->hasColors();
    const std::size_t count = whole ? 1 : prepared.tetras.tetraCount();
    std::vector<Piece> pieces;
    for (std::size_t t = 0; t < count; ++t) {
        Piece piece;
        if (!makePiece(view, t, whole, piece) || piece.bounds.empty()) continue;
        for (const core::Plane& plane : polytope)
            piece.planes.push_back(pulledBack(plane, piece.toObject));
        piece.reference = pulledBack(reference, piece.toObject);
        if (touches(piece.planes, piece.bounds)) pieces.push_back(std::move(piece));
    }
    return pieces;
}

/// Searches the parts of a piece, the nearest first: bricks, their cells of 8^3, single cells.
class PieceSearch
{
public:
    PieceSearch(const VolumeView& view, const Piece& piece, ValueField& field)
        : _view(view), _piece(piece), _field(field),
          _shows([&view](const core::ValueRange& range) { return view.shows(range); })
    {
    }

    /// The nearest part that shows something, and is nearer than that.
    PolytopeHit find(double nearerThan)
    {
        const GridReader& grid = _field.grid();
        const core::Box3d all = toGrid(_piece.bounds);
        for (const GridReader::Place& place : grid.placesIn(all))
            open(core::intersection(place.box, all), BRICK);
        while (!_open.empty()) {
            const Item item = _open.top();
            _open.pop();
            if (item.distance >= nearerThan) break;
            if (item.kind != SINGLE)
                divide(item);
            else if (PolytopeHit hit = inCell(item.box); hit.found)
                return hit;
        }
        return {};
    }

private:
    enum Kind
    {
        BRICK,
        CELLS,
        SINGLE
    };
    struct Item
    {
        double distance;
        Kind kind;
        core::Box3d box; ///< grid frame
        bool operator<(const Item& o) const { return distance > o.distance; }
    };

    core::Box3d toGrid(const core::Box3d& voxel) const
    {
        const GridReader& grid = _field.grid();
        return {(voxel.min - grid.offset()) / grid.spacing(),
                (voxel.max - grid.offset()) / grid.spacing()};
    }
    core::Box3d toVoxel(const core::Box3d& box) const
    {
        const GridReader& grid = _field.grid();
        return {grid.spacing() * box.min + grid.offset(), grid.spacing() * box.max + grid.offset()};
    }
    void open(const core::Box3d& box, Kind kind)
    {
        if (box.empty()) return;
        const core::Box3d voxel = toVoxel(box);
        if (touches(_piece.planes, voxel) && isKept(voxel))
            _open.push({boxDistance(_piece.reference, voxel, -1.0), kind, box});
    }
    bool isKept(const core::Box3d& voxel) const
    {
        return _view.isKept(voxel) &&
               (glm::length(voxel.size()) > 2.0 || _view.isKeptAt(voxel.center()));
    }
    // Cuts a box along the whole numbers that are multiples of `step` on from its first part.
    void divide(const Item& item)
    {
        const double shift = _field.cellShift();
        glm::dvec3 low = item.box.min;
        for (low.z = item.box.min.z; low.z < item.box.max.z;) {
            double endZ = HUGE_VAL;
            for (low.y = item.box.min.y; low.y < item.box.max.y;) {
                double endY = HUGE_VAL;
                for (low.x = item.box.min.x; low.x < item.box.max.x;) {
                    const core::Box3d part = item.kind == BRICK ? cellsAt(low, item.box)
                                                                : singleAt(low, shift, item.box);
                    endY = part.max.y;
                    endZ = part.max.z;
                    low.x = part.max.x;
                }
                low.y = endY;
            }
            low.z = endZ;
        }
    }
    static glm::ivec3 cellAfter(const glm::dvec3& place)
    {
        return glm::ivec3(glm::floor(place + 1e-9));
    }
    core::Box3d cellsAt(const glm::dvec3& low, const core::Box3d& within)
    {
        const GridReader::Part part = _field.partAt(cellAfter(low), _shows);
        const core::Box3d box = core::intersection({low, part.box.max}, within);
        if (part.shown) open(box, CELLS);
        return box;
    }
    core::Box3d singleAt(const glm::dvec3& low, double shift, const core::Box3d& within)
    {
        const glm::dvec3 end = glm::dvec3(cellAfter(low + shift) + 1) - shift;
        const core::Box3d box = core::intersection({low, end}, within);
        open(box, SINGLE);
        return box;
    }
    PolytopeHit inCell(const core::Box3d& box)
    {
        const double shift = _field.cellShift();
        const CellValues values = _field.cellValues(cellAfter(box.min + shift));
        if (!values.valid || !showsCell(values)) return {};
        core::ConvexPolytope part;
        part.setBox(toVoxel(box));
        if (part.empty() || !clip(part, _piece.planes)) return {};
        return hitOf(part, _piece);
    }
    bool showsCell(const CellValues& values) const
    {
        const int count = values.interpolation == A::NEAREST  ? 1
                          : values.interpolation == A::LINEAR ? 8
                                                              : 64;
        const auto ends = std::minmax_element(values.corner, values.corner + count);
        if (_view.look.before) return *ends.second > 0.0;
        if (_view.look.rayFunction == A::ISOSURFACE) return _shows({*ends.first, *ends.second});
        return _view.look.maximumOpacity(*ends.first, *ends.second) > 0.0;
    }

    const VolumeView& _view;
    const Piece& _piece;
    ValueField& _field;
    ValueField::Shows _shows;
    std::priority_queue<Item> _open;
};

PolytopeHit findWithoutVoxels(const Piece& piece, double nearerThan)
{
    core::ConvexPolytope part;
    part.setBox(piece.bounds);
    if (part.empty() || !clip(part, piece.planes)) return {};
    const PolytopeHit hit = hitOf(part, piece);
    return hit.distance < nearerThan ? hit : PolytopeHit();
}

} // namespace

PolytopeHit findInPolytope(const VolumeView& view, const std::vector<core::Plane>& polytope,
                           const core::Plane& reference, std::int64_t maximumBytes)
{
    if (!view.region || view.look.paints) return {};
    std::vector<core::Box3d> boxes;
    const std::vector<Piece> pieces = makePieces(view, polytope, reference);
    for (const Piece& piece : pieces)
        boxes.push_back(piece.bounds);
    const auto field = view.fieldOf(view.voxels ? view.levelWithin(boxes, maximumBytes) : 0);
    PolytopeHit nearest;
    for (const Piece& piece : pieces) {
        const double nearerThan = nearest.found ? nearest.distance : INFINITE;
        PolytopeHit hit = field ? PieceSearch(view, piece, *field).find(nearerThan)
                                : findWithoutVoxels(piece, nearerThan);
        if (hit.found && hit.distance < nearerThan) nearest = std::move(hit);
    }
    return nearest;
}

} // namespace picking
} // namespace osgVolumizer
