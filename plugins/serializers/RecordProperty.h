#pragma once

#include "Codec.h"
#include "Report.h"

#include <osgVolumizer/Error.h>

#include <osgDB/ObjectWrapper>
#include <osgDB/Serializer>

namespace osgVolumizer {
namespace serializers {

template <class T>
bool always(const T&)
{
    return true;
}

/// Registers a property of T whose value is one record.
/// \tparam Apply Status(Record&, const osgDB::Options*, T&): sets the object from a record, and
/// says what is wrong with it \tparam Fill void(const T&, Record&, const osgDB::OutputStream&):
/// adds the object's fields; the version is there already \tparam Has bool(const T&): whether the
/// object has the property at all
template <class T, auto Apply, auto Fill, auto Has = &always<T>>
void addRecordProperty(osgDB::ObjectWrapper& wrapper, const char* name)
{
    const auto read = [](osgDB::InputStream& is, T& object) {
        const CallerReports withName;
        Record record;
        Status status = readRecord(is, record);
        if (status.ok()) status = Apply(record, is.getOptions(), object);
        reportReadError(is, object, status);
        return true; // the rest of the scene is read all the same
    };
    const auto write = [](osgDB::OutputStream& os, const T& object) {
        Record record;
        record.add("Version", Field::Integers{Record::version});
        Fill(object, record, os);
        writeRecord(os, record);
        return true;
    };
    wrapper.addSerializer(new osgDB::UserSerializer<T>(name, Has, read, write),
                          osgDB::BaseSerializer::RW_USER);
}

} // namespace serializers
} // namespace osgVolumizer
