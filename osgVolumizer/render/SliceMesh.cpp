#include "MeshBuilder.h"

#include <glm/gtc/matrix_access.hpp>

namespace osgVolumizer {
namespace render {

namespace {

// Triangles of one face as a fan. PRIMITIVE faces each have a thickness of their own, so their vertices are
// written out again with it.
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

std::vector<core::Box3d> clipBoxesOf(const VolumeInstance& volume)
{
    std::vector<core::Box3d> boxes;
    for (const SelectedBrick& brick : volume.bricks) boxes.push_back(brick.box);
    return boxes;
}

} // namespace

Result<std::shared_ptr<const VolumeMesh>> sliceMesh(const VolumeInstance& volume,
                                                    const core::View& view, double& spacing,
                                                    glm::dvec3& surfaceNormal)
{
    core::SamplingParameters sampling = volume.sampling;
    // Without one affine map there are no planes along a voxel axis.
    if (sampling.mode == SamplingMode::AXIS_ALIGNED && !volume.prepared->voxelFrame &&
        volume.look->features.voxels)
        sampling.mode = SamplingMode::VIEWPORT_ALIGNED;
    core::PolygonizedFaces slices;
    const Status status = core::polygonize(volume.prepared->tetras, clipBoxesOf(volume), view,
                                           sampling, slices);
    if (!status) return status;
    spacing = slices.spacing;
    surfaceNormal = glm::dvec3(0.0);
    if (slices.axis >= 0)
        surfaceNormal[slices.axis] = 1.0;
    else
        surfaceNormal = -glm::dvec3(glm::row(view.toEye, 2));

    const core::VertexFormat& format = slices.faces.format;
    auto mesh = std::make_shared<VolumeMesh>();
    const bool ownSpacing = !slices.faceSpacings.empty();
    mesh->stride = format.stride() + (ownSpacing ? 1 : 0);
    mesh->positionOffset = format.positionOffset();
    if (format.voxelCoordinateSize) mesh->voxelCoordinateOffset = format.voxelCoordinateOffset();
    if (format.colorSize) mesh->colorOffset = format.colorOffset();
    mesh->colorSize = format.colorSize;
    if (ownSpacing) mesh->spacingOffset = format.stride();
    for (int b = 0; b < slices.brickCount; ++b) {
        const SelectedBrick brick =
            volume.bricks.empty() ? SelectedBrick{} : volume.bricks[static_cast<std::size_t>(b)];
        BrickBatch batch;
        batch.texture = brick.texture.texture;
        batch.textureBytes = brick.texture.bytes;
        batch.textureScale = brick.textureScale;
        batch.textureOffset = brick.textureOffset;
        batch.firstIndex = static_cast<unsigned>(mesh->indices.size());
        for (int s = 0; s < slices.surfaceCount; ++s) {
            const core::FaceRange& range = slices.range(s, b);
            for (std::uint32_t f = 0; f < range.faceCount; ++f)
                appendFace(slices, range.firstFace + f, *mesh);
        }
        batch.indexCount = static_cast<unsigned>(mesh->indices.size()) - batch.firstIndex;
        if (batch.indexCount > 0) mesh->batches.push_back(batch);
    }
    if (!ownSpacing) mesh->vertices = std::move(slices.faces.vertices);
    return std::shared_ptr<const VolumeMesh>(std::move(mesh));
}

} // namespace render
} // namespace osgVolumizer
