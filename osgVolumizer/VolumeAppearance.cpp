#include "VolumeAppearance.h"

#include "VolumeCut.h"
#include "core/NumberRule.h"
#include "core/Text.h"
#include "private/Copied.h"
#include "private/Flattening.h"
#include "private/Renderer.h"

#include <algorithm>
#include <cmath>

namespace osgVolumizer {

namespace {

ReportedStatus refuse(const VolumeAppearance& appearance, const char* field, double value,
                      const char* expected)
{
    return reported({ErrorCode::VALUE_INVALID,
                     "VolumeAppearance \"" + appearance.getName() + "\": " + field + " is " +
                         core::formatNumber(value) + ", expected " + expected});
}

} // namespace

VolumeAppearance::VolumeAppearance() : _lookupTable(new LookupTable) {}

VolumeAppearance::VolumeAppearance(const VolumeAppearance& o, const osg::CopyOp& op)
    : osg::Group(o, op), _voxels(copied(o._voxels, op)), _lookupTable(copied(o._lookupTable, op)),
      _cut(copied(o._cut, op)), _technique(o._technique), _interpolation(o._interpolation),
      _lookup(o._lookup), _exactFiltering(o._exactFiltering), _rayFunction(o._rayFunction),
      _isoValue(o._isoValue), _shading(o._shading), _material(o._material),
      _gradients(o._gradients), _combineRule(o._combineRule),
      _accumulationBits(o._accumulationBits), _sampling(o._sampling),
      _errorTolerance(o._errorTolerance), _targetFrameTime(o._targetFrameTime),
      _timeStep(o._timeStep), _timeRate(o._timeRate), _timeBlending(o._timeBlending),
      _opacityUnit(o._opacityUnit), _pickOpacity(o._pickOpacity)
{
}

VolumeAppearance::~VolumeAppearance() = default;

void VolumeAppearance::accept(osg::NodeVisitor& visitor)
{
    if (!visitor.validNodeMask(*this) || keepsTransforms(*this, visitor)) return;
    visitor.pushOntoNodePath(this);
    visitor.apply(*this);
    visitor.popFromNodePath();
}

void VolumeAppearance::setCut(VolumeCut* cut)
{
    _cut = cut;
}

void VolumeAppearance::setVoxels(Voxels* voxels)
{
    _voxels = voxels;
    requireOverlap();
}

void VolumeAppearance::setInterpolation(Interpolation interpolation)
{
    _interpolation = interpolation;
    requireOverlap();
}

void VolumeAppearance::setShading(bool shading)
{
    _shading = shading;
    requireOverlap();
}

// Where it is refused a frame says so: by then it may no longer be needed.
void VolumeAppearance::requireOverlap()
{
    if (_voxels) (void)_voxels->requireOverlap(getRequiredOverlap());
}

void VolumeAppearance::setLookupTable(LookupTable* table)
{
    _lookupTable = table ? table : new LookupTable;
}

int VolumeAppearance::getRequiredOverlap() const
{
    return 1 + (_interpolation == CUBIC ? 2 : 0) + (_shading ? 2 : 0);
}

ReportedStatus VolumeAppearance::setIsoValue(double dataValue)
{
    if (!core::FINITE.holds(dataValue))
        return refuse(*this, "iso-value", dataValue, core::FINITE.expected);
    _isoValue = dataValue;
    return {};
}

ReportedStatus VolumeAppearance::setMaterial(const Material& material)
{
    const struct
    {
        const char* name;
        double value;
        const core::NumberRule& rule;
    } values[] = {{"ambient coefficient", material.ambient, core::COEFFICIENT},
                  {"diffuse coefficient", material.diffuse, core::COEFFICIENT},
                  {"specular coefficient", material.specular, core::COEFFICIENT},
                  {"shininess", material.shininess, core::SHININESS}};
    for (const auto& v : values)
        if (!v.rule.holds(v.value)) return refuse(*this, v.name, v.value, v.rule.expected);
    _material = material;
    return {};
}

ReportedStatus VolumeAppearance::setAccumulationBits(int bits)
{
    if (bits != 8 && bits != 16 && bits != 32)
        return refuse(*this, "accumulation bits", bits, "8, 16 or 32");
    _accumulationBits = bits;
    return {};
}

ReportedStatus VolumeAppearance::setSamplingPeriod(const osg::Vec3d& periodVoxel)
{
    for (int i = 0; i < 3; ++i)
        if (!core::LENGTH.holds(periodVoxel[i]))
            return refuse(*this, "sampling period", periodVoxel[i], core::LENGTH.expected);
    _sampling.periodVoxel = {periodVoxel.x(), periodVoxel.y(), periodVoxel.z()};
    return {};
}

osg::Vec3d VolumeAppearance::getSamplingPeriod() const
{
    return {_sampling.periodVoxel.x, _sampling.periodVoxel.y, _sampling.periodVoxel.z};
}

ReportedStatus VolumeAppearance::setMaximumSamples(int count)
{
    if (count < 1) return refuse(*this, "maximum of samples", count, "at least 1");
    _sampling.maximumSamples = count;
    return {};
}

ReportedStatus VolumeAppearance::setErrorTolerance(double rootMeanSquare)
{
    if (!core::NOT_NEGATIVE.holds(rootMeanSquare))
        return refuse(*this, "error tolerance", rootMeanSquare, core::NOT_NEGATIVE.expected);
    _errorTolerance = rootMeanSquare;
    return {};
}

ReportedStatus VolumeAppearance::setTargetFrameTime(double seconds)
{
    if (!core::NOT_NEGATIVE.holds(seconds))
        return refuse(*this, "target frame time", seconds, core::NOT_NEGATIVE.expected);
    _targetFrameTime = seconds;
    return {};
}

ReportedStatus VolumeAppearance::setTimeStep(double step)
{
    if (!core::FINITE.holds(step)) return refuse(*this, "time step", step, core::FINITE.expected);
    _timeStep = step;
    return {};
}

ReportedStatus VolumeAppearance::setTimeRate(double stepsPerSecond)
{
    if (!core::FINITE.holds(stepsPerSecond))
        return refuse(*this, "time rate", stepsPerSecond, core::FINITE.expected);
    _timeRate = stepsPerSecond;
    return {};
}

double VolumeAppearance::getTimeStepAt(double simulationTime) const
{
    const int count = _voxels ? _voxels->getStepCount() : 1;
    const double last = count - 1.0;
    if (count == 1) return 0.0;
    if (_timeRate == 0.0) return std::clamp(_timeStep, 0.0, last);
    const double period = _timeBlending ? last : double(count);
    const double step = std::fmod(_timeStep + _timeRate * simulationTime, period);
    if (!std::isfinite(step)) return 0.0; // times beyond what a number can tell apart
    const double held = step < 0.0 ? step + period : step;
    return held < period ? held : 0.0;
}

ReportedStatus VolumeAppearance::setOpacityUnit(double objectUnits)
{
    if (!core::LENGTH_OR_NONE.holds(objectUnits))
        return refuse(*this, "opacity unit", objectUnits, core::LENGTH_OR_NONE.expected);
    _opacityUnit = objectUnits;
    return {};
}

ReportedStatus VolumeAppearance::setPickOpacity(double opacity)
{
    if (!core::PICK_OPACITY.holds(opacity))
        return refuse(*this, "pick opacity", opacity, core::PICK_OPACITY.expected);
    _pickOpacity = opacity;
    return {};
}

double VolumeAppearance::getEffectiveOpacityUnit() const
{
    if (_opacityUnit > 0.0) return _opacityUnit;
    return _voxels ? _voxels->getMeanSpacing() : 1.0;
}

VolumeAppearance::Settings
VolumeAppearance::getSettingsInForce(const VolumeGeometry& geometry) const
{
    Renderer* renderer = getRenderer();
    return renderer ? renderer->settingsInForce(*this, geometry) : Settings();
}

void VolumeAppearance::resizeGLObjectBuffers(unsigned int maximum)
{
    osg::Group::resizeGLObjectBuffers(maximum);
    if (_voxels) _voxels->resizeGLObjectBuffers(maximum);
    if (_cut) _cut->resizeGLObjectBuffers(maximum);
    _renderData.resizeGLObjectBuffers(maximum);
    if (Renderer* renderer = getRenderer()) renderer->resizeGLObjectBuffers(maximum);
}

void VolumeAppearance::releaseGLObjects(osg::State* state) const
{
    osg::Group::releaseGLObjects(state);
    if (_voxels) _voxels->releaseGLObjects(state);
    if (_cut) _cut->releaseGLObjects(state);
    _renderData.releaseGLObjects(state);
    if (Renderer* renderer = getRenderer()) renderer->releaseGLObjects(state);
}

} // namespace osgVolumizer
