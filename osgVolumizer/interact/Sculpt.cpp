#include "Sculpt.h"

#include "../core/Text.h"
#include "../core/voxels/ChangeLog.h"
#include "../core/voxels/VoxelData.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <string>
#include <utility>

namespace osgVolumizer {

namespace {

// Boxes of a stroke above which they are joined again.
constexpr std::size_t MANY_BOXES = 1 << 14;

bool isFraction(double v)
{
    return v > 0.0 && v <= 1.0;
}

Status refusedTool(const std::string& what, const char* expected)
{
    return {ErrorCode::VALUE_INVALID, "of a sculpting tool the " + what + ", expected " + expected};
}

Status checkTool(const Sculptor::Tool& tool)
{
    constexpr double FAR = 1e18;
    for (int axis = 0; axis < 3; ++axis)
        if (!(tool.radius[axis] > 0.0 && tool.radius[axis] <= FAR))
            return refusedTool("radius is " +
                                   core::formatTriple(glm::dvec3(tool.radius.x(), tool.radius.y(),
                                                                 tool.radius.z())),
                               "each to be above 0, up to 1e18");
    if (!isFraction(tool.strength))
        return refusedTool("strength is " + core::formatNumber(tool.strength),
                           "more than 0, up to 1");
    if (!isFraction(tool.spacing))
        return refusedTool("spacing is " + core::formatNumber(tool.spacing),
                           "more than 0, up to 1");
    if (tool.erased && !std::isfinite(*tool.erased))
        return refusedTool("erased value is " + core::formatNumber(*tool.erased),
                           "a finite number");
    return {};
}

} // namespace

Sculptor::~Sculptor()
{
    endStroke();
}

ReportedStatus Sculptor::setTool(const Tool& tool)
{
    if (Status status = checkTool(tool); !status.ok()) return reported(std::move(status));
    _tool = tool;
    return {};
}

// Makes the source one that can be written to; what was done to another is history.
Status Sculptor::prepare()
{
    if (!_voxels) return {ErrorCode::VALUE_INVALID, "there are no voxels to be changed"};
    const auto editable = makeEditable(*_voxels);
    if (!editable.ok()) return editable.status;
    if (_source != *editable) {
        endStroke();
        _undo.clear();
        _redo.clear();
        _source = *editable;
    }
    return {};
}

core::SculptTool Sculptor::toolVoxel() const
{
    const osg::Vec2d range = _voxels->getRange();
    const osg::Vec3d spacing = _voxels->getSpacing();
    core::SculptTool tool;
    tool.operation = _tool.operation;
    tool.shape = _tool.shape;
    tool.strength = _tool.strength;
    tool.low = range.x();
    tool.high = range.y();
    tool.erased = _tool.erased.value_or(range.x());
    for (int axis = 0; axis < 3; ++axis)
        tool.radius[axis] = _tool.radius[axis] / (_tool.unit == OBJECT ? spacing[axis] : 1.0);
    return tool;
}

glm::dvec3 Sculptor::toVoxel(const osg::Vec3d& point) const
{
    const osg::Vec3d origin = _voxels->getOrigin(), spacing = _voxels->getSpacing();
    glm::dvec3 voxel;
    for (int axis = 0; axis < 3; ++axis)
        voxel[axis] = (point[axis] - origin[axis]) / spacing[axis];
    return voxel;
}

// The dabs on the way to a point. Distances are of the radius in their direction.
Status Sculptor::placeDabs(const osg::Vec3d& end, Path& path, std::vector<glm::dvec3>& dabs) const
{
    const glm::dvec3 place = toVoxel(end);
    if (!(std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z)))
        return {ErrorCode::VALUE_INVALID,
                "a stroke goes to " + core::formatTriple(glm::dvec3(end.x(), end.y(), end.z())) +
                    ", which is no place"};
    const glm::dvec3 way = place - path.last;
    const double length = glm::length(way / toolVoxel().radius) / _tool.spacing;
    if (!(length < double(MAXIMUM_DABS)))
        return {ErrorCode::TOO_LARGE, "a stroke between two points has " +
                                          core::formatNumber(length) + " dabs, more than " +
                                          std::to_string(MAXIMUM_DABS)};
    double at = path.left;
    for (; at <= length; at += 1.0)
        dabs.push_back(path.last + way * (length > 0.0 ? at / length : 0.0));
    path = {place, at - length};
    return {};
}

// Reads what the dabs may change: only this can fail.
Status Sculptor::holdAll(const std::vector<glm::dvec3>& dabs)
{
    const core::SculptTool tool = toolVoxel();
    const core::Box3i all{glm::ivec3(0), _voxels->getLayout().size()};
    for (const glm::dvec3& dab : dabs) {
        const core::Box3i box = intersection(core::toolBox(tool, dab), all);
        if (box.empty()) continue;
        if (Status status = _source->hold(box); !status.ok()) return status;
    }
    return {};
}

