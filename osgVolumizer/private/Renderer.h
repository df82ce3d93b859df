#pragma once

#include "../VolumeAppearance.h"

namespace osgUtil {
class CullVisitor;
}

namespace osgVolumizer {

class VolumeGeometry;
class VolumeSlice;

/// What the nodes ask of whatever draws them, so that they need not know it. Every method may be
/// called from several threads.
class Renderer
{
public:
    virtual ~Renderer() = default;

    /// What VolumeGeometry does under a cull visitor.
    virtual void cull(VolumeGeometry& geometry, osgUtil::CullVisitor& visitor) = 0;
    /// What VolumeSlice does likewise.
    virtual void cull(VolumeSlice& slice, osgUtil::CullVisitor& visitor) = 0;
    /// As osg::Node has them, for what all volumes of a context share.
    virtual void resizeGLObjectBuffers(unsigned int maximum) = 0;
    virtual void releaseGLObjects(osg::State* state) = 0;
    /// See VolumeAppearance::getSettingsInForce().
    virtual VolumeAppearance::Settings settingsInForce(const VolumeAppearance& appearance,
                                                       const VolumeGeometry& geometry) = 0;
};

/// Sets the renderer of the process, which has to outlive all nodes. Called while the library is
/// loaded, before there are threads.
void setRenderer(Renderer* renderer);
/// Null where none was set: nodes then draw nothing.
Renderer* getRenderer();

} // namespace osgVolumizer
