#include "VolumeView.h"

#include "../../VolumeGeometry.h"
#include "../../render/textures/BrickCells.h"
#include "../../render/volume/CutInForce.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <osg/FrameStamp>

#include <algorithm>
#include <set>

namespace osgVolumizer {
namespace picking {

namespace {

using A = VolumeAppearance;

render::TimeSteps stepsAt(const VolumeAppearance& appearance, double simulationTime)
{
    if (appearance.getVoxels()->getStepCount() <= 1) return {};
    const osg::ref_ptr<osg::FrameStamp> stamp = new osg::FrameStamp;
    stamp->setSimulationTime(simulationTime);
    return render::timeStepsOf(appearance, stamp);
}

} // namespace

VolumeView::VolumeView(const VolumeGeometry& geometry, const VolumeAppearance& appearance,
                       double simulationTime)
    : voxels(geometry.getScalars() ? nullptr : appearance.getVoxels())
{
    if (voxels && !voxels->valid()) return;
    region = pickRegion(geometry, voxels.get());
    if (!region) return;
    look = makePickLook(appearance, region->prepared(), geometry.getScalarRange());
    if (voxels) steps = stepsAt(appearance, simulationTime);
    cut = render::cutInForce(appearance, region->prepared());
}

std::vector<Span> VolumeView::spans(const Segment& segment,
                                    const std::vector<osg::Vec4d>& clipPlanes) const
{
    const std::vector<Span> whole = region->spans(segment, clipPlanes);
    if (!cut) return whole;
    std::vector<Span> left;
    for (const Span& span : whole) {
        glm::dvec3 ends[2] = {span.voxelAt(span.begin), span.voxelAt(span.end)};
        double resolution = 0.01 * glm::length(ends[1] - ends[0]);
        if (voxels) {
            const osg::Vec3d s = voxels->getSpacing();
            resolution = 0.05 * std::min({s.x(), s.y(), s.z()});
            for (glm::dvec3& end : ends)
                end = render::boxToCut(*voxels, {end, end}).min;
        } else {
            ends[0] = segment.at(span.begin);
            ends[1] = segment.at(span.end);
        }
        for (const auto& part : cut->keptParts(ends[0], ends[1], resolution)) {
            left.push_back(span);
            left.back().begin = glm::mix(span.begin, span.end, part.first);
            left.back().end = glm::mix(span.begin, span.end, part.second);
        }
    }
    return left;
}

bool VolumeView::isKeptAt(const glm::dvec3& voxel) const
{
    return !cut || !voxels || cut->share(render::boxToCut(*voxels, {voxel, voxel}).min) >= 0.5;
}

bool VolumeView::isKept(const core::Box3d& box) const
{
    return !cut || !voxels || !cut->keepsNothingOf(render::boxToCut(*voxels, box));
}

int VolumeView::levelCount() const
{
    return voxels && voxels->isPaged() ? voxels->getTree().levelCount() : 1;
}

bool VolumeView::shows(const core::ValueRange& r) const
{
    if (look.rayFunction == A::ISOSURFACE)
        return r.low <= look.isoFraction && look.isoFraction <= r.high;
    const bool gathers = look.rayFunction != A::COMPOSITE;
    return gathers || look.maximumOpacity(r.low, r.high) > 0.0;
}

// Ranges are those of the samples: near enough to count bytes.
bool VolumeView::counts(const GridReader& grid, std::int64_t index) const
{
    core::ValueRange range;
    if (!grid.knownRange(index, range)) return true;
    if (range.empty()) return false;
    return look.interpolation == A::CUBIC || steps.blended ||
           shows({look.fraction(range.low), look.fraction(range.high)});
}

std::int64_t VolumeView::bytesAlong(const std::vector<Span>& spans, int level, std::int64_t most,
                                    bool hidden) const
{
    const GridReader grid(*voxels, level, steps.first, false);
    std::set<std::int64_t> seen;
    std::int64_t bytes = 0;
    for (const Span& span : spans) {
        const GridLine line(span, grid);
        for (double t = span.begin; t < span.end && line.speed() > 0.0 && bytes <= most;) {
            const GridReader::Place place = grid.placeOf(line.cellAfter(t, 0.0));
            if (seen.insert(place.index).second && (hidden || counts(grid, place.index)))
                bytes += steps.count() * grid.bytesOf(place.index);
            t = line.leaves(place.box, t);
        }
    }
    return bytes;
}

int VolumeView::levelWithin(const std::vector<Span>& spans, std::int64_t bytes, int from,
                            bool hidden) const
{
    for (int level = from; level + 1 < levelCount(); ++level)
        if (bytesAlong(spans, level, bytes, hidden) <= bytes) return level;
    return std::max(levelCount() - 1, 0);
}

int VolumeView::levelWithin(const std::vector<core::Box3d>& boxes, std::int64_t most) const
{
    for (int level = 0; level + 1 < levelCount(); ++level) {
        const GridReader grid(*voxels, level, steps.first, false);
        // Without a look at what would be too much anyway.
        double pages = 0.0;
        std::set<std::int64_t> seen;
        std::int64_t bytes = 0;
        for (const core::Box3d& box : boxes) {
            const core::Box3d b{(box.min - grid.offset()) / grid.spacing(),
                                (box.max - grid.offset()) / grid.spacing()};
            const glm::dvec3 size = b.size() / double(voxels->getTree().step()) + 2.0;
            pages += size.x * size.y * size.z;
            constexpr double MANY = 65536.0;
            if (pages > MANY) bytes = most + 1;
            if (bytes > most) break;
            for (const GridReader::Place& place : grid.placesIn(b))
                if (seen.insert(place.index).second && counts(grid, place.index))
                    bytes += steps.count() * grid.bytesOf(place.index);
        }
        if (bytes <= most) return level;
    }
    return std::max(levelCount() - 1, 0);
}

std::unique_ptr<ValueField> VolumeView::fieldOf(int level) const
{
    if (!voxels) return nullptr;
    return std::make_unique<ValueField>(*voxels, look, steps, level);
}

glm::dmat3 VolumeView::voxelPerObject(const Span& span) const
{
    const glm::dmat3 toFrame = glm::inverse(glm::dmat3(region->prepared().frameToObject));
    glm::dmat4 map;
    return span.inTetrahedron && region->voxelMap(span.tetrahedron, map) ? glm::dmat3(map) * toFrame
                                                                         : toFrame;
}

glm::dvec3 VolumeView::normalAt(ValueField* field, const Segment& segment, const Span& span,
                                double parameter) const
{
    const glm::dvec3 direction = glm::normalize(segment.direction());
    if (!field) return -direction;
    const GridLine line(span, field->grid());
    const glm::dvec3 inVoxels = field->gradientAt(line.at(parameter)) / field->grid().spacing();
    glm::dvec3 normal = glm::transpose(voxelPerObject(span)) * inVoxels;
    // First to a size that can be squared.
    const double largest =
        std::max({std::fabs(normal.x), std::fabs(normal.y), std::fabs(normal.z)});
    normal /= largest;
    if (!(glm::dot(normal, normal) > 0.0)) return -direction;
    normal = glm::normalize(normal);
    return glm::dot(normal, direction) > 0.0 ? -normal : normal;
}

} // namespace picking
} // namespace osgVolumizer
