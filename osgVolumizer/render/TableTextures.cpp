#include "TableTextures.h"

#include "../core/transfer/PreIntegration.h"

#include <osg/Notify>

#include <glm/vec3.hpp>

#include <atomic>
#include <cstring>

namespace osgVolumizer {
namespace render {

namespace {

constexpr double BITS = 1.0 / 0.6931471805599453; // of extinction, in units of -ln(transmittance)

// Few enough to stay in a cache, and to be made in a millisecond; so many that the nearest one
// hardly differs.
constexpr int ENTRIES = 16384;

// Whether midpoint sampling at a usual rate would be off by so much that pre-integration pays; says
// why.
bool needsPreIntegration(const core::TransferFunction& function, const std::string& name)
{
    // A 64th of the range is what the value commonly changes by from sample to sample.
    constexpr double WINDOW = 1.0 / 64.0, TOLERANCE = 0.03;
    const core::WindowError error = core::windowError(function, 0.0, 1.0, WINDOW);
    if (error.error <= TOLERANCE) return false;
    OSG_INFO << "osgVolumizer: lookup table \"" << name << "\" is pre-integrated: at "
             << error.value << " of the range, samples a " << 1.0 / WINDOW
             << "th of it apart miss the mean of what lies between by " << error.error << "."
             << std::endl;
    return true;
}

osg::ref_ptr<osg::TextureBuffer> makeTexture(const std::vector<glm::vec4>& texels)
{
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(static_cast<int>(texels.size()), 1, 1, GL_RGBA, GL_FLOAT, 1);
    std::memcpy(image->data(), texels.data(), texels.size() * sizeof(glm::vec4));
    osg::ref_ptr<osg::TextureBuffer> texture = new osg::TextureBuffer;
    texture->setImage(image);
    texture->setInternalFormat(GL_RGBA32F_ARB);
    texture->setUnRefImageDataAfterApply(false);
    texture->setDataVariance(osg::Object::STATIC);
    return texture;
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
    result.count = ENTRIES;
    std::vector<glm::vec4> texels = result.function->tabulateExtinction(ENTRIES, 0.0, 1.0, false);
    for (glm::vec4& t : texels)
        t.a *= static_cast<float>(BITS);
    const auto emission = [](const glm::vec4& t) { return glm::vec4(glm::vec3(t) * t.a, t.a); };
    result.low = emission(texels.front());
    result.high = emission(texels.back());
    if (result.integrals) {
        const core::TransferIntegral integral(*result.function);
        for (const glm::dvec4& sum : integral.tabulate(result.count, 0.0, 1.0))
            texels.emplace_back(sum * BITS);
    } else {
        texels.push_back(texels.back()); // for interpolation at the last
    }
    result.texture = makeTexture(texels);
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
    for (auto& entry : _entries)
        entry.texture.texture->resizeGLObjectBuffers(maximum);
}

void TableTextures::releaseGLObjects(osg::State* state) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& entry : _entries)
        entry.texture.texture->releaseGLObjects(state);
}

} // namespace render
} // namespace osgVolumizer
