#include "VolumeCut.h"

#include "core/Text.h"
#include "core/voxels/ValueReader.h"
#include "private/Copied.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace osgVolumizer {

namespace {

constexpr int SURFACE_SAMPLES = 128, MASK_SAMPLES = 256;

core::Plane planeOf(const CutRegion& region)
{
    const osg::Vec4d& p = region.getPlane();
    core::Plane plane{{p.x(), p.y(), p.z()}, p.w()};
    const double scale = (region.isComplement() ? -1.0 : 1.0) / glm::length(plane.normal);
    return {plane.normal * scale, plane.offset * scale};
}

core::CutShape shapeOf(const CutRegion& region)
{
    const auto vec = [](const osg::Vec3d& v) { return glm::dvec3(v.x(), v.y(), v.z()); };
    core::CutShape shape;
    shape.keepInside = !region.isComplement();
    if (region.getKind() == CutRegion::SPHERE) {
        shape.center = vec(region.getCenter());
        shape.radius = region.getRadius();
    } else {
        const osg::BoundingBoxd& box = region.getBox();
        shape.center = vec(box.center());
        shape.halfSize = 0.5 * (vec(box._max) - vec(box._min));
    }
    return shape;
}

std::vector<core::Plane> facesOf(const osg::BoundingBoxd& box)
{
    std::vector<core::Plane> planes;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {1.0, -1.0}) {
            core::Plane plane;
            plane.normal = glm::dvec3(0.0);
            plane.normal[axis] = side;
            plane.offset = side > 0.0 ? -box._min[axis] : box._max[axis];
            planes.push_back(plane);
        }
    return planes;
}

/// How much a place is inside a mask: above 0 where it is.
class MaskValue
{
public:
    explicit MaskValue(const CutRegion& region)
        : _region(region), _voxels(*region.getMask()), _labels(std::isfinite(region.getMaskHigh())),
          _reader(
              _voxels.getLayout(), [this](std::int64_t brick) { return load(brick); },
              core::ValueReader::LINEAR, _voxels.getComponents() == 4 ? 3 : 0)
    {
    }
    double operator()(const glm::dvec3& place)
    {
        const osg::Vec3d o = _voxels.getOrigin(), s = _voxels.getSpacing();
        const double value = _reader.value((place - glm::dvec3(o.x(), o.y(), o.z())) /
                                           glm::dvec3(s.x(), s.y(), s.z()));
        if (std::isnan(value)) return value;
        return _labels ? value - 0.5 : value - _region.getMaskLow();
    }

private:
    // Of labels: 1 for those of the mask, else 0.
    core::ValueReader::Brick load(std::int64_t brick) const
    {
        const Voxels::Block block = _voxels.getBrick(brick);
        core::ValueReader::Brick result;
        if (!block) return result;
        result.view = {block.data, _voxels.getType(), _voxels.getComponents(),
                       _voxels.getLayout().brick(brick).samples.size()};
        result.owner = block.owner;
        if (!_labels) return result;
        const std::int64_t count = core::sampleCount(result.view.size);
        auto inside = std::make_shared<std::vector<std::uint8_t>>(static_cast<std::size_t>(count));
        const int component = _voxels.getComponents() == 4 ? 3 : 0;
        for (std::int64_t i = 0; i < count; ++i) {
            const double value = core::voxelValue(result.view, i, component);
            (*inside)[static_cast<std::size_t>(i)] =
                value >= _region.getMaskLow() && value <= _region.getMaskHigh();
        }
        result.view = {inside->data(), VoxelType::UINT8, 1, result.view.size};
        result.owner = inside;
        return result;
    }

    const CutRegion& _region;
    const Voxels& _voxels;
    const bool _labels;
    core::ValueReader _reader;
};

// What has no place among planes and shapes.
void cutField(core::DistanceField& field, const CutRegion& region, bool soft)
{
    const bool inside = !region.isComplement();
    if (region.getKind() == CutRegion::SURFACE)
        return field.cutBySurface(*region.getMesh(), inside);
    if (region.getKind() == CutRegion::MASK) {
        MaskValue value(region);
        return field.cutByFunction(
            [&](const glm::dvec3& place) {
                const double v = value(place);
                const double known = std::isnan(v) ? -std::numeric_limits<double>::max() : v;
                return inside ? known : -known;
            },
            soft);
    }
    if (region.getKind() == CutRegion::HALF_SPACE) {
        const core::Plane plane = planeOf(region);
        return field.cutByDistance([&plane](const glm::dvec3& p) { return plane.distance(p); });
    }
    const core::CutShape shape = shapeOf(region);
    field.cutByDistance([&shape](const glm::dvec3& p) { return shape.distance(p); });
}

// Takes a region in as planes or shapes; false where that cannot be.
bool addExactly(const CutRegion& region, bool anyPlanes, core::Cut& cut)
{
    const bool soft = cut.softness > 0.0;
    const auto addPlanes = [&](const std::vector<core::Plane>& planes) {
        if (planes.empty()) return false;
        const std::size_t most =
            soft || !anyPlanes ? VolumeCut::MOST_SHAPES : VolumeCut::MOST_PLANES;
        if (cut.planes.size() + planes.size() > most) return false;
        cut.planes.insert(cut.planes.end(), planes.begin(), planes.end());
        return true;
    };
    const bool inside = !region.isComplement();
    switch (region.getKind()) {
    case CutRegion::HALF_SPACE:
        return addPlanes({planeOf(region)});
    case CutRegion::BOX:
        if (inside && !soft) return addPlanes(facesOf(region.getBox()));
        break;
    case CutRegion::SPHERE:
        break;
    case CutRegion::SURFACE:
        return inside && !soft &&
               addPlanes(core::convexFaces(*region.getMesh(), VolumeCut::MOST_FACES));
    case CutRegion::MASK:
        return false;
    }
    if (cut.shapes.size() == VolumeCut::MOST_SHAPES) return false;
    cut.shapes.push_back(shapeOf(region));
    return true;
}

} // namespace

