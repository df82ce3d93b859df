#pragma once

#include <osg/UserDataContainer>

namespace osgVolumizer {
namespace render {

/// The first of an object's user objects that is a T; null where there is none. Costs next to
/// nothing for objects without user data.
template <class T>
const T* userObject(const osg::Object* object)
{
    const osg::UserDataContainer* data = object ? object->getUserDataContainer() : nullptr;
    const unsigned count = data ? data->getNumUserObjects() : 0;
    for (unsigned i = 0; i < count; ++i)
        if (const auto* found = dynamic_cast<const T*>(data->getUserObject(i))) return found;
    return nullptr;
}

} // namespace render
} // namespace osgVolumizer
