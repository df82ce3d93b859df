#pragma once

#include "../../RenderData.h"
#include "../../core/RecencyCache.h"
#include "../../core/cutting/DistanceField.h"

#include <osg/Texture3D>

#include <memory>
#include <mutex>

namespace osgVolumizer {
namespace render {

/// The grids of a VolumeCut, as textures. Kept with the VolumeCut. Thread safe.
class CutTextures : public RenderData
{
public:
    osg::ref_ptr<osg::Texture3D> get(const std::shared_ptr<const core::DistanceField>& field);

    void resizeGLObjectBuffers(unsigned int maximum) override;
    void releaseGLObjects(osg::State* state) const override;

private:
    mutable std::mutex _mutex;
    core::RecencyCache<std::shared_ptr<const core::DistanceField>, osg::ref_ptr<osg::Texture3D>>
        _textures{8};
};

} // namespace render
} // namespace osgVolumizer
