#pragma once

#include <osg/State>

namespace osgVolumizer {
namespace render {

/// Puts an attribute back: the next leaf may share our state set, and then finds nothing to apply.
class AttributeScope
{
public:
    AttributeScope(osg::State& state, osg::StateAttribute::Type type)
        : _state(state), _type(type), _before(state.getLastAppliedAttribute(type))
    {
    }
    AttributeScope(const AttributeScope&) = delete;
    AttributeScope& operator=(const AttributeScope&) = delete;
    ~AttributeScope()
    {
        if (_before)
            _state.applyAttribute(_before);
        else
            _state.haveAppliedAttribute(_type);
    }

private:
    osg::State& _state;
    const osg::StateAttribute::Type _type;
    const osg::StateAttribute* const _before;
};

} // namespace render
} // namespace osgVolumizer
