#include "Codec.h"

namespace osgVolumizer {
namespace serializers {

void writeRecord(osgDB::OutputStream& os, const Record& record)
{
    if (os.isBinary())
        writeBinary(os, record);
    else
        writeText(os, record);
}

Status readRecord(osgDB::InputStream& is, Record& record)
{
    const Status status = is.isBinary() ? readBinary(is, record) : readText(is, record);
    if (!status.ok()) return status;
    int version = 0;
    const Status known = record.getInteger("Version", 1, 1000000000, version);
    if (known.ok() && version > Record::version)
        return Status(ErrorCode::NOT_SUPPORTED, "field Version is " + std::to_string(version) +
                                                    ", and this library reads no version after " +
                                                    std::to_string(Record::version));
    return known;
}

} // namespace serializers
} // namespace osgVolumizer
