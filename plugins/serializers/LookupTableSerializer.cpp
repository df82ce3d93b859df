#include "FileReference.h"
#include "RecordProperty.h"

#include <osgVolumizer/LookupTable.h>

namespace osgVolumizer {
namespace serializers {
namespace {

const char* const domainNames[] = {"RANGE_FRACTION", "DATA_VALUES"};

Status readFile(const Record& record, const osgDB::Options* options, LookupTable& table)
{
    std::string name;
    Status status = record.get("FileName", name);
    if (!status.ok()) return status;
    table.setFileName(name);
    const auto read = readLookupTable(name, options);
    if (!read.ok()) return read.status;
    table.setFilePath((*read)->getFilePath());
    return table.setPoints((*read)->getFunction()->points(), (*read)->getDomain());
}

Status applyFunction(Record& record, const osgDB::Options* options, LookupTable& table)
{
    if (record.has("FileName")) return readFile(record, options, table);
    int domain = 0;
    Status status = record.getChoice("Domain", domainNames, 2, domain);
    Field::Doubles values;
    if (status.ok()) status = record.take("Points", values);
    if (!status.ok()) return status;
    if (values.size() % 5 != 0)
        return Status(ErrorCode::SIZE_MISMATCH, "field Points has " +
                                                    std::to_string(values.size()) +
                                                    " values, no multiple of 5");
    LookupPoints points;
    for (std::size_t i = 0; i < values.size(); i += 5)
        points.push_back(
            {values[i], glm::dvec4(values[i + 1], values[i + 2], values[i + 3], values[i + 4])});
    return table.setPoints(std::move(points), static_cast<LookupTable::Domain>(domain));
}

void fillFunction(const LookupTable& table, Record& record, const osgDB::OutputStream& os)
{
    if (!table.getFileName().empty() && !isEmbedding(os)) {
        record.add("FileName", referenceFrom(os, table.getFileName(), table.getFilePath()));
        return;
    }
    Field::Doubles values;
    for (const core::TransferFunction::Point& p : table.getFunction()->points())
        values.insert(values.end(), {p.value, p.color.r, p.color.g, p.color.b, p.color.a});
    record.add("Domain", std::string(domainNames[table.getDomain()]));
    record.add("Points", std::move(values), 5);
}

} // namespace
} // namespace serializers
} // namespace osgVolumizer

using namespace osgVolumizer::serializers;

REGISTER_OBJECT_WRAPPER(osgVolumizer_LookupTable, new osgVolumizer::LookupTable,
                        osgVolumizer::LookupTable, "osg::Object osgVolumizer::LookupTable")
{
    addRecordProperty<MyClass, &applyFunction, &fillFunction>(*wrapper, "Function");
}
