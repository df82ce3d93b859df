#include "TableTextures.h"

#include "../core/transfer/PreIntegration.h"
#include "../core/transfer/Resampling.h"

#include <osg/Notify>

#include <atomic>
#include <cmath>
#include <cstring>

namespace osgVolumizer {
namespace render {

namespace {

// Whether midpoint sampling at a usual rate would be off by so much that pre-integration pays; says why.
bool needsPreIntegration(const core::TransferFunction& function, const std::string& name)
{
    // A 64th of the range is what the value commonly changes by from sample to sample.
    constexpr double WINDOW = 1.0 / 64.0, TOLERANCE = 0.03;
    const core::WindowError error = core::windowError(function, 0.0, 1.0, WINDOW);
    if (error.error <= TOLERANCE) return false;
    OSG_INFO << "osgVolumizer: lookup table \"" << name << "\" is pre-integrated: at "
             << error.value << " of the range samples a " << 1.0 / WINDOW
             << "th of it apart miss a mean over the values between by " << error.error << "."
             << std::endl;
    return true;
}

constexpr double BITS = 1.0 / 0.6931471805599453; // of extinction, in units of -ln(transmittance)
constexpr int INTEGRAL_COUNT = 4096;

osg::ref_ptr<osg::Texture2D> makeTexture(const std::vector<glm::vec4>& texels, int count)
{
    const int rows = static_cast<int>(texels.size()) / count;
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(count, rows, 1, GL_RGBA, GL_FLOAT, 1);
    std::memcpy(image->data(), texels.data(), texels.size() * sizeof(glm::vec4));
    osg::ref_ptr<osg::Texture2D> texture = new osg::Texture2D(image);
    texture->setInternalFormat(GL_RGBA32F_ARB);
    texture->setResizeNonPowerOfTwoHint(false);
    texture->setFilter(osg::Texture::MIN_FILTER, osg::Texture::LINEAR);
    texture->setFilter(osg::Texture::MAG_FILTER, osg::Texture::LINEAR);
    texture->setWrap(osg::Texture::WRAP_S, osg::Texture::CLAMP_TO_EDGE);
    texture->setWrap(osg::Texture::WRAP_T, osg::Texture::CLAMP_TO_EDGE);
    texture->setDataVariance(osg::Object::STATIC);
    return texture;
}

// Appends the antiderivative at each texel, over the texture coordinate.
void appendIntegrals(const core::TransferFunction& function, int count,
                     std::vector<glm::vec4>& texels)
{
    const core::TransferIntegral integral(function);
    glm::dvec4 sum(0.0);
    texels.emplace_back(0.0f);
    for (int i = 1; i < count; ++i) {
        sum += integral.mean((i - 1.0) / (count - 1.0), i / (count - 1.0)) * (BITS / count);
        texels.emplace_back(sum);
    }
}

TableTexture makeTable(const LookupTable& table, const osg::Vec2d& range,
                       VolumeAppearance::Lookup lookup)
{
    static std::atomic<unsigned> nextId{1};
    TableTexture result;
    result.function = table.getNormalizedFunction(range);
    result.id = nextId++;
    result.integrals = lookup == VolumeAppearance::PREINTEGRATED ||
                       (lookup == VolumeAppearance::AUTOMATIC_LOOKUP &&
                        needsPreIntegration(*result.function, table.getName()));
    const int count = result.integrals
                          ? INTEGRAL_COUNT
                          : core::chooseTexelCount(*result.function, 0.0, 1.0,
                                                   core::TexelPlaces::ENDS)
                                .count;
    std::vector<glm::vec4> texels = result.function->tabulateExtinction(count, 0.0, 1.0, false);
    for (glm::vec4& t : texels) t.a *= static_cast<float>(BITS);
    const auto emission = [](const glm::vec4& t) {
        return glm::vec4(glm::vec3(t) * t.a, t.a);
    };
    result.low = emission(texels.front());
    result.high = emission(texels.back());
    if (result.integrals) appendIntegrals(*result.function, count, texels);
    result.count = count;
    result.fractionToCoordinate = {(count - 1.0) / count, 0.5 / count};
    result.texture = makeTexture(texels, count);
    return result;
}

} // namespace

TableTexture TableTextures::get(const LookupTable& table, const osg::Vec2d& range,
                                VolumeAppearance::Lookup lookup)
{
    if (lookup == VolumeAppearance::BEFORE_INTERPOLATION)
        lookup = VolumeAppearance::AFTER_INTERPOLATION;
    const unsigned modified = table.getModifiedCount();
    std::lock_guard<std::mutex> lock(_mutex);
    for (auto i = _entries.begin(); i != _entries.end(); ++i) {
        if (i->table != &table || i->modifiedCount != modified || i->range != range ||
            i->lookup != lookup)
            continue;
        _entries.splice(_entries.begin(), _entries, i);
        return _entries.front().texture;
    }
    _entries.push_front({&table, modified, range, lookup, makeTable(table, range, lookup)});
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
