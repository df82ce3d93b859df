#include "Objects.h"
#include "RecordProperty.h"

#include <osgVolumizer/VolumeSlice.h>

namespace osgVolumizer {
namespace serializers {
namespace {

const char* const interpolationNames[] = {"NEAREST", "LINEAR", "CUBIC"};

Status applyShape(const Record& record, VolumeSlice& slice)
{
    int shape = 0, unit = -1;
    Status status = record.getChoice("Shape", VolumeSlice::SHAPE_NAMES, 4, shape);
    if (!status.ok()) return status;
    if (shape == VolumeSlice::PLANE) {
        Field::Doubles p;
        status = record.get("Plane", 4, p);
        return status.ok() ? slice.setPlane(osg::Vec4d(p[0], p[1], p[2], p[3])) : status;
    }
    if (shape == VolumeSlice::POLYGON) {
        const Field* field = record.find("Polygon");
        const auto* values = field ? std::get_if<Field::Doubles>(&field->value) : nullptr;
        if (!values || values->size() % 3 != 0)
            return Status(ErrorCode::SIZE_MISMATCH, "field Polygon has no triples of numbers");
        std::vector<osg::Vec3d> corners;
        for (std::size_t i = 0; i < values->size(); i += 3)
            corners.emplace_back((*values)[i], (*values)[i + 1], (*values)[i + 2]);
        return slice.setPolygon(corners);
    }
    if (shape != VolumeSlice::GEOMETRY) return Status();
    status = record.getInteger("PlaceUnit", -1, 31, unit);
    const osg::ref_ptr<osg::Geometry> geometry = slice.getGeometry(); // was read before
    return status.ok() ? slice.setGeometry(geometry, unit) : status;
}

// Each field by itself: one that is damaged keeps its default, and the first one is reported.
Status applySlice(Record& record, const osgDB::Options*, VolumeSlice& slice)
{
    Status first = applyShape(record, slice);
    const auto note = [&first](const Status& status) {
        if (first.ok()) first = status;
        return status.ok();
    };
    Field::Doubles n;
    int choice = 0;
    if (note(record.get("Thickness", 1, n))) note(slice.setThickness(n[0]));
    if (note(record.get("SamplingPeriod", 1, n))) note(slice.setSamplingPeriod(n[0]));
    if (note(record.get("Opacity", 1, n))) note(slice.setOpacity(n[0]));
    if (record.has("Window") && note(record.get("Window", 2, n))) note(slice.setWindow(n[0], n[1]));
    if (note(record.getChoice("Reduction", VolumeSlice::REDUCTION_NAMES, 3, choice)))
        slice.setReduction(static_cast<VolumeSlice::Reduction>(choice));
    if (note(record.getChoice("Interpolation", interpolationNames, 3, choice)))
        slice.setInterpolation(static_cast<VolumeAppearance::Interpolation>(choice));
    if (note(record.getInteger("ExactFiltering", 0, 1, choice)))
        slice.setExactFiltering(choice != 0);
    if (record.has("FollowsCut") && note(record.getInteger("FollowsCut", 0, 1, choice)))
        slice.setFollowsCut(choice != 0);
    if (note(record.getInteger("UsesTableOpacity", 0, 1, choice)))
        slice.setUsesTableOpacity(choice != 0);
    return first;
}

void fillSlice(const VolumeSlice& slice, Record& record, const osgDB::OutputStream&)
{
    record.add("Shape", std::string(VolumeSlice::SHAPE_NAMES[slice.getShape()]));
    const osg::Vec4d plane = slice.getPlane();
    if (slice.getShape() == VolumeSlice::PLANE)
        record.add("Plane", Field::Doubles{plane.x(), plane.y(), plane.z(), plane.w()});
    Field::Doubles corners;
    for (const osg::Vec3d& corner : slice.getPolygon())
        corners.insert(corners.end(), {corner.x(), corner.y(), corner.z()});
    if (slice.getShape() == VolumeSlice::POLYGON) record.add("Polygon", corners, 3);
    if (slice.getShape() == VolumeSlice::GEOMETRY)
        record.add("PlaceUnit", Field::Integers{slice.getPlaceUnit()});
    record.add("Thickness", Field::Doubles{slice.getThickness()});
    record.add("SamplingPeriod", Field::Doubles{slice.getSamplingPeriod()});
    record.add("Opacity", Field::Doubles{slice.getOpacity()});
    if (const auto window = slice.getWindow())
        record.add("Window", Field::Doubles{window->x(), window->y()});
    record.add("Reduction", std::string(VolumeSlice::REDUCTION_NAMES[slice.getReduction()]));
    record.add("Interpolation", std::string(interpolationNames[slice.getInterpolation()]));
    record.add("ExactFiltering", Field::Integers{slice.getExactFiltering()});
    record.add("FollowsCut", Field::Integers{slice.getFollowsCut()});
    record.add("UsesTableOpacity", Field::Integers{slice.getUsesTableOpacity()});
}

bool checkGeometry(const VolumeSlice& slice)
{
    return slice.getGeometry() != nullptr;
}

bool readGeometry(osgDB::InputStream& is, VolumeSlice& slice)
{
    // What is wrong with it is reported with the shape.
    const CallerReports later;
    (void)slice.setGeometry(readObject<osg::Geometry>(is).get());
    return true;
}

bool writeGeometry(osgDB::OutputStream& os, const VolumeSlice& slice)
{
    writeObject(os, slice.getGeometry());
    return true;
}

bool checkRegion(const VolumeSlice& slice)
{
    return slice.getRegion() != nullptr;
}

bool readRegion(osgDB::InputStream& is, VolumeSlice& slice)
{
    slice.setRegion(readObject<VolumeGeometry>(is).get());
    return true;
}

bool writeRegion(osgDB::OutputStream& os, const VolumeSlice& slice)
{
    writeObject(os, slice.getRegion());
    return true;
}

bool checkLookupTable(const VolumeSlice& slice)
{
    return slice.getLookupTable() != nullptr;
}

bool readLookupTable(osgDB::InputStream& is, VolumeSlice& slice)
{
    slice.setLookupTable(readObject<LookupTable>(is).get());
    return true;
}

bool writeLookupTable(osgDB::OutputStream& os, const VolumeSlice& slice)
{
    writeObject(os, slice.getLookupTable());
    return true;
}

} // namespace
} // namespace serializers
} // namespace osgVolumizer

using namespace osgVolumizer::serializers;

REGISTER_OBJECT_WRAPPER(osgVolumizer_VolumeSlice, new osgVolumizer::VolumeSlice,
                        osgVolumizer::VolumeSlice,
                        "osg::Object osg::Node osg::Drawable osgVolumizer::VolumeSlice")
{
    ADD_USER_SERIALIZER(Geometry); // before the shape
    addRecordProperty<MyClass, &applySlice, &fillSlice>(*wrapper, "Slice");
    ADD_USER_SERIALIZER(Region);
    ADD_USER_SERIALIZER(LookupTable);
}
