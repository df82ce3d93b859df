#include "RecordProperty.h"

#include <osgVolumizer/VoxelSource.h>

#include <cstring>

namespace osgVolumizer {
namespace serializers {
namespace {

Status readDescription(const Record& record, VoxelSource::Description& d)
{
    Field::Integers size;
    Status status = record.get("Size", 3, size);
    for (int i = 0; i < 3 && status.ok(); ++i) {
        const std::int64_t n = size[std::size_t(i)];
        if (n < 1 || n > 2147483647)
            status =
                Status(ErrorCode::VALUE_INVALID,
                       "field Size, value " + std::to_string(i) + " is " + std::to_string(n), i);
        d.size[i] = int(n);
    }
    if (status.ok()) status = record.getInteger("Components", 1, 4, d.components);
    std::string name;
    if (status.ok()) status = record.get("Type", name);
    if (!status.ok()) return status;
    const Result<VoxelType> type = voxelTypeFromName(name);
    if (!type.ok())
        return Status(type.status.code,
                      "field Type is '" + name.substr(0, 40) + "', no voxel type");
    d.type = *type;
    Field::Doubles values;
    status = record.get("Spacing", 3, values);
    if (!status.ok()) return status;
    d.spacing = glm::dvec3(values[0], values[1], values[2]);
    status = record.get("Origin", 3, values);
    if (!status.ok()) return status;
    d.origin = glm::dvec3(values[0], values[1], values[2]);
    return d.validate();
}

Status applyData(Record& record, const osgDB::Options*, MemoryVoxelSource& source)
{
    VoxelSource::Description description;
    Status status = readDescription(record, description);
    Bytes bytes;
    if (status.ok()) status = record.take("Voxels", bytes);
    if (!status.ok()) return status;
    // In floating point: sizes are not yet known to fit.
    const double expected = double(description.size.x) * double(description.size.y) *
                            double(description.size.z) * description.components *
                            double(voxelTypeSize(description.type));
    if (double(bytes.data.size()) != expected ||
        bytes.elementSize != voxelTypeSize(description.type))
        return Status(ErrorCode::SIZE_MISMATCH,
                      "field Voxels has " + std::to_string(bytes.data.size()) +
                          " bytes, which is not what fields Size, Type and Components ask for");
    // The source uses the memory that was read to, and keeps it.
    const auto data = std::make_shared<std::vector<unsigned char>>(std::move(bytes.data));
    return source.setExternal(description, data->data(), [data] {});
}

bool hasData(const MemoryVoxelSource& source)
{
    return source.data() != nullptr;
}

void fillData(const MemoryVoxelSource& source, Record& record, const osgDB::OutputStream&)
{
    const VoxelSource::Description d = source.describe();
    Bytes bytes;
    bytes.elementSize = unsigned(voxelTypeSize(d.type));
    bytes.data.resize(source.sizeInBytes());
    std::memcpy(bytes.data.data(), source.data(), bytes.data.size());
    record.add("Size", Field::Integers{d.size.x, d.size.y, d.size.z});
    record.add("Components", Field::Integers{d.components});
    record.add("Type", std::string(voxelTypeName(d.type)));
    record.add("Spacing", Field::Doubles{d.spacing.x, d.spacing.y, d.spacing.z});
    record.add("Origin", Field::Doubles{d.origin.x, d.origin.y, d.origin.z});
    record.add("Voxels", std::move(bytes));
}

} // namespace
} // namespace serializers
} // namespace osgVolumizer

using namespace osgVolumizer::serializers;

REGISTER_OBJECT_WRAPPER(osgVolumizer_MemoryVoxelSource, new osgVolumizer::MemoryVoxelSource,
                        osgVolumizer::MemoryVoxelSource,
                        "osg::Object osgVolumizer::MemoryVoxelSource")
{
    addRecordProperty<MyClass, &applyData, &fillData, &hasData>(*wrapper, "Data");
}
