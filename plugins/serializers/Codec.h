#pragma once

#include "Record.h"

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

namespace osgVolumizer {
namespace serializers {

/// Writes a record where a property's value is due: readable text for .osgt and .osgx (numbers that
/// read back as the same bits; samples in base64), native binary for .osgb.
void writeRecord(osgDB::OutputStream& os, const Record& record);

/// Reads what writeRecord() wrote, whatever comes: no more memory than the file has bytes for
/// (times a small constant), no endless loop. A failure leaves the stream behind the record
/// wherever its end can still be found, so that the rest of the scene is read. The status has the
/// field and the value; whoever knows the object adds its name.
Status readRecord(osgDB::InputStream& is, Record& record);

void writeText(osgDB::OutputStream& os, const Record& record);
Status readText(osgDB::InputStream& is, Record& record);
void writeBinary(osgDB::OutputStream& os, const Record& record);
Status readBinary(osgDB::InputStream& is, Record& record);

} // namespace serializers
} // namespace osgVolumizer
