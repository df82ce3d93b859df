#include "Codec.h"
#include "Objects.h"
#include "Report.h"

#include <osgVolumizer/VolumeAppearance.h>

#include <osgDB/ObjectWrapper>

#include <cmath>

namespace osgVolumizer {
namespace serializers {
namespace {

const char* const techniqueNames[] = {"AUTOMATIC", "SLICES", "SLABS"};
const char* const interpolationNames[] = {"NEAREST", "LINEAR"};
const char* const modeNames[] = {"VIEWPORT_ALIGNED", "AXIS_ALIGNED", "SPHERICAL"};
const char* const spaceNames[] = {"VIEW_VOLUME", "OBJECT", "PRIMITIVE"};

// Finite numbers, above or not below zero.
Status getLengths(const Record& record, const std::string& name, std::size_t count, bool zero,
                  Field::Doubles& values)
{
    const Status status = record.get(name, count, values);
    if (!status.ok()) return status;
    for (std::size_t i = 0; i < count; ++i)
        if (!std::isfinite(values[i]) || values[i] < 0.0 || (values[i] == 0.0 && !zero))
            return Status(ErrorCode::VALUE_INVALID,
                          "field " + name + ", value " + std::to_string(i) + " is " +
                              std::to_string(values[i]),
                          std::int64_t(i));
    return Status();
}

// Each field by itself: one that is damaged keeps its default, and the first one is reported.
Status apply(const Record& record, VolumeAppearance& appearance)
{
    Status first;
    const auto keep = [&first](const Status& status) {
        if (first.ok()) first = status;
        return status.ok();
    };
    int index = 0;
    if (keep(record.getChoice("Technique", techniqueNames, 3, index)))
        appearance.setTechnique(static_cast<VolumeAppearance::Technique>(index));
    if (keep(record.getChoice("Interpolation", interpolationNames, 2, index)))
        appearance.setInterpolation(static_cast<VolumeAppearance::Interpolation>(index));
    if (keep(record.getChoice("SamplingMode", modeNames, 3, index)))
        appearance.setSamplingMode(static_cast<SamplingMode>(index));
    if (keep(record.getChoice("SamplingSpace", spaceNames, 3, index)))
        appearance.setSamplingSpace(static_cast<SamplingSpace>(index));
    Field::Doubles values;
    if (keep(getLengths(record, "SamplingPeriod", 3, false, values)))
        keep(appearance.setSamplingPeriod(osg::Vec3d(values[0], values[1], values[2])));
    if (keep(record.getInteger("MaximumSamples", 1, 2147483647, index)))
        keep(appearance.setMaximumSamples(index));
    if (keep(getLengths(record, "OpacityUnit", 1, true, values)))
        keep(appearance.setOpacityUnit(values[0]));
    return first;
}

bool checkSampling(const VolumeAppearance&)
{
    return true;
}

bool readSampling(osgDB::InputStream& is, VolumeAppearance& appearance)
{
    Record record;
    Status status = readRecord(is, record);
    if (status.ok()) status = apply(record, appearance);
    reportReadError(is, appearance, status);
    return true;
}

bool writeSampling(osgDB::OutputStream& os, const VolumeAppearance& appearance)
{
    const auto name = [](const char* const* names, int index) { return std::string(names[index]); };
    const osg::Vec3d period = appearance.getSamplingPeriod();
    Record record;
    record.add("Version", Field::Integers{Record::version});
    record.add("Technique", name(techniqueNames, appearance.getTechnique()));
    record.add("Interpolation", name(interpolationNames, appearance.getInterpolation()));
    record.add("SamplingMode", name(modeNames, static_cast<int>(appearance.getSamplingMode())));
    record.add("SamplingSpace", name(spaceNames, static_cast<int>(appearance.getSamplingSpace())));
    record.add("SamplingPeriod", Field::Doubles{period.x(), period.y(), period.z()});
    record.add("MaximumSamples", Field::Integers{appearance.getMaximumSamples()});
    record.add("OpacityUnit", Field::Doubles{appearance.getOpacityUnit()});
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
