#pragma once

#include <osgDB/InputStream>
#include <osgDB/OutputStream>

namespace osgVolumizer {
namespace serializers {

/// Writes an object as a property's value; one that is shared is written once.
inline void writeObject(osgDB::OutputStream& os, const osg::Object* object)
{
    os << os.BEGIN_BRACKET << std::endl;
    os.writeObject(object);
    os << os.END_BRACKET << std::endl;
}

/// Reads what writeObject() wrote; null where it is of another class.
template <class T>
osg::ref_ptr<T> readObject(osgDB::InputStream& is)
{
    is >> is.BEGIN_BRACKET;
    osg::ref_ptr<T> object = is.readObjectOfType<T>();
    is >> is.END_BRACKET;
    return object;
}

} // namespace serializers
} // namespace osgVolumizer
