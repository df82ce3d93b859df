#include "SliceFaces.h"

#include "../Voxels.h"
#include "../core/sampling/Polygonize.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace osgVolumizer {
namespace slices {

namespace SliceFacesMaking {

// Voxels by which the box of all voxels is enlarged: slices on its faces are to be seen.
constexpr double MARGIN = 1e-6;

glm::dvec3 toDvec3(const osg::Vec3d& v)
{
    return {v.x(), v.y(), v.z()};
}

struct Frame
{
    explicit Frame(const Voxels& voxels)
        : origin(toDvec3(voxels.getOrigin())), spacing(toDvec3(voxels.getSpacing())),
          extent(voxels.getLayout().extent())
    {
        extent.min -= MARGIN;
        extent.max += MARGIN;
    }
    glm::dvec3 voxelOf(const glm::dvec3& place) const { return (place - origin) / spacing; }
    glm::dvec3 placeOf(const glm::dvec3& voxel) const { return origin + spacing * voxel; }

    glm::dvec3 origin, spacing;
    core::Box3d extent; ///< voxel frame
};

core::TetraSet boxOf(const Frame& frame)
{
    // Four corner tetrahedra and the central one.
    core::TetraSet set;
    set.vertices.resize(8);
    for (int i = 0; i < 8; ++i)
        set.vertices.setPosition(std::size_t(i), frame.placeOf(frame.extent.corner(i)));
    set.indices = {0, 1, 2, 4, 3, 2, 1, 7, 5, 4, 7, 1, 6, 7, 4, 2, 1, 2, 4, 7};
    return set;
}

struct Point
{
    glm::dvec3 voxel, position;
};

void appendFace(const std::vector<Point>& points, const glm::dvec3& across, const Frame& frame,
                core::PolygonSet& polygons)
{
    const glm::dvec3 normal = across * frame.spacing;
    const double distance = glm::dot(normal, points[0].position);
    for (const Point& p : points) {
        for (const glm::dvec3& v : {p.voxel, p.position, across})
            polygons.values.insert(polygons.values.end(), {v.x, v.y, v.z});
        polygons.values.push_back(distance);
    }
    polygons.faceOffsets.push_back(polygons.faceOffsets.back() +
                                   static_cast<std::uint32_t>(points.size()));
}

// Voxels per unit of length along the normal of a face, by where its points are in the volume.
glm::dvec3 acrossOf(const std::vector<Point>& points, const Frame& frame)
{
    glm::dvec3 normal(0.0);
    for (std::size_t i = 2; i < points.size(); ++i)
        normal += glm::cross(frame.spacing * (points[i - 1].voxel - points[0].voxel),
                             frame.spacing * (points[i].voxel - points[0].voxel));
    const double length = glm::length(normal);
    return length > 0.0 ? normal / (length * frame.spacing) : glm::dvec3(0.0);
}

Status cutRegion(const SliceShape& shape, const Frame& frame,
                 const std::shared_ptr<const core::TetraSet>& set, SliceFaces& result)
{
    core::Polygonizer polygonizer;
    core::PolygonizedFaces cut;
    if (Status s = polygonizer.setTetraSet(set); !s.ok()) return s;
    const bool ownVoxels = set->vertices.format().voxelCoordinateSize == 3;
    result.center = set->bounds().center();
    const Status status = shape.kind == SliceShape::PLANE
                              ? polygonizer.polygonizeMPR(shape.plane, result.center, cut)
                              : polygonizer.polygonizeMPR(shape.polygon, result.center, cut);
    if (!status.ok()) return status;
    std::vector<Point> points;
    for (const core::FaceView face : cut.faces) {
        points.clear();
        for (const std::uint32_t vertex : face) {
            const float* record = cut.faces.record(vertex);
            const glm::dvec3 position = cut.faces.position(vertex);
            points.push_back({ownVoxels ? glm::dvec3(record[0], record[1], record[2])
                                        : frame.voxelOf(position + result.center),
                              position});
        }
        appendFace(points, ownVoxels ? acrossOf(points, frame) : shape.plane.normal / frame.spacing,
                   frame, result.polygons);
    }
    result.ownPlaces = ownVoxels;
    return {};
}

void takeTriangles(const SliceShape& shape, const Frame& frame, SliceFaces& result)
{
    core::Box3d bounds;
    for (const SliceShape::Corner& corner : shape.corners)
        bounds.expand(corner.position);
    result.center = bounds.center();
    result.ownPlaces = shape.ownPlaces;
    std::vector<Point> points(3);
    for (std::size_t i = 0; i + 2 < shape.corners.size(); i += 3) {
        for (std::size_t k = 0; k < 3; ++k) {
            const SliceShape::Corner& corner = shape.corners[i + k];
            points[k] = {frame.voxelOf(corner.place), corner.position - result.center};
        }
        appendFace(points, acrossOf(points, frame), frame, result.polygons);
    }
}

void findBounds(SliceFaces& faces)
{
    std::vector<core::Box3d> boxes;
    const core::PolygonSet& polygons = faces.polygons;
    for (std::size_t f = 0; f < polygons.faceCount(); ++f) {
        core::Box3d box;
        for (std::size_t c = 0; c < polygons.size(f); ++c) {
            const double* voxel = polygons.record(f, c);
            box.expand({voxel[0], voxel[1], voxel[2]});
            faces.bounds.expand(polygons.position(f, c) + faces.center);
        }
        box.min -= MARGIN;
        box.max += MARGIN;
        boxes.push_back(box);
    }
    (void)faces.boxes.build(boxes); // all finite
}

} // namespace SliceFacesMaking

Result<std::shared_ptr<const SliceFaces>>
makeSliceFaces(const SliceShape& shape, const Voxels& voxels, const core::TetraSet* region)
{
    using namespace SliceFacesMaking;
    const Frame frame(voxels);
    auto all = std::make_shared<SliceFaces>();
    all->polygons.format = core::VertexFormat::user(3, 0, 4);
    if (shape.kind == SliceShape::TRIANGLES) {
        takeTriangles(shape, frame, *all);
    } else if (shape.kind != SliceShape::EMPTY) {
        const auto set = std::make_shared<const core::TetraSet>(region ? *region : boxOf(frame));
        if (!set->empty())
            if (Status s = cutRegion(shape, frame, set, *all); !s.ok()) return s;
    }
    auto within = std::make_shared<SliceFaces>();
    within->center = all->center;
    within->ownPlaces = all->ownPlaces;
    within->polygons.format = all->polygons.format;
    core::Box3d closed = frame.extent;
    closed.max += MARGIN; // boxes are half-open
    core::clip(all->polygons, closed, within->polygons);
    findBounds(*within);
    return std::shared_ptr<const SliceFaces>(std::move(within));
}

} // namespace slices
} // namespace osgVolumizer
