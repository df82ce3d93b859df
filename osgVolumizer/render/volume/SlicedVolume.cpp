#include "SlicedVolume.h"
#include "GeometryCache.h"
#include "SliceCache.h"

#include <glm/gtc/matrix_access.hpp>

#include <algorithm>

namespace osgVolumizer {
namespace render {

namespace {

// Triangles of one PRIMITIVE face as a fan. Each has a thickness of its own, so their vertices are
// written out again with it.
void appendFace(const core::PolygonizedFaces& slices, std::uint32_t face, VolumeMesh& mesh)
{
    const core::FaceView corners = slices.faces.face(face);
    const auto first =
        static_cast<unsigned>(mesh.vertices.size() / static_cast<std::size_t>(mesh.stride));
    for (const std::uint32_t corner : corners) {
        const float* record = slices.faces.record(corner);
        mesh.vertices.insert(mesh.vertices.end(), record, record + slices.faces.format.stride());
        mesh.vertices.push_back(slices.faceSpacings[face]);
    }
    for (unsigned i = 2; i < corners.size(); ++i)
        mesh.indices.insert(mesh.indices.end(), {first, first + i - 1, first + i});
}

// Adds the faces of one surface in one brick to the last batch, or to a new one.
void appendRange(const core::PolygonizedFaces& slices, int surface, int brick, bool newBatch,
                 SliceTriangles& triangles)
{
    VolumeMesh& mesh = triangles.mesh;
    if (newBatch) {
        if (mesh.batches.empty() || mesh.batches.back().indexCount > 0) {
            mesh.batches.emplace_back();
            triangles.bricks.emplace_back();
        }
        mesh.batches.back().firstIndex = static_cast<unsigned>(mesh.indices.size());
        triangles.bricks.back() = brick;
    }
    const core::FaceRange& range = slices.range(surface, brick);
    if (slices.faceSpacings.empty())
        slices.faces.triangulate(range.firstFace, range.faceCount, mesh.indices);
    else
        for (std::uint32_t f = 0; f < range.faceCount; ++f)
            appendFace(slices, range.firstFace + f, mesh);
    mesh.faceCount += range.faceCount;
    BrickBatch& batch = mesh.batches.back();
    batch.indexCount = static_cast<unsigned>(mesh.indices.size()) - batch.firstIndex;
}

std::vector<core::Box3d> clipBoxesOf(const VolumeInstance& volume)
{
    std::vector<core::Box3d> boxes;
    for (const SelectedBrick& brick : volume.bricks)
        boxes.push_back(brick.box);
    return boxes;
}

// All but the arrays and batches.
VolumeMesh headOf(const VolumeMesh& mesh)
{
    VolumeMesh head;
    head.stride = mesh.stride;
    head.positionOffset = mesh.positionOffset;
    head.voxelCoordinateOffset = mesh.voxelCoordinateOffset;
    head.colorOffset = mesh.colorOffset;
    head.colorSize = mesh.colorSize;
    head.spacingOffset = mesh.spacingOffset;
    head.faceCount = mesh.faceCount;
    return head;
}

std::shared_ptr<const SliceTriangles> trianglesOf(const core::PolygonizedFaces& slices,
                                                  int firstSurface, int lastSurface,
                                                  bool brickByBrick)
{
    auto triangles = std::make_shared<SliceTriangles>();
    VolumeMesh& mesh = triangles->mesh;
    const core::VertexFormat& format = slices.faces.format;
    const bool ownSpacing = !slices.faceSpacings.empty();
    mesh.stride = format.stride() + (ownSpacing ? 1 : 0);
    mesh.positionOffset = format.positionOffset();
    if (format.voxelCoordinateSize) mesh.voxelCoordinateOffset = format.voxelCoordinateOffset();
    if (format.colorSize) mesh.colorOffset = format.colorOffset();
    mesh.colorSize = format.colorSize;
    if (ownSpacing) mesh.spacingOffset = format.stride();
    const int surfaces = lastSurface - firstSurface;
    const int outer = brickByBrick ? slices.brickCount : surfaces;
    const int inner = brickByBrick ? surfaces : slices.brickCount;
    for (int i = 0; i < outer; ++i)
        for (int j = 0; j < inner; ++j)
            appendRange(slices, firstSurface + (brickByBrick ? j : i), brickByBrick ? i : j,
                        j == 0 || !brickByBrick, *triangles);
    while (!mesh.batches.empty() && mesh.batches.back().indexCount == 0)
        mesh.batches.pop_back();
    if (!ownSpacing) mesh.vertices = slices.faces.vertices;
    return triangles;
}

} // namespace

Status SlicedVolume::polygonize(const VolumeInstance& volume, const core::View& view,
                                bool viewAligned)
{
    core::SamplingParameters sampling = volume.sampling;
    // Without one affine map there are no planes along a voxel axis.
    const bool noAxis = sampling.mode == SamplingMode::AXIS_ALIGNED &&
                        !volume.prepared->voxelFrame && volume.look->features.voxels;
    if (viewAligned || noAxis) sampling.mode = SamplingMode::VIEWPORT_ALIGNED;
    _spherical = sampling.mode == SamplingMode::SPHERICAL;
    // Where other things are merged, surfaces have to lie where this view has them.
    const double slack = viewAligned ? 0.0 : volume.geometry->getSlackAngle();
    const Result<core::FaceCache::FacesPtr> slices =
        renderData<GeometryCache>(*volume.geometry)
            ->slices()
            .faces()
            .faces(volume.viewId, {volume.prepared, &volume.prepared->tetras}, clipBoxesOf(volume),
                   view, sampling, slack, &_polygonized);
    if (!slices) return slices.status;
    _slices = *slices;
    // Planes across an older view have the normal of that one.
    _surfaceNormal = glm::dvec3(0.0);
    if (_slices->axis >= 0)
        _surfaceNormal[_slices->axis] = 1.0;
    else
        _surfaceNormal = _spherical ? -glm::dvec3(glm::row(view.toEye, 2)) : _slices->gradient;
    return {};
}

std::shared_ptr<const VolumeMesh> SlicedVolume::mesh(const VolumeInstance& volume) const
{
    return makeMesh(volume, 0, _slices->surfaceCount);
}

std::shared_ptr<const VolumeMesh> SlicedVolume::mesh(const VolumeInstance& volume,
                                                     const core::DepthInterval& interval) const
{
    // Depths fall with the number of the surface.
    const auto& depths = _slices->surfaceDepths;
    const auto notBefore = [&depths](double depth) {
        return static_cast<int>(std::partition_point(depths.begin(), depths.end(),
                                                     [depth](double d) { return d >= depth; }) -
                                depths.begin());
    };
    return makeMesh(volume, notBefore(interval.farDepth), notBefore(interval.nearDepth));
}

std::shared_ptr<const VolumeMesh> SlicedVolume::makeMesh(const VolumeInstance& volume,
                                                         int firstSurface, int lastSurface) const
{
    // Bricks of one affine map have an order of their own, so that each is bound once; of a
    // deformed volume only the surfaces have.
    const bool brickByBrick = volume.prepared->voxelFrame || _slices->brickCount == 1;
    const std::shared_ptr<const SliceTriangles> triangles =
        renderData<GeometryCache>(*volume.geometry)
            ->slices()
            .triangles(volume.viewId, _slices, firstSurface, lastSurface, [&]() {
                return trianglesOf(*_slices, firstSurface, lastSurface, brickByBrick);
            });
    auto mesh = std::make_shared<VolumeMesh>(headOf(triangles->mesh));
    mesh->arrays = {triangles, &triangles->mesh};
    mesh->batches = triangles->mesh.batches;
    for (std::size_t i = 0; i < mesh->batches.size() && !volume.bricks.empty(); ++i) {
        const SelectedBrick& brick = volume.bricks[static_cast<std::size_t>(triangles->bricks[i])];
        BrickBatch& batch = mesh->batches[i];
        batch.brick = brick.texels;
        batch.nextBrick = brick.nextTexels;
        batch.stepFraction = brick.stepFraction;
        batch.textureScale = brick.textureScale;
        batch.textureOffset = brick.textureOffset;
    }
    return mesh;
}

} // namespace render
} // namespace osgVolumizer
