#pragma once

#include "../../RenderData.h"
#include "../../core/cutting/DistanceField.h"

#include <osg/Texture3D>

#include <memory>
#include <mutex>

namespace osgVolumizer {
namespace render {

/// The grid of a VolumeCut's last state, as a texture. Kept with the VolumeCut. Thread safe.
class CutTextures : public RenderData
{
public:
    osg::ref_ptr<osg::Texture3D> get(const std::shared_ptr<const core::DistanceField>& field);

    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state) const override;

private:
    mutable std::mutex _mutex;
    std::shared_ptr<const core::DistanceField> _field;
    osg::ref_ptr<osg::Texture3D> _texture;
};

} // namespace render
} // namespace osgVolumizer
