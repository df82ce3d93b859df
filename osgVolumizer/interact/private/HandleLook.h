#pragma once

#include <osg/StateSet>
#include <osg/Uniform>
#include <osg/ref_ptr>

#include <vector>

namespace osgVolumizer {

/// What handles are drawn with: opaque, and faintly on top of all else. In the colours of
/// osgManipulator's draggers, which are those of materials, but without light; cut by no clip
/// plane.
class HandleLook
{
public:
    HandleLook();

    void setThroughOpacity(double opacity);
    double throughOpacity() const { return _throughOpacity; }
    void resizeGLObjectBuffers(unsigned int maximum);
    void releaseGLObjects(osg::State* state) const;
    /// What to cull with, one after the other.
    std::vector<osg::StateSet*> passes() const;

private:
    double _throughOpacity = 0.35;
    osg::ref_ptr<osg::Uniform> _opacity; // of _through
    osg::ref_ptr<osg::StateSet> _solid, _through;
};

} // namespace osgVolumizer
