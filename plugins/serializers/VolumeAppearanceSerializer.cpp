#include "Codec.h"
#include "Objects.h"
#include "Report.h"

#include <osgVolumizer/VolumeAppearance.h>

#include <osgDB/ObjectWrapper>

#include <cmath>
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

/// Finite numbers of at least `low`, or above it.
Status getNumbers(const Record& record, const char* name, std::size_t count, double low, bool above,
                  Field::Doubles& values)
{
    const Status status = record.get(name, count, values);
    for (std::size_t i = 0; i < count && status.ok(); ++i)
        if (!std::isfinite(values[i]) || values[i] < low || (above && values[i] == low))
            return Status(ErrorCode::VALUE_INVALID,
                          std::string("field ") + name + ", value " + std::to_string(i) + " is " +
                              std::to_string(values[i]),
                          std::int64_t(i));
    return status;
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
                const Status status = getNumbers(record, "SamplingPeriod", 3, 0.0, true, p);
                return status.ok() ? a.setSamplingPeriod(osg::Vec3d(p[0], p[1], p[2])) : status;
            }};
}

Property maximumSamples()
{
    return {"MaximumSamples",
            [](const VolumeAppearance& a) { return Field::Integers{a.getMaximumSamples()}; },
            [](const Record& record, VolumeAppearance& a) {
                int n = 0;
                const Status status =
                    record.getInteger("MaximumSamples", 1, std::numeric_limits<int>::max(), n);
                return status.ok() ? a.setMaximumSamples(n) : status;
            }};
}

Property opacityUnit()
{
    return {"OpacityUnit",
            [](const VolumeAppearance& a) { return Field::Doubles{a.getOpacityUnit()}; },
            [](const Record& record, VolumeAppearance& a) {
                Field::Doubles unit;
                const Status status = getNumbers(record, "OpacityUnit", 1, 0.0, false, unit);
                return status.ok() ? a.setOpacityUnit(unit[0]) : status;
            }};
}

const char* const techniqueNames[] = {"AUTOMATIC", "SLICES", "SLABS"};
const char* const interpolationNames[] = {"NEAREST", "LINEAR", "CUBIC"};
const char* const lookupNames[] = {"AUTOMATIC_LOOKUP", "AFTER_INTERPOLATION",
                                   "BEFORE_INTERPOLATION", "PREINTEGRATED"};
const char* const modeNames[] = {"VIEWPORT_ALIGNED", "AXIS_ALIGNED", "SPHERICAL"};
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
        maximumSamples(),
        opacityUnit(),
    };
    return list;
}

bool checkSampling(const VolumeAppearance&)
{
    return true;
}

// Each field by itself: one that is damaged keeps its default, and the first one is reported.
bool readSampling(osgDB::InputStream& is, VolumeAppearance& appearance)
{
    Record record;
    Status status = readRecord(is, record);
    int version = Record::version;
    if (status.ok()) status = record.getInteger("Version", 1, Record::version, version);
    if (status.ok())
        for (const Property& property : properties()) {
            if (property.since > version) continue;
            const Status set = property.set(record, appearance);
            if (status.ok()) status = set;
        }
    reportReadError(is, appearance, status);
    return true;
}

bool writeSampling(osgDB::OutputStream& os, const VolumeAppearance& appearance)
{
    Record record;
    record.add("Version", Field::Integers{Record::version});
    for (const Property& property : properties())
        record.add(property.name, property.get(appearance));
    writeRecord(os, record);
    return true;
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
    ADD_USER_SERIALIZER(Sampling);
    ADD_USER_SERIALIZER(Voxels);
    ADD_USER_SERIALIZER(LookupTable);
}
