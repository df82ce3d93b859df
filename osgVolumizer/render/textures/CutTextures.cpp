#include "CutTextures.h"

#include <algorithm>

namespace osgVolumizer {
namespace render {

osg::ref_ptr<osg::Texture3D>
CutTextures::get(const std::shared_ptr<const core::DistanceField>& field)
{
    std::lock_guard<std::mutex> lock(_mutex);
    // Of those that nothing else holds any more the voxels or the cut have changed.
    _textures.removeIf([](const auto& entry) { return entry.key.use_count() == 1; });
    if (const auto* known = _textures.find(field)) return *known;
    const glm::ivec3 n = field->samples();
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(n.x, n.y, n.z, GL_RED, GL_FLOAT, 1);
    std::copy(field->values().begin(), field->values().end(),
              reinterpret_cast<float*>(image->data()));
    osg::ref_ptr<osg::Texture3D> texture = new osg::Texture3D(image);
    texture->setInternalFormat(GL_R32F);
    texture->setResizeNonPowerOfTwoHint(false);
    texture->setUnRefImageDataAfterApply(false);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    for (auto axis : {osg::Texture::WRAP_S, osg::Texture::WRAP_T, osg::Texture::WRAP_R})
        texture->setWrap(axis, osg::Texture::CLAMP_TO_EDGE);
    texture->setDataVariance(osg::Object::STATIC);
    return _textures.add(field, texture);
}

void CutTextures::resizeGLObjectBuffers(unsigned int maximum)
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& texture : _textures)
        texture.value->resizeGLObjectBuffers(maximum);
}

void CutTextures::releaseGLObjects(osg::State* state) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& texture : _textures)
        texture.value->releaseGLObjects(state);
}

} // namespace render
} // namespace osgVolumizer
