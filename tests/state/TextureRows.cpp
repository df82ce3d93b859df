// Textures and what belongs to their units.

#include "StateRow.h"

#include <osg/BindImageTexture>
#include <osg/Image>
#include <osg/Sampler>
#include <osg/TexEnv>
#include <osg/TexEnvCombine>
#include <osg/TexEnvFilter>
#include <osg/TexGen>
#include <osg/TexMat>
#include <osg/Texture1D>
#include <osg/Texture2D>
#include <osg/Texture2DArray>
#include <osg/Texture2DMultisample>
#include <osg/Texture3D>
#include <osg/TextureBuffer>
#include <osg/TextureCubeMap>
#include <osg/TextureRectangle>

#ifndef GL_TEXTURE_CUBE_MAP_SEAMLESS
#define GL_TEXTURE_CUBE_MAP_SEAMLESS 0x884F
#endif

namespace osgVolumizer {
namespace test {

namespace {

using osg::StateSet;

constexpr unsigned UNITS = 8; // fixed function has no more

const char* const OWN_TEXTURES = "Textures belong to programs, and a volume has its own.";

osg::ref_ptr<osg::Image> checks(int width, int height, int depth)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(width, height, depth, GL_RGBA, GL_UNSIGNED_BYTE);
    for (unsigned i = 0; i < image->getTotalSizeInBytes(); ++i)
        image->data()[i] = static_cast<unsigned char>(40 + i * 53 % 180);
    return image;
}

template <class Texture>
void setOnAllUnits(StateSet& set, unsigned value, Texture* made)
{
    const osg::ref_ptr<Texture> texture = made;
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST);
    for (unsigned unit = 0; unit < UNITS; ++unit)
        set.setTextureAttributeAndModes(unit, texture, value);
}

// With a texture, without which it shows nothing.
template <class Attribute>
void setWithTexture(StateSet& set, unsigned value, Attribute* made)
{
    const osg::ref_ptr<Attribute> attribute = made;
    set.setTextureAttributeAndModes(0, new osg::Texture2D(checks(8, 8, 1)), value);
    for (unsigned unit = 0; unit < UNITS; ++unit)
        set.setTextureAttributeAndModes(unit, attribute, value);
}

void setCube(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::TextureCubeMap> cube = new osg::TextureCubeMap;
    for (unsigned face = 0; face < 6; ++face)
        cube->setImage(face, checks(4, 4, 1));
    setOnAllUnits(set, value, cube.get());
}

void setArray(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::Texture2DArray> array = new osg::Texture2DArray;
    array->setTextureSize(4, 4, 2);
    for (unsigned layer = 0; layer < 2; ++layer)
        array->setImage(layer, checks(4, 4, 1));
    for (unsigned unit = 0; unit < UNITS; ++unit) // has no mode of fixed function
        set.setTextureAttribute(unit, array, value);
}

void setBuffer(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::TextureBuffer> buffer = new osg::TextureBuffer(checks(16, 1, 1));
    buffer->setInternalFormat(GL_RGBA8);
    for (unsigned unit = 0; unit < UNITS; ++unit)
        set.setTextureAttribute(unit, buffer, value);
}

void setSamples(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::Texture2DMultisample> samples = new osg::Texture2DMultisample(4, false);
    samples->setTextureSize(8, 8);
    samples->setInternalFormat(GL_RGBA8);
    for (unsigned unit = 0; unit < UNITS; ++unit)
        set.setTextureAttribute(unit, samples, value);
}

// Would turn every texture of a volume into another one.
void setSampler(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::Sampler> sampler = new osg::Sampler;
    sampler->setFilter(osg::Texture::MIN_FILTER, osg::Texture::NEAREST_MIPMAP_NEAREST);
    sampler->setFilter(osg::Texture::MAG_FILTER, osg::Texture::NEAREST);
    sampler->setMinLOD(4.0f);
    sampler->setShadowCompareFunc(osg::Texture::NEVER);
    for (unsigned unit = 0; unit < UNITS; ++unit)
        set.setTextureAttribute(unit, sampler, value);
}

void setImageUnit(StateSet& set, unsigned value)
{
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(checks(8, 8, 1));
    texture->setInternalFormat(GL_RGBA8);
    set.setAttribute(
        new osg::BindImageTexture(0, texture, osg::BindImageTexture::READ_ONLY, GL_RGBA8), value);
}

osg::TexEnvCombine* doubled()
{
    osg::ref_ptr<osg::TexEnvCombine> combine = new osg::TexEnvCombine;
    combine->setScale_RGB(4.0f);
    return combine.release();
}

} // namespace

std::vector<StateRow> textureRows()
{
    const auto made = [](auto make) {
        return [make](StateSet& set, unsigned value) { setOnAllUnits(set, value, make()); };
    };
    const auto unit = [](auto make) {
        return [make](StateSet& set, unsigned value) { setWithTexture(set, value, make()); };
    };
    return {
        {"Texture1D", made([]() { return new osg::Texture1D(checks(8, 1, 1)); }), Effect::NONE,
         true, OWN_TEXTURES},
        {"Texture2D", made([]() { return new osg::Texture2D(checks(8, 8, 1)); }), Effect::NONE,
         true, OWN_TEXTURES},
        {"Texture3D", made([]() { return new osg::Texture3D(checks(4, 4, 4)); }), Effect::NONE,
         true, OWN_TEXTURES},
        {"TextureRectangle", made([]() { return new osg::TextureRectangle(checks(8, 8, 1)); }),
         Effect::NONE, true, OWN_TEXTURES},
        {"TextureCubeMap", setCube, Effect::NONE, true, OWN_TEXTURES},
        {"Texture2DArray", setArray, Effect::NONE, false, OWN_TEXTURES},
        {"TextureBuffer", setBuffer, Effect::NONE, false, OWN_TEXTURES},
        {"Texture2DMultisample", setSamples, Effect::NONE, false, OWN_TEXTURES},
        {"Sampler", setSampler, Effect::NONE, false, OWN_TEXTURES},
        {"BindImageTexture", setImageUnit, Effect::NONE, false, OWN_TEXTURES},
        {"TexEnv", unit([]() { return new osg::TexEnv(osg::TexEnv::REPLACE); }), Effect::NONE, true,
         OWN_TEXTURES},
        {"TexEnvCombine", unit(doubled), Effect::NONE, true, OWN_TEXTURES},
        {"TexEnvFilter", unit([]() { return new osg::TexEnvFilter(4.0f); }), Effect::NONE, true,
         OWN_TEXTURES},
        {"TexGen", unit([]() { return new osg::TexGen; }), Effect::NONE, true, OWN_TEXTURES},
        {"TexMat", unit([]() { return new osg::TexMat(osg::Matrix::scale(3.0, 5.0, 1.0)); }),
         Effect::NONE, true, OWN_TEXTURES},
        {"`GL_TEXTURE_CUBE_MAP_SEAMLESS`", mode(GL_TEXTURE_CUBE_MAP_SEAMLESS), Effect::NONE, false,
         OWN_TEXTURES},
    };
}

} // namespace test
} // namespace osgVolumizer
