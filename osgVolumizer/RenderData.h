#pragma once

#include "core/Export.h"

#include <osg/Referenced>
#include <osg/State>
#include <osg/ref_ptr>

#include <functional>
#include <mutex>

namespace osgVolumizer {

/// What the renderer keeps with an object of the scene, for as long as that lives. Every method may
/// be called from several threads.
class OSGVOLUMIZER_EXPORT RenderData : public osg::Referenced
{
public:
    virtual void resizeGLObjectBuffers(unsigned int maximum) = 0;
    virtual void releaseGLObjects(osg::State* state) const = 0;

protected:
    ~RenderData() override = default;
};

/// Where an object keeps its RenderData: a private member `_renderData` with RenderDataAccess as a
/// friend, which is the renderer's; likewise `_pickData`, which is for picking. The object knows
/// nothing of what is in it. Thread safe. A copy of the object has none of the original's.
class RenderDataSlot
{
public:
    RenderDataSlot() = default;
    RenderDataSlot(const RenderDataSlot&) = delete;
    RenderDataSlot& operator=(const RenderDataSlot&) = delete;

    /// Null until it is made.
    osg::ref_ptr<RenderData> get() const
    {
        std::lock_guard<std::mutex> lock(_mutex);
        return _data;
    }
    /// Calls `make` when there is none; one caller only does.
    osg::ref_ptr<RenderData> getOrCreate(const std::function<osg::ref_ptr<RenderData>()>& make)
    {
        std::lock_guard<std::mutex> lock(_mutex);
        if (!_data) _data = make();
        return _data;
    }
    /// Forgets it; whoever holds it keeps it.
    void clear()
    {
        osg::ref_ptr<RenderData> old; // goes without the lock
        std::lock_guard<std::mutex> lock(_mutex);
        old.swap(_data);
    }
    void resizeGLObjectBuffers(unsigned int maximum)
    {
        if (const osg::ref_ptr<RenderData> data = get()) data->resizeGLObjectBuffers(maximum);
    }
    void releaseGLObjects(osg::State* state) const
    {
        if (const osg::ref_ptr<RenderData> data = get()) data->releaseGLObjects(state);
    }

private:
    mutable std::mutex _mutex;
    osg::ref_ptr<RenderData> _data;
};

} // namespace osgVolumizer