VolumeCut::VolumeCut(const VolumeCut& o, const osg::CopyOp& op)
    : osg::Object(o, op), _regions(o._regions), _softness(o._softness), _resolution(o._resolution)
{
    for (CutRegion& region : _regions) {
        if (!region.getMask() || !(op.getCopyFlags() & osg::CopyOp::DEEP_COPY_OBJECTS)) continue;
        const CutRegion own =
            CutRegion::mask(copied(osg::ref_ptr<Voxels>(region.getMask()), op).get(),
                            region.getMaskLow(), region.getMaskHigh());
        region = region.isComplement() ? own.complement() : own;
    }
}

ReportedStatus VolumeCut::addRegion(const CutRegion& region)
{
    Status status = region.validate();
    if (status.ok()) {
        _regions.push_back(region);
        dirty();
    }
    return reported(status);
}

ReportedStatus VolumeCut::setRegion(unsigned number, const CutRegion& region)
{
    Status status = region.validate();
    if (number >= _regions.size())
        status = {ErrorCode::INDEX_OUT_OF_RANGE, "a cut has no region " + std::to_string(number),
                  number};
    if (status.ok()) {
        _regions[number] = region;
        dirty();
    }
    return reported(status);
}

ReportedStatus VolumeCut::removeRegion(unsigned number)
{
    if (number >= _regions.size())
        return reported({ErrorCode::INDEX_OUT_OF_RANGE,
                         "a cut has no region " + std::to_string(number), number});
    _regions.erase(_regions.begin() + std::ptrdiff_t(number));
    dirty();
    return {};
}

void VolumeCut::clear()
{
    _regions.clear();
    dirty();
}

ReportedStatus VolumeCut::setSoftness(double objectUnits)
{
    if (!(objectUnits >= 0.0) || !std::isfinite(objectUnits))
        return reported({ErrorCode::VALUE_INVALID, "the softness of a cut is " +
                                                       core::formatNumber(objectUnits) +
                                                       ", expected it finite and not below 0"});
    _softness = objectUnits;
    dirty();
    return {};
}

ReportedStatus VolumeCut::setResolution(int samples)
{
    if (samples != 0 && (samples < 8 || samples > 512))
        return reported({ErrorCode::VALUE_INVALID, "the resolution of a cut is " +
                                                       std::to_string(samples) +
                                                       ", expected 0, or 8 to 512 samples"});
    _resolution = samples;
    dirty();
    return {};
}

glm::ivec3 VolumeCut::samplesFor(const core::Box3d& box) const
{
    int most = _resolution > 0 ? _resolution : SURFACE_SAMPLES;
    for (const CutRegion& region : _regions)
        if (region.getMask() && _resolution == 0) {
            const osg::Vec3i size = region.getMask()->getSize();
            most =
                std::max(most, std::min({std::max({size.x(), size.y(), size.z()}), MASK_SAMPLES}));
        }
    const glm::dvec3 size = box.size();
    const double longest = std::max({size.x, size.y, size.z});
    return glm::max(glm::ivec3(glm::ceil(size / longest * double(most - 1))) + 1, 2);
}

std::shared_ptr<const core::Cut> VolumeCut::make(core::Box3d box, bool anyPlanes) const
{
    // A grid needs some thickness, which has to tell its ends apart.
    const glm::dvec3 size = box.size(), farthest = glm::max(glm::abs(box.min), glm::abs(box.max));
    const double least = std::max({1e-3 * std::max({size.x, size.y, size.z}),
                                   1e-9 * std::max({farthest.x, farthest.y, farthest.z}), 1e-18});
    const glm::dvec3 missing = 0.5 * glm::max(least - size, 0.0);
    box = {box.min - missing, box.max + missing};
    auto cut = std::make_shared<core::Cut>();
    cut->softness = _softness;
    cut->id = core::nextCutId();
    std::vector<const CutRegion*> others;
    for (const CutRegion& region : _regions)
        if (!addExactly(region, anyPlanes, *cut)) others.push_back(&region);
    if (!others.empty()) {
        const glm::ivec3 samples = samplesFor(box);
        const glm::dvec3 edges = box.size() / glm::dvec3(samples - 1);
        const double reach = std::max(2.0 * std::max({edges.x, edges.y, edges.z}), _softness);
        auto field = std::make_shared<core::DistanceField>(box, samples, reach);
        for (const CutRegion* region : others)
            cutField(*field, *region, _softness > 0.0);
        cut->field = field;
    }
    if (cut->empty()) return nullptr;
    return cut;
}

std::shared_ptr<const core::Cut> VolumeCut::cutOf(const core::Box3d& box, bool anyPlanes) const
{
    if (!anyPlanes) { // mostly the same will do
        const CutPtr general = cutOf(box, true);
        if (!general || general->planes.size() <= MOST_SHAPES) return general;
    }
    const unsigned count = _modifiedCount;
    std::lock_guard<std::mutex> lock(_mutex);
    _made.removeIf([count](const auto& made) { return made.key.modifiedCount != count; });
    const Key key{box, anyPlanes, count};
    if (const CutPtr* known = _made.find(key)) return *known;
    return _made.add(key, make(box, anyPlanes));
}

} // namespace osgVolumizer