bool Sculptor::applyDab(const core::SculptTool& tool, const glm::dvec3& middleVoxel,
                        std::vector<core::Box3i>& changed)
{
    const core::Box3i all{glm::ivec3(0), _voxels->getLayout().size()};
    const core::Box3i box = intersection(core::toolBox(tool, middleVoxel), all);
    if (box.empty()) return false;
    const VoxelType type = _voxels->getType();
    const int components = _voxels->getComponents();
    _buffer.resize(static_cast<std::size_t>(core::voxelBytes(box.size(), type, components)));
    if (!_source->read(box, _buffer.data()).ok()) return false; // it is held
    const std::size_t before = changed.size();
    core::applyTool(tool, middleVoxel, _buffer.data(), box, type, components, changed);
    return changed.size() > before && _source->write(box, _buffer.data()).ok();
}

std::int64_t Sculptor::apply(const std::vector<glm::dvec3>& dabs)
{
    const core::SculptTool tool = toolVoxel();
    std::vector<core::Box3i> changed;
    std::int64_t count = 0;
    for (const glm::dvec3& dab : dabs)
        count += applyDab(tool, dab, changed);
    changed = core::coveringBoxes(changed);
    _source->updateLevels(changed);
    _voxels->dirtyRegions(changed);
    _changed.insert(_changed.end(), changed.begin(), changed.end());
    if (_changed.size() > MANY_BOXES) _changed = core::coveringBoxes(_changed);
    return count;
}

Result<std::int64_t> Sculptor::beginStroke(const osg::Vec3d& point)
{
    return begin({point});
}

Result<std::int64_t> Sculptor::begin(const std::vector<osg::Vec3d>& points)
{
    if (points.empty()) return Status(ErrorCode::VALUE_INVALID, "a stroke has no points");
    if (Status status = prepare(); !status.ok()) return status;
    std::vector<glm::dvec3> dabs;
    Path path{toVoxel(points.front()), 0.0};
    for (const osg::Vec3d& point : points)
        if (Status status = placeDabs(point, path, dabs); !status.ok()) return status;
    if (Status status = holdAll(dabs); !status.ok()) return status;
    endStroke();
    _stroking = true;
    _path = path;
    _source->beginEdit();
    return apply(dabs);
}

Result<std::int64_t> Sculptor::strokeTo(const osg::Vec3d& point)
{
    if (_stroking)
        if (Status status = prepare(); !status.ok()) return status;
    if (!_stroking) return Status(ErrorCode::VALUE_INVALID, "no stroke has begun");
    std::vector<glm::dvec3> dabs;
    Path path = _path;
    if (Status status = placeDabs(point, path, dabs); !status.ok()) return status;
    if (Status status = holdAll(dabs); !status.ok()) return status;
    _path = path;
    return apply(dabs);
}

void Sculptor::endStroke()
{
    if (!_stroking) return;
    _stroking = false;
    Edit edit = _source->endEdit(core::coveringBoxes(_changed));
    _changed.clear();
    if (edit.boxes().empty()) return;
    _redo.clear();
    _undo.push_back(std::move(edit));
    limitHistory();
}

Result<std::int64_t> Sculptor::stroke(const std::vector<osg::Vec3d>& points)
{
    const Result<std::int64_t> dabs = begin(points);
    if (dabs.ok()) endStroke();
    return dabs;
}

// What was done to a source that the voxels have no longer cannot be undone.
void Sculptor::forgetAnotherSource()
{
    if (_voxels && _source && _voxels->getSource() == _source.get()) return;
    _undo.clear();
    _redo.clear();
}

Status Sculptor::undo()
{
    endStroke();
    forgetAnotherSource();
    if (_undo.empty()) return {ErrorCode::VALUE_INVALID, "there is no stroke to undo"};
    const Edit edit = std::move(_undo.back());
    _undo.pop_back();
    _source->undo(edit);
    _voxels->dirtyRegions(edit.boxes());
    _redo.push_back(edit);
    return {};
}

Status Sculptor::redo()
{
    endStroke();
    forgetAnotherSource();
    if (_redo.empty()) return {ErrorCode::VALUE_INVALID, "there is no stroke to do again"};
    const Edit edit = std::move(_redo.back());
    _redo.pop_back();
    _source->redo(edit);
    _voxels->dirtyRegions(edit.boxes());
    _undo.push_back(edit);
    return {};
}

void Sculptor::setHistoryBytes(std::size_t bytes)
{
    _historyBytes = bytes;
    limitHistory();
}

std::size_t Sculptor::bytesOf(const std::deque<Edit>& edits)
{
    std::size_t bytes = 0;
    for (const Edit& edit : edits)
        bytes += edit.bytes();
    return bytes;
}

void Sculptor::limitHistory()
{
    while (!_undo.empty() && bytesOf(_undo) + bytesOf(_redo) > _historyBytes)
        _undo.pop_front();
    while (!_redo.empty() && bytesOf(_redo) > _historyBytes)
        _redo.pop_front();
}

} // namespace osgVolumizer
