#pragma once

#include "Allocation.h"
#include "ContextLimits.h"
#include "March.h"
#include "UserObject.h"

#include <osg/GraphicsContext>
#include <osg/State>

#include <functional>

namespace osgVolumizer {
namespace render {

/// What tests make of one graphics context: a user object of it.
class ContextHooks : public osg::Object
{
public:
    /// What the card refuses, besides what it refuses anyhow. Called in the draw thread.
    std::function<bool(const AllocationRequest&)> refuses;
    /// Called with what the context can do, each time that it is asked; the change is believed.
    std::function<void(ContextLimits&)> changeLimits;
    /// Called with what was measured of marches.
    std::function<void(MarchTimes&)> changeMarchTimes;
    /// Code that compute shaders begin with, after the version.
    std::string computeHeader;

    ContextHooks() = default;
    ContextHooks(const ContextHooks& o, const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY)
        : osg::Object(o, op), refuses(o.refuses), changeLimits(o.changeLimits),
          changeMarchTimes(o.changeMarchTimes), computeHeader(o.computeHeader)
    {
    }
    META_Object(osgVolumizer, ContextHooks);

    /// Null in all contexts that no test has changed.
    static const ContextHooks* of(const osg::State& state)
    {
        return userObject<ContextHooks>(state.getGraphicsContext());
    }
};

} // namespace render
} // namespace osgVolumizer
