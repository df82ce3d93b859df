#pragma once

#include "../../RenderData.h"

namespace osgVolumizer {

/// The one friend of the classes that keep something for picking: Voxels and VolumeGeometry.
struct PickDataAccess
{
    template <class Object>
    static RenderDataSlot& slot(const Object& object)
    {
        return object._pickData;
    }
};

namespace picking {

/// Nothing of it belongs to a context.
class PickData : public RenderData
{
public:
    void resizeGLObjectBuffers(unsigned int) override {}
    void releaseGLObjects(osg::State*) const override {}
};

/// What is kept with an object; made on the first call. Each class of objects has one class of
/// data. Thread safe.
template <class Data, class Object>
osg::ref_ptr<Data> pickData(const Object& object)
{
    const osg::ref_ptr<RenderData> data = PickDataAccess::slot(object).getOrCreate(
        []() -> osg::ref_ptr<RenderData> { return new Data; });
    return static_cast<Data*>(data.get());
}

} // namespace picking
} // namespace osgVolumizer
