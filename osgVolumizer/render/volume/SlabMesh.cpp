#include "SlabMesh.h"

#include "../draw/BatchDrawing.h"

#include "../../core/geometry/ConvexPolytope.h"
#include "../../core/sampling/ViewHelpers.h"

#include <glm/gtc/matrix_access.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace render {

namespace {

constexpr int SLAB_STRIDE = 5; // position, nearest and farthest depth

// The depth of a frame point as a plane: distance(p) = depth(p) - offset, eye units.
core::Plane depthPlane(const glm::dmat4& toEye, double offset)
{
    const glm::dvec4 z = glm::row(toEye, 2);
    return {-glm::dvec3(z), -z.w - offset};
}

core::Plane flipped(const core::Plane& p)
{
    return {-p.normal, -p.offset};
}

// Tag of the faces that clipping makes; nobody asks which plane made them.
constexpr int CUT = 6;

class SlabMeshBuilder
{
public:
    SlabMeshBuilder(const VolumeInstance& volume, const core::View& view, const glm::dvec4& eye)
        : _volume(volume), _view(view), _eye(eye), _mesh(std::make_shared<VolumeMesh>())
    {
        _mesh->stride = SLAB_STRIDE;
        _mesh->slabOffset = 3;
        const Result<core::NearFar> planes = core::nearFar(view.projection);
        if (planes) _nearPlane = planes->nearDepth + 1e-5 * std::abs(planes->nearDepth);
    }

    void append(const core::DepthInterval& interval)
    {
        for (const SelectedBrick& brick : _volume.bricks)
            appendBrick(brick, interval);
    }
    std::shared_ptr<const VolumeMesh> take() { return std::move(_mesh); }

private:
    // Depths of a box, to leave out the bricks and the cuts that an interval does not need.
    core::DepthInterval depthsOf(const core::Box3d& box) const
    {
        core::DepthInterval r{std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()};
        for (int i = 0; i < 8; ++i) {
            const double d = depthPlane(_view.toEye, 0.0).distance(box.corner(i));
            r.nearDepth = std::min(r.nearDepth, d);
            r.farDepth = std::max(r.farDepth, d);
        }
        return r;
    }

    void appendBrick(const SelectedBrick& brick, const core::DepthInterval& interval)
    {
        const glm::dvec3& margin = _volume.look->pixelMargin;
        const bool inFrame = _volume.prepared->voxelFrame;
        const core::Box3d& shown = inFrame ? brick.box : _volume.prepared->regionBox;
        const core::Box3d box{shown.min - margin, shown.max + margin};
        const core::DepthInterval depths = depthsOf(box);
        if (depths.farDepth <= interval.nearDepth || depths.nearDepth >= interval.farDepth) return;
        _polytope.setBox(box);
        for (core::Plane plane : _volume.prepared->obliquePlanes) {
            plane.offset += glm::dot(glm::abs(plane.normal), margin);
            _polytope.clip(plane, CUT);
        }
        // A little beyond the near plane, so that the cap on it is not cut off by GL.
        const double nearest = std::max(interval.nearDepth, _nearPlane);
        if (depths.nearDepth < nearest) _polytope.clip(depthPlane(_view.toEye, nearest), CUT);
        if (depths.farDepth > interval.farDepth)
            _polytope.clip(flipped(depthPlane(_view.toEye, interval.farDepth)), CUT);
        if (_polytope.empty()) return;

        BrickBatch batch = batchOf(brick);
        batch.firstIndex = static_cast<unsigned>(_mesh->indices.size());
        appendFaces(interval);
        batch.indexCount = static_cast<unsigned>(_mesh->indices.size()) - batch.firstIndex;
        if (batch.indexCount > 0) _mesh->batches.push_back(batch);
    }

