#include "VolumeGeometry.h"

#include "Voxels.h"
#include "core/NumberRule.h"
#include "core/Text.h"
#include "core/geometry/Solids.h"
#include "private/FieldShaders.h"
#include "private/Flattening.h"
#include "private/Picker.h"
#include "private/Renderer.h"

#include <osg/FrameStamp>
#include <osgUtil/CullVisitor>
#include <osgUtil/IntersectionVisitor>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>

namespace osgVolumizer {

struct VolumeGeometry::Private
{
    mutable std::mutex mutex;
    TetraSetPtr tetraSet = std::make_shared<const core::TetraSet>();
    std::string fieldShader;
    ScalarsPtr scalars;
    ScalarBinding binding = PER_VERTEX;
    osg::Vec2d range{0.0, 1.0};
    bool automaticRange = true;
    std::atomic<unsigned> modifiedCount{0}, scalarCount{0};

    bool fits(const std::vector<float>& values, ScalarBinding bound) const
    {
        return values.size() ==
               (bound == PER_VERTEX ? tetraSet->vertices.size() : tetraSet->tetraCount());
    }
    std::atomic<double> slackAngle{0.0};
    std::atomic<double> shownTime{0.0}; ///< simulation time of the last cull
};

namespace {

// Bounds are floats in OSG: round outwards, so that a volume far from the origin is never culled.
float roundDown(double v)
{
    const float f = static_cast<float>(v);
    return f > v ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}
float roundUp(double v)
{
    const float f = static_cast<float>(v);
    return f < v ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

// Of the finite values; never empty, as far as floats can tell.
osg::Vec2d rangeOf(const std::vector<float>& values)
{
    float low = INFINITY, high = -INFINITY;
    for (const float value : values) {
        if (!std::isfinite(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
    }
    if (low > high) return {0.0, 1.0};
    if (low == 0.0f && high == 0.0f) return {0.0, 1.0};
    const double least = 1e-6 * std::max({std::abs(double(low)), std::abs(double(high)), 1e-30});
    return {low, std::max(double(high), low + least)};
}

} // namespace

VolumeGeometry::VolumeGeometry() : _private(new Private)
{
    setSupportsDisplayList(false);
    setUseDisplayList(false);
    setUseVertexBufferObjects(false);
}

VolumeGeometry::VolumeGeometry(const VolumeGeometry& o, const osg::CopyOp& op)
    : osg::Drawable(o, op), _private(new Private)
{
    _private->slackAngle = o.getSlackAngle();
    std::lock_guard<std::mutex> lock(o._private->mutex);
    _private->tetraSet = o._private->tetraSet;
    _private->scalarCount = 1;
    _private->fieldShader = o._private->fieldShader;
    _private->scalars = o._private->scalars;
    _private->binding = o._private->binding;
    _private->range = o._private->range;
    _private->automaticRange = o._private->automaticRange;
}

VolumeGeometry::~VolumeGeometry() = default;

osg::ref_ptr<VolumeGeometry> VolumeGeometry::createBox(const Voxels& voxels)
{
    const core::Box3d extent = voxels.getLayout().extent();
    const osg::Vec3d spacing = voxels.getSpacing(), origin = voxels.getOrigin();
    osg::BoundingBoxd box;
    for (int i : {0, 7}) {
        const glm::dvec3 c = extent.corner(i);
        box.expandBy(origin + osg::Vec3d(c.x * spacing.x(), c.y * spacing.y(), c.z * spacing.z()));
    }
    return createBox(box);
}

osg::ref_ptr<VolumeGeometry> VolumeGeometry::createBox(const osg::BoundingBoxd& box,
                                                       BoxTessellation tessellation)
{
    osg::ref_ptr<VolumeGeometry> geometry = new VolumeGeometry;
    geometry->setBox(box, tessellation);
    return geometry;
}

ReportedStatus VolumeGeometry::setBox(const osg::BoundingBoxd& box, BoxTessellation tessellation)
{
    const core::Box3d b{{box.xMin(), box.yMin(), box.zMin()}, {box.xMax(), box.yMax(), box.zMax()}};
    return setTetraSet(
        core::tessellateBox(b, tessellation == ENCLOSING     ? core::BoxTessellation::ENCLOSING
                               : tessellation == TWENTY_FOUR ? core::BoxTessellation::TWENTY_FOUR
                                                             : core::BoxTessellation::FIVE));
}

ReportedStatus VolumeGeometry::setTetraSet(core::TetraSet tetraSet)
{
    Status status = tetraSet.validate();
    if (!status) {
        status.text = "VolumeGeometry \"" + getName() + "\": " + status.text;
        return reported(std::move(status));
    }
    auto shared = std::make_shared<const core::TetraSet>(std::move(tetraSet));
    {
        std::lock_guard<std::mutex> lock(_private->mutex);
        _private->tetraSet = std::move(shared);
        if (_private->scalars && !_private->fits(*_private->scalars, _private->binding)) {
            _private->scalars = nullptr;
            ++_private->scalarCount;
        }
    }
    ++_private->modifiedCount;
    dirtyBound();
    return {};
}

VolumeGeometry::TetraSetPtr VolumeGeometry::getTetraSet() const
{
    std::lock_guard<std::mutex> lock(_private->mutex);
    return _private->tetraSet;
}

unsigned VolumeGeometry::getModifiedCount() const
{
    return _private->modifiedCount;
}

ReportedStatus VolumeGeometry::setFieldShader(const std::string& glsl)
{
    if (fieldShaderNumber(glsl) < 0)
        return reported({ErrorCode::TOO_LARGE, "VolumeGeometry \"" + getName() +
                                                   "\": there are 1023 field shaders already"});
    {
        std::lock_guard<std::mutex> lock(_private->mutex);
        _private->fieldShader = glsl;
    }
    ++_private->modifiedCount;
    return {};
}

std::string VolumeGeometry::getFieldShader() const
{
    std::lock_guard<std::mutex> lock(_private->mutex);
    return _private->fieldShader;
}

ReportedStatus VolumeGeometry::setScalars(std::vector<float> scalars, ScalarBinding binding)
{
    const std::size_t count = scalars.size();
    std::unique_lock<std::mutex> lock(_private->mutex);
    if (_private->fits(scalars, binding)) {
        if (_private->automaticRange) _private->range = rangeOf(scalars);
        _private->scalars = std::make_shared<const std::vector<float>>(std::move(scalars));
        _private->binding = binding;
        ++_private->scalarCount;
        return {};
    }
    const TetraSetPtr set = _private->tetraSet;
    lock.unlock(); // an error handler may ask for anything
    return reported(
        {ErrorCode::SIZE_MISMATCH,
         "VolumeGeometry \"" + getName() + "\": " + std::to_string(count) + " scalars for " +
             (binding == PER_VERTEX ? std::to_string(set->vertices.size()) + " vertices"
                                    : std::to_string(set->tetraCount()) + " tetrahedra")});
}

void VolumeGeometry::removeScalars()
{
    std::lock_guard<std::mutex> lock(_private->mutex);
    _private->scalars = nullptr;
    ++_private->scalarCount;
}

VolumeGeometry::ScalarField VolumeGeometry::getScalarField() const
{
    std::lock_guard<std::mutex> lock(_private->mutex);
    return {_private->scalars, _private->binding, _private->range, _private->scalarCount};
}

VolumeGeometry::ScalarsPtr VolumeGeometry::getScalars() const
{
    return getScalarField().values;
}

VolumeGeometry::ScalarBinding VolumeGeometry::getScalarBinding() const
{
    return getScalarField().binding;
}

ReportedStatus VolumeGeometry::setScalarRange(const osg::Vec2d& range)
{
    if (!(std::isfinite(range.x()) && std::isfinite(range.y()) && range.x() < range.y()))
        return reported({ErrorCode::VALUE_INVALID, "VolumeGeometry \"" + getName() +
                                                       "\": the scalar range is " +
                                                       core::formatNumber(range.x()) + " to " +
                                                       core::formatNumber(range.y())});
    std::lock_guard<std::mutex> lock(_private->mutex);
    _private->range = range;
    _private->automaticRange = false;
    ++_private->scalarCount;
    return {};
}

osg::Vec2d VolumeGeometry::getScalarRange() const
{
    return getScalarField().range;
}

bool VolumeGeometry::isScalarRangeAutomatic() const
{
    std::lock_guard<std::mutex> lock(_private->mutex);
    return _private->automaticRange;
}

unsigned VolumeGeometry::getScalarCount() const
{
    return _private->scalarCount;
}

void VolumeGeometry::accept(osg::NodeVisitor& visitor)
{
    if (!visitor.validNodeMask(*this) || keepsTransforms(*this, visitor)) return;
    visitor.pushOntoNodePath(this);
    osgUtil::CullVisitor* cullVisitor = visitor.asCullVisitor();
    Renderer* renderer = getRenderer();
    const osg::FrameStamp* stamp = visitor.getFrameStamp();
    if (cullVisitor && stamp) _private->shownTime = stamp->getSimulationTime();
    if (cullVisitor && renderer)
        renderer->cull(*this, *cullVisitor);
    else if (!cullVisitor)
        visitor.apply(static_cast<osg::Drawable&>(*this));
    Picker* picker = getPicker();
    if (osgUtil::IntersectionVisitor* picking = visitor.asIntersectionVisitor(); picking && picker)
        picker->intersect(*this, *picking,
                          stamp ? stamp->getSimulationTime() : _private->shownTime.load());
    visitor.popFromNodePath();
}

osg::BoundingBox VolumeGeometry::computeBoundingBox() const
{
    const core::Box3d box = getTetraSet()->bounds();
    if (box.empty()) return {};
    osg::BoundingBox result;
    for (int axis = 0; axis < 3; ++axis) {
        float low = roundDown(box.min[axis]), high = roundUp(box.max[axis]);
        // OSG takes the bounding sphere from this box, with a centre that is rounded as well: where
        // floats are coarse, make room for it.
        if (high - low < 16.0f * (std::nextafter(high, INFINITY) - high)) {
            low = std::nextafter(low, -INFINITY);
            high = std::nextafter(high, INFINITY);
        }
        result._min[axis] = low;
        result._max[axis] = high;
    }
    return result;
}

osg::BoundingSphere VolumeGeometry::computeBound() const
{
    // Where its sphere is asked for before its box, osg::Drawable takes the box for known, too; it
    // would stay empty, and never be culled.
    _boundingBox = _initialBoundingBox;
    _boundingBox.expandBy(_computeBoundingBoxCallback
                              ? _computeBoundingBoxCallback->computeBound(*this)
                              : computeBoundingBox());
    if (!_boundingBox.valid()) return {};
    const osg::Vec3 center = _boundingBox.center();
    // The centre is rounded to float as well: make room for it.
    const float slack = 2.0f * std::numeric_limits<float>::epsilon() * center.length();
    return {center, _boundingBox.radius() * (1.0f + 1e-6f) + slack};
}

void VolumeGeometry::drawImplementation(osg::RenderInfo&) const {}

ReportedStatus VolumeGeometry::setSlackAngle(double radians)
{
    if (!core::NOT_NEGATIVE.holds(radians))
        return reported({ErrorCode::VALUE_INVALID, "VolumeGeometry \"" + getName() +
                                                       "\": slack angle is " +
                                                       core::formatNumber(radians) + ", expected " +
                                                       core::NOT_NEGATIVE.expected});
    _private->slackAngle = radians;
    return {};
}

double VolumeGeometry::getSlackAngle() const
{
    return _private->slackAngle;
}

void VolumeGeometry::resizeGLObjectBuffers(unsigned int maximum)
{
    osg::Drawable::resizeGLObjectBuffers(maximum);
    _renderData.resizeGLObjectBuffers(maximum);
}

void VolumeGeometry::releaseGLObjects(osg::State* state) const
{
    osg::Drawable::releaseGLObjects(state);
    _renderData.releaseGLObjects(state);
}

} // namespace osgVolumizer
