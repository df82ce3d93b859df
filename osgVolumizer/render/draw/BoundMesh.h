#pragma once

#include "../context/ContextResources.h"
#include "../context/ProgramInterface.h"
#include "VolumeMesh.h"

namespace osgVolumizer {
namespace render {

/// A mesh bound for drawing, straight from our stream buffers: attributes are left disabled again
/// for OSG. Call in the draw thread.
class BoundMesh
{
public:
    /// \param spacing thickness of slices that have none of their own
    BoundMesh(osg::State& state, ContextResources& resources, const VolumeMesh& mesh,
              float spacing);
    BoundMesh(const BoundMesh&) = delete;
    BoundMesh& operator=(const BoundMesh&) = delete;
    ~BoundMesh();

private:
    void enable(unsigned attribute, int size, int offset, int stride);

    osg::State& _state;
    osg::GLExtensions& _gl;
    bool _enabled[ATTRIBUTE_COUNT] = {};
};

} // namespace render
} // namespace osgVolumizer
