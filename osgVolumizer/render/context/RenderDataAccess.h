#pragma once

#include "../../RenderData.h"

namespace osgVolumizer {

/// The one friend of the classes that have a RenderDataSlot.
struct RenderDataAccess
{
    template <class Object>
    static RenderDataSlot& slot(const Object& object)
    {
        return object._renderData;
    }
};

namespace render {

/// What is kept with an object (Voxels, LookupTable, VolumeGeometry, VolumeAppearance); made on the
/// first call. Each class of objects has one class of data. Thread safe.
template <class Data, class Object>
osg::ref_ptr<Data> renderData(const Object& object)
{
    const osg::ref_ptr<RenderData> data = RenderDataAccess::slot(object).getOrCreate(
        []() -> osg::ref_ptr<RenderData> { return new Data; });
    return static_cast<Data*>(data.get());
}

} // namespace render
} // namespace osgVolumizer
