#include "MeshBuilder.h"

#include <glm/gtc/matrix_access.hpp>

#include <algorithm>

namespace osgVolumizer {
namespace render {

namespace {

// Triangles of one face as a fan. PRIMITIVE faces each have a thickness of their own, so their
// vertices are written out again with it.
void appendFace(const core::PolygonizedFaces& slices, std::uint32_t face, VolumeMesh& mesh)
{
    const core::FaceSet& faces = slices.faces;
    const std::uint32_t begin = faces.faceOffsets[face], end = faces.faceOffsets[face + 1];
    const bool ownSpacing = !slices.faceSpacings.empty();
    const auto vertex = [&](std::uint32_t i) {
        if (!ownSpacing) return faces.indices[i];
        return static_cast<unsigned>(mesh.vertices.size() / static_cast<std::size_t>(mesh.stride)) -
               (end - begin) + (i - begin);
    };
    if (ownSpacing) {
        for (std::uint32_t i = begin; i < end; ++i) {
            const float* record = faces.record(faces.indices[i]);
            mesh.vertices.insert(mesh.vertices.end(), record, record + faces.format.stride());
            mesh.vertices.push_back(slices.faceSpacings[face]);
        }
    }
    for (std::uint32_t i = begin + 2; i < end; ++i)
        mesh.indices.insert(mesh.indices.end(), {vertex(begin), vertex(i - 1), vertex(i)});
    ++mesh.faceCount;
}

// Adds the faces of one surface in one brick to the last batch, or to a new one.
void appendRange(const VolumeInstance& volume, const core::PolygonizedFaces& slices, int surface,
                 int brick, bool newBatch, VolumeMesh& mesh)
{
    if (newBatch) {
        BrickBatch batch;
        if (!volume.bricks.empty()) {
            const SelectedBrick& selected = volume.bricks[static_cast<std::size_t>(brick)];
            batch.texture = selected.texture.texture;
            batch.textureBytes = selected.texture.bytes;
            batch.textureScale = selected.textureScale;
            batch.textureOffset = selected.textureOffset;
        }
        batch.firstIndex = static_cast<unsigned>(mesh.indices.size());
        if (mesh.batches.empty() || mesh.batches.back().indexCount > 0) mesh.batches.emplace_back();
        mesh.batches.back() = batch;
    }
    const core::FaceRange& range = slices.range(surface, brick);
    for (std::uint32_t f = 0; f < range.faceCount; ++f)
        appendFace(slices, range.firstFace + f, mesh);
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
    const Status status =
        core::polygonize(volume.prepared->tetras, clipBoxesOf(volume), view, sampling, _slices);
    if (!status) return status;
    _surfaceNormal = glm::dvec3(0.0);
    if (_slices.axis >= 0)
        _surfaceNormal[_slices.axis] = 1.0;
    else
        _surfaceNormal = -glm::dvec3(glm::row(view.toEye, 2));
    return status;
}

std::shared_ptr<const VolumeMesh> SlicedVolume::mesh(const VolumeInstance& volume) const
{
    return makeMesh(volume, 0, _slices.surfaceCount);
}

std::shared_ptr<const VolumeMesh> SlicedVolume::mesh(const VolumeInstance& volume,
                                                     const core::DepthInterval& interval) const
{
    // Depths fall with the number of the surface.
    const auto& depths = _slices.surfaceDepths;
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
    const core::VertexFormat& format = _slices.faces.format;
    auto mesh = std::make_shared<VolumeMesh>();
    const bool ownSpacing = !_slices.faceSpacings.empty();
    mesh->stride = format.stride() + (ownSpacing ? 1 : 0);
    mesh->positionOffset = format.positionOffset();
    if (format.voxelCoordinateSize) mesh->voxelCoordinateOffset = format.voxelCoordinateOffset();
    if (format.colorSize) mesh->colorOffset = format.colorOffset();
    mesh->colorSize = format.colorSize;
    if (ownSpacing) mesh->spacingOffset = format.stride();
    // Bricks of one affine map have an order of their own, so that each is bound once; of a
    // deformed volume only the surfaces have.
    const int surfaces = lastSurface - firstSurface;
    const bool brickByBrick = volume.prepared->voxelFrame || _slices.brickCount == 1;
    const int outer = brickByBrick ? _slices.brickCount : surfaces;
    const int inner = brickByBrick ? surfaces : _slices.brickCount;
    for (int i = 0; i < outer; ++i) {
        for (int j = 0; j < inner; ++j) {
            const int brick = brickByBrick ? i : j;
            const int surface = firstSurface + (brickByBrick ? j : i);
            appendRange(volume, _slices, surface, brick, j == 0 || !brickByBrick, *mesh);
        }
    }
    while (!mesh->batches.empty() && mesh->batches.back().indexCount == 0)
        mesh->batches.pop_back();
    if (!ownSpacing) mesh->vertices = _slices.faces.vertices;
    return mesh;
}

} // namespace render
} // namespace osgVolumizer
