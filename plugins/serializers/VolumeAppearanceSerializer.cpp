#include "Objects.h"
#include "RecordProperty.h"

#include <osgVolumizer/AppearanceProperties.h>
#include <osgVolumizer/VolumeCut.h>
#include <osgVolumizer/core/Text.h>

namespace osgVolumizer {
namespace serializers {
namespace {

using Property = AppearanceProperty;

Field::Value fieldOf(const Property& property, const VolumeAppearance& appearance)
{
    const Property::Values values = property.get(appearance);
    if (property.kind == Property::CHOICE)
        return std::string(property.choices[static_cast<std::size_t>(values[0])]);
    if (property.kind == Property::NUMBERS) return values;
    return Field::Integers{static_cast<std::int64_t>(values[0])};
}

Status getValues(const Record& record, const Property& property, Property::Values& values)
{
    if (property.kind == Property::NUMBERS)
        return record.get(property.name, property.count, values);
    if (property.kind == Property::CHOICE) {
        int index = 0;
        const Status status = record.getChoice(property.name, property.choices.data(),
                                               static_cast<int>(property.choices.size()), index);
        values = {double(index)};
        return status;
    }
    Field::Integers integers;
    const Status status = record.get(property.name, 1, integers);
    if (status.ok()) values = {static_cast<double>(integers[0])};
    return status;
}

Status setField(const Record& record, const Property& property, VolumeAppearance& appearance)
{
    Property::Values values;
    if (Status status = getValues(record, property, values); !status.ok()) return status;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const std::string expected = property.expected(i, values[i]);
        if (expected.empty()) continue;
        const std::string value = property.kind == Property::NUMBERS
                                      ? core::formatNumber(values[i])
                                      : std::to_string(static_cast<std::int64_t>(values[i]));
        return Status(ErrorCode::VALUE_INVALID,
                      std::string("field ") + property.name + ", value " + std::to_string(i) +
                          " is " + value + ", expected " + expected,
                      std::int64_t(i));
    }
    property.set(appearance, values);
    return Status();
}

// Of the object that is read: what follows in a binary file depends on it.
thread_local int versionOfSampling = Record::version;

// Each field by itself: one that is damaged keeps its default, and the first one is reported.
Status applySampling(Record& record, const osgDB::Options*, VolumeAppearance& appearance)
{
    int version = Record::version;
    Status status = record.getInteger("Version", 1, Record::version, version);
    versionOfSampling = version;
    if (!status.ok()) return status;
    for (const Property& property : appearanceProperties()) {
        if (property.since > version) continue;
        const Status set = setField(record, property, appearance);
        if (status.ok()) status = set;
    }
    return status;
}

void fillSampling(const VolumeAppearance& appearance, Record& record, const osgDB::OutputStream&)
{
    for (const Property& property : appearanceProperties())
        record.add(property.name, fieldOf(property, appearance));
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

bool checkCut(const VolumeAppearance& appearance)
{
    return appearance.getCut() != nullptr;
}

bool readCut(osgDB::InputStream& is, VolumeAppearance& appearance)
{
    appearance.setCut(readObject<VolumeCut>(is).get());
    return true;
}

bool writeCut(osgDB::OutputStream& os, const VolumeAppearance& appearance)
{
    writeObject(os, appearance.getCut());
    return true;
}

/// A property that binary files have from a version of the record before it on.
class SinceVersion : public osgDB::UserSerializer<VolumeAppearance>
{
public:
    SinceVersion(int version, const char* name, Checker checker, Reader reader, Writer writer)
        : UserSerializer(name, checker, reader, writer), _version(version)
    {
    }
    bool read(osgDB::InputStream& is, osg::Object& object) override
    {
        if (is.isBinary() && versionOfSampling < _version) return true;
        return UserSerializer::read(is, object);
    }

private:
    const int _version;
};

} // namespace
} // namespace serializers
} // namespace osgVolumizer

using namespace osgVolumizer::serializers;

REGISTER_OBJECT_WRAPPER(osgVolumizer_VolumeAppearance, new osgVolumizer::VolumeAppearance,
                        osgVolumizer::VolumeAppearance,
                        "osg::Object osg::Node osg::Group osgVolumizer::VolumeAppearance")
{
    addRecordProperty<MyClass, &applySampling, &fillSampling>(*wrapper, "Sampling");
    wrapper->addSerializer(new SinceVersion(7, "Cut", &checkCut, &readCut, &writeCut),
                           osgDB::BaseSerializer::RW_USER);
    ADD_USER_SERIALIZER(Voxels);
    ADD_USER_SERIALIZER(LookupTable);
}
