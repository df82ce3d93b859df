#include "RecordProperty.h"

#include <osgVolumizer/VolumeGeometry.h>

namespace osgVolumizer {
namespace serializers {
namespace {

const char* const layoutNames[] = {"V3F",         "T3F_V3F",     "C3F_V3F", "C4F_V3F",
                                   "T3F_C3F_V3F", "T3F_C4F_V3F", "USER"};
const char* const bindingNames[] = {"PER_VERTEX", "PER_TETRAHEDRON"};

Status readFormat(const Record& record, core::VertexFormat& format)
{
    int layout = 0;
    Status status = record.getChoice("Layout", layoutNames, 7, layout);
    format = core::VertexFormat(static_cast<core::VertexLayout>(layout));
    if (!status.ok() || format.layout != core::VertexLayout::USER) return status;
    Field::Integers sizes;
    status = record.get("Sizes", 3, sizes);
    if (!status.ok()) return status;
    const bool voxel = sizes[0] == 0 || sizes[0] == 3;
    const bool color = sizes[1] == 0 || sizes[1] == 3 || sizes[1] == 4;
    const bool user = sizes[2] >= 0 && sizes[2] <= core::VertexFormat::MAX_USER_VALUES;
    for (int i = 0; i < 3; ++i)
        if (!(i == 0 ? voxel : i == 1 ? color : user))
            return Status(ErrorCode::VALUE_INVALID,
                          "field Sizes, value " + std::to_string(i) + " is " +
                              std::to_string(sizes[std::size_t(i)]),
                          i);
    format = core::VertexFormat::user(int(sizes[0]), int(sizes[1]), int(sizes[2]));
    return Status();
}

// Fields ScalarBinding and Scalars are there where the geometry has any, ScalarRange unless that is
// automatic. They came after version 7, which they did not change: to a reader that does not know
// them, the tetrahedra are what they were.
Status applyScalars(Record& record, VolumeGeometry& geometry)
{
    if (!record.has("Scalars")) {
        for (const char* name : {"ScalarBinding", "ScalarRange"})
            if (record.has(name))
                return Status(ErrorCode::FILE_UNREADABLE,
                              std::string("field Scalars is missing, but there is ") + name);
        return Status();
    }
    int binding = 0;
    Status status = record.getChoice("ScalarBinding", bindingNames, 2, binding);
    Field::Doubles values, range;
    if (status.ok()) status = record.take("Scalars", values);
    if (status.ok() && record.has("ScalarRange")) status = record.get("ScalarRange", 2, range);
    if (!status.ok()) return status;
    if (!range.empty()) {
        status = geometry.setScalarRange(osg::Vec2d(range[0], range[1]));
        if (!status.ok()) return status;
    }
    return geometry.setScalars(std::vector<float>(values.begin(), values.end()),
                               static_cast<VolumeGeometry::ScalarBinding>(binding));
}

void fillScalars(const VolumeGeometry& geometry, Record& record)
{
    const VolumeGeometry::ScalarsPtr scalars = geometry.getScalars();
    if (!scalars) return;
    record.add("ScalarBinding", std::string(bindingNames[geometry.getScalarBinding()]));
    record.add("Scalars", Field::Doubles(scalars->begin(), scalars->end()));
    if (geometry.isScalarRangeAutomatic()) return;
    const osg::Vec2d range = geometry.getScalarRange();
    record.add("ScalarRange", Field::Doubles{range.x(), range.y()});
}

Status applyTetraSet(Record& record, const osgDB::Options*, VolumeGeometry& geometry)
{
    core::VertexFormat format;
    Status status = readFormat(record, format);
    core::TetraSet set;
    set.vertices = core::VertexArray(format);
    if (status.ok()) status = record.take("Vertices", set.vertices.values());
    if (status.ok()) status = record.take("Tetrahedra", set.indices);
    if (!status.ok()) return status;
    const std::size_t values = set.vertices.values().size();
    if (values % std::size_t(format.stride()) != 0)
        return Status(ErrorCode::SIZE_MISMATCH, "field Vertices has " + std::to_string(values) +
                                                    " values, no multiple of the " +
                                                    std::to_string(format.stride()) +
                                                    " of a vertex");
    status = set.validate();
    Field::Doubles slackAngle{0.0}; // since version 4, and only where it is not 0
    if (status.ok() && record.has("SlackAngle")) status = record.get("SlackAngle", 1, slackAngle);
    if (status.ok()) status = geometry.setSlackAngle(slackAngle[0]);
    if (status.ok()) status = geometry.setTetraSet(std::move(set));
    if (status.ok() && record.has("FieldShader")) {
        std::string shader;
        status = record.get("FieldShader", shader);
        if (status.ok()) status = geometry.setFieldShader(shader);
    }
    return status.ok() ? applyScalars(record, geometry) : status;
}

void fillTetraSet(const VolumeGeometry& geometry, Record& record, const osgDB::OutputStream&)
{
    const VolumeGeometry::TetraSetPtr set = geometry.getTetraSet();
    const core::VertexFormat& format = set->vertices.format();
    record.add("Layout", std::string(layoutNames[static_cast<int>(format.layout)]));
    if (format.layout == core::VertexLayout::USER)
        record.add("Sizes",
                   Field::Integers{format.voxelCoordinateSize, format.colorSize, format.userSize});
    record.add("Vertices", set->vertices.values(), std::size_t(format.stride()));
    record.add("Tetrahedra", Field::Indices(set->indices), 4);
    if (geometry.getSlackAngle() != 0.0)
        record.add("SlackAngle", Field::Doubles{geometry.getSlackAngle()});
    if (!geometry.getFieldShader().empty()) record.add("FieldShader", geometry.getFieldShader());
    fillScalars(geometry, record);
}

} // namespace
} // namespace serializers
} // namespace osgVolumizer

using namespace osgVolumizer::serializers;

REGISTER_OBJECT_WRAPPER(osgVolumizer_VolumeGeometry, new osgVolumizer::VolumeGeometry,
                        osgVolumizer::VolumeGeometry,
                        "osg::Object osg::Node osg::Drawable osgVolumizer::VolumeGeometry")
{
    addRecordProperty<MyClass, &applyTetraSet, &fillTetraSet>(*wrapper, "TetraSet");
}
