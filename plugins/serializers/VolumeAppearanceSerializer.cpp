#include "Objects.h"
#include "RecordProperty.h"

#include <osgVolumizer/VolumeAppearance.h>
#include <osgVolumizer/core/NumberRule.h>
#include <osgVolumizer/core/Text.h>

#include <functional>
#include <limits>

namespace osgVolumizer {
namespace serializers {
namespace {

/// One field of the record: how it is got from an appearance, and set from a record.
struct Property
{
    const char* name;
    std::function<Field::Value(const VolumeAppearance&)> get;
    std::function<Status(const Record&, VolumeAppearance&)> set;
    int since = 1; ///< version of the format that has it first; older files keep the default
};

Property sinceVersion(int version, Property property)
{
    property.since = version;
    return property;
}

/// An enumeration whose values are 0, 1... by their names.
template <auto Get, auto Set, int Count>
Property choice(const char* name, const char* const (&names)[Count])
{
    using Enum = std::decay_t<std::invoke_result_t<decltype(Get), const VolumeAppearance&>>;
    return {name,
            [&names](const VolumeAppearance& a) {
                return std::string(names[static_cast<int>((a.*Get)())]);
            },
            [name, &names](const Record& record, VolumeAppearance& a) {
                int index = 0;
                const Status status = record.getChoice(name, names, Count, index);
                if (status.ok()) (a.*Set)(static_cast<Enum>(index));
                return status;
            }};
}

template <auto Get, auto Set>
Property flag(const char* name)
{
    return {name, [](const VolumeAppearance& a) { return Field::Integers{(a.*Get)()}; },
            [name](const Record& record, VolumeAppearance& a) {
                int value = 0;
                const Status status = record.getInteger(name, 0, 1, value);
                if (status.ok()) (a.*Set)(value == 1);
                return status;
            }};
}

/// A value of a field as a rule wants it; setters would say less of where it is.
Status checkNumber(const char* name, std::size_t index, double value, const core::NumberRule& rule)
{
    if (rule.holds(value)) return Status();
    return Status(ErrorCode::VALUE_INVALID,
                  std::string("field ") + name + ", value " + std::to_string(index) + " is " +
                      core::formatNumber(value) + ", expected " + rule.expected,
                  std::int64_t(index));
}

Status getNumbers(const Record& record, const char* name, std::size_t count,
                  const core::NumberRule& rule, Field::Doubles& values)
{
    Status status = record.get(name, count, values);
    for (std::size_t i = 0; i < count && status.ok(); ++i)
        status = checkNumber(name, i, values[i], rule);
    return status;
}

template <auto Get, auto Set>
Property number(const char* name, const core::NumberRule& rule)
{
    return {name, [](const VolumeAppearance& a) { return Field::Doubles{(a.*Get)()}; },
            [name, &rule](const Record& record, VolumeAppearance& a) {
                Field::Doubles value;
                const Status status = getNumbers(record, name, 1, rule, value);
                return status.ok() ? (a.*Set)(value[0]) : status;
            }};
}

template <auto Get, auto Set>
Property integer(const char* name)
{
    return {name, [](const VolumeAppearance& a) { return Field::Integers{(a.*Get)()}; },
            [name](const Record& record, VolumeAppearance& a) {
                int value = 0;
                const Status status =
                    record.getInteger(name, 1, std::numeric_limits<int>::max(), value);
                return status.ok() ? (a.*Set)(value) : status;
            }};
}

Property samplingPeriod()
{
    return {"SamplingPeriod",
            [](const VolumeAppearance& a) {
                const osg::Vec3d p = a.getSamplingPeriod();
                return Field::Doubles{p.x(), p.y(), p.z()};
            },
            [](const Record& record, VolumeAppearance& a) {
                Field::Doubles p;
                const Status status = getNumbers(record, "SamplingPeriod", 3, core::LENGTH, p);
                return status.ok() ? a.setSamplingPeriod(osg::Vec3d(p[0], p[1], p[2])) : status;
            }};
}

Property material()
{
    return {"Material",
            [](const VolumeAppearance& a) {
                const VolumeAppearance::Material& m = a.getMaterial();
                return Field::Doubles{m.ambient, m.diffuse, m.specular, m.shininess};
            },
            [](const Record& record, VolumeAppearance& a) {
                Field::Doubles m;
                Status status = record.get("Material", 4, m);
                for (std::size_t i = 0; i < 4 && status.ok(); ++i)
                    status = checkNumber("Material", i, m[i],
                                         i < 3 ? core::COEFFICIENT : core::SHININESS);
                return status.ok() ? a.setMaterial({m[0], m[1], m[2], m[3]}) : status;
            }};
}

Property accumulationBits()
{
    return {"AccumulationBits",
            [](const VolumeAppearance& a) { return Field::Integers{a.getAccumulationBits()}; },
            [](const Record& record, VolumeAppearance& a) -> Status {
                Field::Integers bits;
                const Status status = record.get("AccumulationBits", 1, bits);
                if (!status.ok()) return status;
                if (bits[0] == 8 || bits[0] == 16 || bits[0] == 32)
                    return a.setAccumulationBits(static_cast<int>(bits[0]));
                return Status(ErrorCode::VALUE_INVALID, "field AccumulationBits is " +
                                                            std::to_string(bits[0]) +
                                                            ", expected 8, 16 or 32");
            }};
}

const char* const techniqueNames[] = {"AUTOMATIC", "SLICES", "SLABS"};
const char* const interpolationNames[] = {"NEAREST", "LINEAR", "CUBIC"};
const char* const lookupNames[] = {"AUTOMATIC_LOOKUP", "AFTER_INTERPOLATION",
                                   "BEFORE_INTERPOLATION", "PREINTEGRATED"};
const char* const modeNames[] = {"VIEWPORT_ALIGNED", "AXIS_ALIGNED", "SPHERICAL"};
const char* const ruleNames[] = {"ABSORB", "PAINT"};
const char* const gradientNames[] = {"ON_THE_FLY", "PRECOMPUTED"};
const char* const spaceNames[] = {"VIEW_VOLUME", "OBJECT", "PRIMITIVE"};

const std::vector<Property>& properties()
{
    using A = VolumeAppearance;
    static const std::vector<Property> list{
        choice<&A::getTechnique, &A::setTechnique>("Technique", techniqueNames),
        choice<&A::getInterpolation, &A::setInterpolation>("Interpolation", interpolationNames),
        sinceVersion(2, choice<&A::getLookup, &A::setLookup>("Lookup", lookupNames)),
        sinceVersion(2, flag<&A::getExactFiltering, &A::setExactFiltering>("ExactFiltering")),
        choice<&A::getSamplingMode, &A::setSamplingMode>("SamplingMode", modeNames),
        choice<&A::getSamplingSpace, &A::setSamplingSpace>("SamplingSpace", spaceNames),
        samplingPeriod(),
        integer<&A::getMaximumSamples, &A::setMaximumSamples>("MaximumSamples"),
        number<&A::getOpacityUnit, &A::setOpacityUnit>("OpacityUnit", core::LENGTH_OR_NONE),
        sinceVersion(3, choice<&A::getRayFunction, &A::setRayFunction>("RayFunction",
                                                                       A::RAY_FUNCTION_NAMES)),
        sinceVersion(3, number<&A::getIsoValue, &A::setIsoValue>("IsoValue", core::FINITE)),
        sinceVersion(3, flag<&A::getShading, &A::setShading>("Shading")),
        sinceVersion(3, material()),
        sinceVersion(3, choice<&A::getGradients, &A::setGradients>("Gradients", gradientNames)),
        sinceVersion(3, accumulationBits()),
        sinceVersion(4, choice<&A::getCombineRule, &A::setCombineRule>("CombineRule", ruleNames)),
        sinceVersion(3, number<&A::getErrorTolerance, &A::setErrorTolerance>("ErrorTolerance",
                                                                             core::NOT_NEGATIVE)),
        sinceVersion(3, number<&A::getTargetFrameTime, &A::setTargetFrameTime>("TargetFrameTime",
                                                                               core::NOT_NEGATIVE)),
    };
    return list;
}

// Each field by itself: one that is damaged keeps its default, and the first one is reported.
Status applySampling(Record& record, const osgDB::Options*, VolumeAppearance& appearance)
{
    int version = Record::version;
    Status status = record.getInteger("Version", 1, Record::version, version);
    if (!status.ok()) return status;
    for (const Property& property : properties()) {
        if (property.since > version) continue;
        const Status set = property.set(record, appearance);
        if (status.ok()) status = set;
    }
    return status;
}

void fillSampling(const VolumeAppearance& appearance, Record& record)
{
    for (const Property& property : properties())
        record.add(property.name, property.get(appearance));
}

bool checkVoxels(const VolumeAppearance& appearance)
{
    return appearance.getVoxels() != nullptr;
}

bool readVoxels(osgDB::InputStream& is, VolumeAppearance& appearance)
{
    appearance.setVoxels(readObject<Voxels>(is).get());
    return true;
}

bool writeVoxels(osgDB::OutputStream& os, const VolumeAppearance& appearance)
{
    writeObject(os, appearance.getVoxels());
    return true;
}

bool checkLookupTable(const VolumeAppearance&)
{
    return true;
}

bool readLookupTable(osgDB::InputStream& is, VolumeAppearance& appearance)
{
    appearance.setLookupTable(readObject<LookupTable>(is).get());
    return true;
}

bool writeLookupTable(osgDB::OutputStream& os, const VolumeAppearance& appearance)
{
    writeObject(os, appearance.getLookupTable());
    return true;
}

} // namespace
} // namespace serializers
} // namespace osgVolumizer

using namespace osgVolumizer::serializers;

REGISTER_OBJECT_WRAPPER(osgVolumizer_VolumeAppearance, new osgVolumizer::VolumeAppearance,
                        osgVolumizer::VolumeAppearance,
                        "osg::Object osg::Node osg::Group osgVolumizer::VolumeAppearance")
{
    addRecordProperty<MyClass, &applySampling, &fillSampling>(*wrapper, "Sampling");
    ADD_USER_SERIALIZER(Voxels);
    ADD_USER_SERIALIZER(LookupTable);
}
