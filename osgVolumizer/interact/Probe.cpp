#include "Probe.h"

#include "../VolumeAppearance.h"
#include "../VolumeGeometry.h"
#include "../core/Text.h"
#include "private/GlmToOsg.h"
#include "private/VolumeView.h"

#include <osg/Transform>

#include <cmath>

namespace osgVolumizer {

namespace {

using picking::Segment;
using picking::Span;

Status checkSegment(const Segment& segment)
{
    if (segment.valid()) return {};
    return {ErrorCode::VALUE_INVALID, "a segment from " + core::formatTriple(segment.start) +
                                          " to " + core::formatTriple(segment.end) +
                                          " has no length, or is not finite"};
}

// The parts of spans in a brick.
Status keepBrick(const Voxels& voxels, std::int64_t brick, std::vector<Span>& spans)
{
    if (brick == -1) return {};
    const core::BrickLayout& layout = voxels.getLayout();
    if (brick < 0 || brick >= layout.brickCount())
        return {ErrorCode::INDEX_OUT_OF_RANGE,
                "brick " + std::to_string(brick) + " is probed, of " +
                    std::to_string(layout.brickCount()),
                brick};
    std::vector<Span> kept;
    for (Span span : spans)
        if (core::cutSegment(layout.brick(brick).clipBox, span.voxelAt(0.0), span.voxelAt(1.0),
                             span.begin, span.end) &&
            span.begin < span.end)
            kept.push_back(span);
    spans = std::move(kept);
    return {};
}

/// Goes along a line, voxel by voxel.
class Prober
{
public:
    Prober(const picking::VolumeView& view, picking::ValueField& field, const Segment& segment)
        : _view(view), _field(field), _segment(segment),
          _units(picking::unitsPerParameter(segment, view.look)),
          _composites(view.look.rayFunction == VolumeAppearance::COMPOSITE && !view.look.paints)
    {
    }

    void add(const Span& span, std::vector<ProbedVoxel>& voxels)
    {
        constexpr double HALF = 0.5; // samples lie in the middle of voxels
        const picking::GridLine line(span, _field.grid());
        if (!(line.speed() > 0.0)) return;
        for (double t = span.begin; t < span.end;) {
            const glm::ivec3 index = line.cellAfter(t, HALF);
            const glm::dvec3 low = glm::dvec3(index) - HALF;
            const double next = std::min(span.end, line.leaves({low, low + 1.0}, t));
            voxels.push_back(voxelOf(span, line, index, t, next));
            t = next;
        }
    }

private:
    ProbedVoxel voxelOf(const Span& span, const picking::GridLine& line, const glm::ivec3& index,
                        double begin, double end)
    {
        const double middle = 0.5 * (begin + end), length = _segment.length();
        ProbedVoxel voxel;
        const glm::ivec3 held = glm::clamp(index, glm::ivec3(0), _field.grid().size() - 1);
        voxel.index.set(held.x, held.y, held.z);
        voxel.object = voxel.world = picking::toOsg(_segment.at(middle));
        voxel.distance = middle * length;
        voxel.length = (end - begin) * length;
        voxel.raw = _field.rawSample(held, _view.look.rgba ? 3 : 0);
        voxel.filtered = _field.dataAt(line.at(middle), _view.look.rgba ? 3 : 0);
        const glm::dvec4 color = _field.colorAt(line.at(middle), span.colorAt(middle));
        voxel.color.set(color.r, color.g, color.b, color.a);
        advance(span, begin, middle);
        voxel.transmittance = std::exp(-_depth);
        advance(span, middle, end);
        return voxel;
    }
    void advance(Span span, double begin, double end)
    {
        span.begin = begin;
        span.end = end;
        double reached = 0.0;
        if (_composites)
            _depth += picking::opticalDepth(_field, _view.look, span, _units, HUGE_VAL, reached);
    }

    const picking::VolumeView& _view;
    picking::ValueField& _field;
    const Segment& _segment;
    double _units;
    bool _composites;
    double _depth = 0.0; ///< optical, of everything in front
};

} // namespace

Result<VoxelProbe> probe(const VolumeGeometry& geometry, const VolumeAppearance& appearance,
                         const osg::Vec3d& start, const osg::Vec3d& end,
                         const ProbeOptions& options)
{
    const Segment segment{picking::toGlm(start), picking::toGlm(end)};
    if (Status status = checkSegment(segment); !status.ok()) return status;
    const picking::VolumeView view(geometry, appearance, options.simulationTime);
    if (!view.voxels || !view.voxels->valid())
        return Status(ErrorCode::VALUE_INVALID,
                      "VolumeAppearance \"" + appearance.getName() + "\" has no voxels to probe");
    VoxelProbe result;
    if (!view.region) return result;
    std::vector<Span> spans = view.spans(segment, options.clipPlanes);
    if (Status status = keepBrick(*view.voxels, options.brick, spans); !status.ok()) return status;
    for (int level = 0;; ++level) {
        level = view.levelWithin(spans, options.maximumBytes, level, true);
        const auto field = view.fieldOf(level);
        Prober prober(view, *field, segment);
        result.voxels.clear();
        result.level = level;
        for (const Span& span : spans)
            prober.add(span, result.voxels);
        if (!field->failed() || level + 1 >= view.levelCount()) return result;
    }
}

Result<VoxelProbe> probe(const osg::NodePath& path, const osg::Vec3d& worldStart,
                         const osg::Vec3d& worldEnd, const ProbeOptions& options)
{
    const VolumeGeometry* geometry = geometryOf(path);
    const VolumeAppearance* appearance = appearanceOf(path);
    if (!geometry || !appearance)
        return Status(ErrorCode::VALUE_INVALID, "a path to be probed does not lead to a "
                                                "VolumeGeometry below a VolumeAppearance");
    const osg::Matrixd toWorld = osg::computeLocalToWorld(path);
    osg::Matrixd toObject;
    if (!picking::invert(toWorld, toObject))
        return Status(ErrorCode::SINGULAR_MATRIX,
                      "the transforms above a volume to be probed have no inverse");
    ProbeOptions cut = options;
    for (const osg::Vec4d& plane : clipPlanesAbove(path))
        cut.clipPlanes.push_back(plane);
    Result<VoxelProbe> found =
        probe(*geometry, *appearance, worldStart * toObject, worldEnd * toObject, cut);
    for (ProbedVoxel& voxel : found.value.voxels)
        voxel.world = voxel.object * toWorld;
    return found;
}

Result<std::vector<CrossedFace>> crossedFaces(const VolumeGeometry& geometry,
                                              const osg::Vec3d& start, const osg::Vec3d& end)
{
    const Segment segment{picking::toGlm(start), picking::toGlm(end)};
    if (Status status = checkSegment(segment); !status.ok()) return status;
    const auto set = geometry.getTetraSet();
    std::vector<CrossedFace> faces;
    for (const core::BoundaryCrossing& crossing :
         core::boundaryCrossings(*set, segment.start, segment.end)) {
        CrossedFace face;
        face.tetrahedron = crossing.tetrahedron;
        for (std::size_t i = 0; i < 3; ++i)
            face.vertices[i] = crossing.vertices[i];
        face.ratio = crossing.parameter;
        face.point = picking::toOsg(segment.at(crossing.parameter));
        face.enters = crossing.enters;
        faces.push_back(face);
    }
    return faces;
}

} // namespace osgVolumizer