    // Whether a face is seen from outside: the eye (w = 0: the direction to it) is in front of it.
    bool facesEye(std::size_t face) const
    {
        const glm::dvec3 v = _polytope.vertices[_polytope.indices[_polytope.faceOffsets[face]]];
        return glm::dot(_polytope.faceNormal(face), glm::dvec3(_eye) - v * _eye.w) > 0.0;
    }

    void appendFaces(const core::DepthInterval& interval)
    {
        const double reference = _volume.look->referenceDepth;
        // Outermost intervals hold all samples to the ends of the volume, wherever something shows.
        const bool nearest = interval.nearDepth <= _volume.depth.nearDepth;
        const bool farthest = interval.farDepth >= _volume.depth.farDepth;
        const float nearDepth = static_cast<float>(
            (nearest ? _volume.wholeDepth.nearDepth : interval.nearDepth) - reference);
        const float farDepth = static_cast<float>(
            (farthest ? _volume.wholeDepth.farDepth : interval.farDepth) - reference);
        for (std::size_t f = 0; f < _polytope.faceCount(); ++f) {
            if (!facesEye(f)) continue;
            const auto first = static_cast<unsigned>(_mesh->vertices.size() / SLAB_STRIDE);
            const std::uint32_t begin = _polytope.faceOffsets[f],
                                end = _polytope.faceOffsets[f + 1];
            for (std::uint32_t i = begin; i < end; ++i) {
                const glm::vec3 p(_polytope.vertices[_polytope.indices[i]]);
                _mesh->vertices.insert(_mesh->vertices.end(), {p.x, p.y, p.z, nearDepth, farDepth});
            }
            for (unsigned i = 2; i < end - begin; ++i)
                _mesh->indices.insert(_mesh->indices.end(), {first, first + i - 1, first + i});
            ++_mesh->faceCount;
        }
    }

    const VolumeInstance& _volume;
    const core::View& _view;
    const glm::dvec4 _eye;
    double _nearPlane = -std::numeric_limits<double>::infinity();
    core::ConvexPolytope _polytope;
    std::shared_ptr<VolumeMesh> _mesh;
};

} // namespace

std::shared_ptr<const VolumeMesh> slabMesh(const VolumeInstance& volume, const core::View& view,
                                           const std::vector<core::DepthInterval>& farToNear)
{
    const Result<glm::dvec4> eye = core::eyePosition(view);
    if (!eye) return std::make_shared<VolumeMesh>();
    SlabMeshBuilder builder(volume, view, *eye);
    for (const core::DepthInterval& interval : farToNear)
        builder.append(interval);
    return builder.take();
}

std::shared_ptr<const VolumeMesh> screenMesh(const BrickBatch& batch,
                                             const std::vector<core::DepthInterval>& farToNear)
{
    auto mesh = std::make_shared<VolumeMesh>();
    mesh->stride = SLAB_STRIDE;
    mesh->slabOffset = 3;
    mesh->batches.push_back(batch);
    mesh->batches.back().firstIndex = 0;
    for (const core::DepthInterval& interval : farToNear) {
        for (const glm::vec2 corner :
             {glm::vec2(-1.0f), glm::vec2(3.0f, -1.0f), glm::vec2(-1.0f, 3.0f)}) {
            mesh->indices.push_back(static_cast<unsigned>(mesh->vertices.size() / SLAB_STRIDE));
            mesh->vertices.insert(
                mesh->vertices.end(),
                {corner.x, corner.y, 0.0f, float(interval.nearDepth), float(interval.farDepth)});
        }
        ++mesh->faceCount;
    }
    mesh->batches.back().indexCount = static_cast<unsigned>(mesh->indices.size());
    return mesh;
}

std::shared_ptr<const VolumeMesh> screenMesh(const VolumeInstance& volume)
{
    const double reference = volume.look->referenceDepth;
    return screenMesh(batchOf(volume.bricks.front()), {{volume.wholeDepth.nearDepth - reference,
                                                        volume.wholeDepth.farDepth - reference}});
}

} // namespace render
} // namespace osgVolumizer
