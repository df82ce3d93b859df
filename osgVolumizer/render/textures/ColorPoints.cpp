#include "ColorPoints.h"

#include <glm/vec4.hpp>

#include <algorithm>
#include <cstring>
#include <vector>

namespace osgVolumizer {
namespace render {

namespace ColorPointsMaking {

// Every context has texture buffers of twice as many texels; of more points there are these.
constexpr std::size_t MOST = 32768;

std::vector<core::TransferFunction::Point> pointsOf(const core::TransferFunction& function)
{
    if (function.points().size() <= MOST) return function.points();
    std::vector<core::TransferFunction::Point> points(MOST);
    const double low = function.points().front().value;
    const double step = (function.points().back().value - low) / double(MOST - 1);
    for (std::size_t i = 0; i < MOST; ++i) {
        points[i].value = low + step * double(i);
        points[i].color = function.evaluate(points[i].value);
    }
    return points;
}

ColorPoints make(const core::TransferFunction& function)
{
    constexpr double LARGEST = 1e30; // values beyond are none
    const auto points = pointsOf(function);
    std::vector<glm::vec4> texels;
    for (const auto& point : points) {
        texels.emplace_back(std::clamp(point.value, -LARGEST, LARGEST), 0.0, 0.0, 0.0);
        texels.emplace_back(point.color);
    }
    osg::ref_ptr<osg::Image> image = new osg::Image;
    image->allocateImage(static_cast<int>(texels.size()), 1, 1, GL_RGBA, GL_FLOAT, 1);
    std::memcpy(image->data(), texels.data(), texels.size() * sizeof(glm::vec4));
    ColorPoints result;
    result.texture = new osg::TextureBuffer;
    result.texture->setImage(image);
    result.texture->setInternalFormat(GL_RGBA32F_ARB);
    result.texture->setUnRefImageDataAfterApply(false);
    result.texture->setDataVariance(osg::Object::STATIC);
    result.count = static_cast<int>(points.size());
    if (points.size() == 2) std::copy(points.begin(), points.end(), result.ramp);
    return result;
}

} // namespace ColorPointsMaking

ColorPoints ColorPointsCache::get(const LookupTable& table, const osg::Vec2d& range)
{
    const Key key{table.getModifiedCount(), range};
    std::lock_guard<std::mutex> lock(_mutex);
    if (const auto* known = _known.find(key)) return *known;
    return _known.add(key, ColorPointsMaking::make(*table.getNormalizedFunction(range)));
}

void ColorPointsCache::resizeGLObjectBuffers(unsigned int maximum)
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& entry : _known)
        entry.value.texture->resizeGLObjectBuffers(maximum);
}

void ColorPointsCache::releaseGLObjects(osg::State* state) const
{
    std::lock_guard<std::mutex> lock(_mutex);
    for (const auto& entry : _known)
        entry.value.texture->releaseGLObjects(state);
}

} // namespace render
} // namespace osgVolumizer
