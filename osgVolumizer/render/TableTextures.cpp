#include "TableTextures.h"

#include "../core/transfer/Resampling.h"

#include <atomic>
#include <cmath>
#include <cstring>

namespace osgVolumizer {
namespace render {

namespace {

// Of one unit's opacity; a ray through hundreds of units sums it up to what 8 bits cannot show.
constexpr double TEXEL_TOLERANCE = 1e-7;

TableTexture makeTable(const LookupTable& table, const osg::Vec2d& range)
{
    static std::atomic<unsigned> nextId{1};
    TableTexture result;
    result.function = table.getNormalizedFunction(range);
    result.id = nextId++;
    const int count = core::chooseTexelCount(*result.function, 0.0, 1.0, core::TexelPlaces::ENDS,
                                             TEXEL_TOLERANCE)
                          .count;
    std::vector<glm::vec4> texels = result.function->tabulateExtinction(count, 0.0, 1.0, false);
    for (glm::vec4& t : texels) t.a *= static_cast<float>(1.0 / std::log(2.0));
    result.fractionToCoordinate = {(count - 1.0) / count, 0.5 / count};

    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(count, 1, 1, GL_RGBA, GL_FLOAT, 1);
    std::memcpy(image->data(), texels.data(), texels.size() * sizeof(glm::vec4));
    result.texture = new osg::Texture2D(image);
    result.texture->setInternalFormat(GL_RGBA32F_ARB);
    result.texture->setResizeNonPowerOfTwoHint(false);
    result.texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    result.texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    result.texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    result.texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    result.texture->setDataVariance(osg::Object::STATIC);
    return result;
}

} // namespace

TableTexture TableTextures::get(const LookupTable& table, const osg::Vec2d& range)
{
    const unsigned modified = table.getModifiedCount();
    std::lock_guard<std::mutex> lock(_mutex);
    for (auto i = _entries.begin(); i != _entries.end(); ++i) {
        if (i->table != &table || i->modifiedCount != modified || i->range != range) continue;
        _entries.splice(_entries.begin(), _entries, i);
        return _entries.front().texture;
    }
    _entries.push_front({&table, modified, range, makeTable(table, range)});
    if (_entries.size() > CAPACITY) _entries.pop_back();
    return _entries.front().texture;
}

void TableTextures::resizeGLObjectBuffers(unsigned int maximum)
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (auto& entry : _entries) entry.texture.texture->resizeGLObjectBuffers(maximum);
}

void TableTextures::releaseGLObjects(osg::State* state) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& entry : _entries) entry.texture.texture->releaseGLObjects(state);
}

} // namespace render
} // namespace osgVolumizer
