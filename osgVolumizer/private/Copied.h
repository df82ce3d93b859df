#pragma once

#include <osg/CopyOp>
#include <osg/Object>
#include <osg/ref_ptr>

namespace osgVolumizer {

/// The same object, or with DEEP_COPY_OBJECTS one of its own.
template <class T>
osg::ref_ptr<T> copied(const osg::ref_ptr<T>& object, const osg::CopyOp& op)
{
    return dynamic_cast<T*>(op(static_cast<const osg::Object*>(object.get())));
}

} // namespace osgVolumizer
