#include "RegionSpans.h"

#include "../../Voxels.h"
#include "../../core/RecencyCache.h"
#include "../../core/geometry/TetraMesh.h"
#include "../../render/volume/GeometryCache.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgVolumizer {
namespace picking {

namespace {

/// What is kept with a VolumeGeometry.
class RegionCache : public PickData
{
public:
    std::shared_ptr<const PickRegion> get(const VolumeGeometry& geometry, const Voxels* voxels)
    {
        const VolumeGeometry::ScalarField scalars = geometry.getScalarField();
        const Key key{geometry.getModifiedCount(), voxels, voxels ? voxels->getLayoutCount() : 0,
                      scalars.count};
        std::lock_guard<std::mutex> lock(_mutex);
        if (const auto* known = _regions.find(key)) return *known;
        const auto prepared =
            render::renderData<render::GeometryCache>(geometry)->get(geometry, voxels);
        return _regions.add(key, prepared
                                     ? std::make_shared<const PickRegion>(prepared, voxels, scalars)
                                     : nullptr);
    }

private:
    struct Key
    {
        unsigned modifiedCount;
        const Voxels* voxels;
        unsigned layoutCount, scalarCount;
        bool operator==(const Key& o) const
        {
            return modifiedCount == o.modifiedCount && voxels == o.voxels &&
                   layoutCount == o.layoutCount && scalarCount == o.scalarCount;
        }
    };
    std::mutex _mutex;
    core::RecencyCache<Key, std::shared_ptr<const PickRegion>> _regions{4};
};

// Where spans overlap, as in tetrahedra that do, the first one counts.
void addSpan(Span span, std::vector<Span>& spans)
{
    if (!spans.empty()) span.begin = std::max(span.begin, spans.back().end);
    if (span.begin < span.end) spans.push_back(span);
}

} // namespace

double Segment::length() const
{
    return glm::length(direction());
}

bool Segment::valid() const
{
    const double l = length();
    return std::isfinite(l) && l > 0.0 && std::isfinite(start.x + start.y + start.z);
}

PickRegion::PickRegion(std::shared_ptr<const render::PreparedGeometry> prepared,
                       const Voxels* voxels, const VolumeGeometry::ScalarField& scalars)
    : _prepared(std::move(prepared)), _toFrame(glm::inverse(glm::dmat3(_prepared->frameToObject))),
      _crossings(std::shared_ptr<const core::TetraSet>(_prepared, &_prepared->tetras)),
      _ofCells(scalars.binding == VolumeGeometry::PER_TETRAHEDRON)
{
    const core::TetraSet& set = _prepared->tetras;
    if (scalars.values &&
        scalars.values->size() == (_ofCells ? set.tetraCount() : set.vertices.size()))
        _scalars = scalars.values;
    constexpr double END = std::numeric_limits<double>::infinity();
    _extent = {glm::dvec3(-END), glm::dvec3(END)};
    if (voxels) _extent = voxels->getLayout().extent();
}

// Differences first: far from the origin they are exact.
glm::dvec3 PickRegion::toFrame(const glm::dvec3& object) const
{
    return _toFrame * (object - glm::dvec3(_prepared->frameToObject[3]));
}

std::vector<core::TetraCrossings::Crossing> PickRegion::crossings(const Segment& segment) const
{
    return _crossings.find(toFrame(segment.start), toFrame(segment.end));
}

std::vector<Span> PickRegion::spans(const Segment& segment,
                                    const std::vector<osg::Vec4d>& clipPlanes) const
{
    double begin = 0.0, finish = 1.0;
    for (const osg::Vec4d& plane : clipPlanes)
        if (!core::cutSegment({{plane[0], plane[1], plane[2]}, plane[3]}, segment.start,
                              segment.end, begin, finish))
            return {};
    const glm::dvec3 start = toFrame(segment.start), end = toFrame(segment.end);
    if (_prepared->region && !hasColors() && !_scalars)
        return convexSpan(start, end, begin, finish);
    std::vector<Span> spans;
    for (const auto& crossing : _crossings.find(start, end)) {
        Span span = spanOf(crossing, start, end);
        span.begin = std::max(span.begin, begin);
        span.end = std::min(span.end, finish);
        if (!std::isfinite(span.scalar + span.scalarRate)) continue; // nothing is known there
        if (core::cutSegment(_extent, span.voxelAt(0.0), span.voxelAt(1.0), span.begin, span.end))
            addSpan(span, spans);
    }
    return spans;
}

std::vector<Span> PickRegion::convexSpan(const glm::dvec3& start, const glm::dvec3& end,
                                         double begin, double finish) const
{
    if (!core::cutSegment(_prepared->regionBox, start, end, begin, finish)) return {};
    for (const core::Plane& plane : _prepared->obliquePlanes)
        if (!core::cutSegment(plane, start, end, begin, finish)) return {};
    if (!(begin < finish)) return {};
    Span span;
    span.begin = begin;
    span.end = finish;
    span.voxel = start;
    span.voxelRate = end - start;
    return {span};
}

Span PickRegion::spanOf(const core::TetraCrossings::Crossing& crossing, const glm::dvec3& start,
                        const glm::dvec3& end) const
{
    const core::VertexArray& vertices = _prepared->tetras.vertices;
    const core::VertexFormat& format = vertices.format();
    const auto* corners = &_prepared->tetras.indices[4 * std::size_t(crossing.tetrahedron)];
    Span span;
    span.begin = crossing.begin;
    span.end = crossing.end;
    span.tetrahedron = crossing.tetrahedron;
    span.inTetrahedron = true;
    span.voxel = start;
    span.voxelRate = end - start;
    const double length = crossing.end - crossing.begin;
    if (!(length > 0.0)) return span;
    const auto field = [&](int offset, int i, const glm::dvec4& weights) {
        double sum = 0.0;
        for (int k = 0; k < 4; ++k)
            sum += weights[k] * vertices.record(corners[k])[offset + i];
        return sum;
    };
    const auto line = [&](int offset, int i, double& value, double& rate) {
        const double a = field(offset, i, crossing.beginWeights);
        rate = (field(offset, i, crossing.endWeights) - a) / length;
        value = a - crossing.begin * rate;
    };
    if (format.voxelCoordinateSize == 3)
        for (int i = 0; i < 3; ++i)
            line(format.voxelCoordinateOffset(), i, span.voxel[i], span.voxelRate[i]);
    for (int i = 0; i < format.colorSize; ++i)
        line(format.colorOffset(), i, span.color[i], span.colorRate[i]);
    if (_scalars) setScalars(crossing, span);
    return span;
}

// Of one corner without a value the tetrahedron has none.
void PickRegion::setScalars(const core::TetraCrossings::Crossing& crossing, Span& span) const
{
    if (_ofCells) {
        span.scalar = (*_scalars)[crossing.tetrahedron];
        return;
    }
    const auto* corners = &_prepared->tetras.indices[4 * std::size_t(crossing.tetrahedron)];
    double a = 0.0, b = 0.0, all = 0.0;
    for (int k = 0; k < 4; ++k) {
        const double value = (*_scalars)[corners[k]];
        all += value;
        a += crossing.beginWeights[k] * value;
        b += crossing.endWeights[k] * value;
    }
    span.scalarRate = (b - a) / (crossing.end - crossing.begin);
    span.scalar = std::isfinite(all) ? a - crossing.begin * span.scalarRate : all;
}

std::uint32_t PickRegion::tetrahedronAt(const Segment& segment, double parameter) const
{
    std::uint32_t found = 0;
    for (const auto& crossing : crossings(segment)) {
        if (crossing.begin > parameter) break;
        found = crossing.tetrahedron;
        if (crossing.end > parameter) break;
    }
    return found;
}

bool PickRegion::voxelMap(std::size_t tetrahedron, glm::dmat4& map) const
{
    map = glm::dmat4(1.0);
    if (_prepared->voxelFrame) return true;
    if (_prepared->tetras.vertices.format().voxelCoordinateSize != 3) return false;
    const Result<glm::dmat4> found = core::positionToVoxel(_prepared->tetras, tetrahedron);
    map = found.value;
    return found.ok();
}

std::shared_ptr<const PickRegion> pickRegion(const VolumeGeometry& geometry, const Voxels* voxels)
{
    return pickData<RegionCache>(geometry)->get(geometry, voxels);
}

} // namespace picking
} // namespace osgVolumizer
