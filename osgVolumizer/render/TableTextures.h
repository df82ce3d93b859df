#pragma once

#include "../VolumeAppearance.h"

#include <osg/Texture2D>

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <list>
#include <memory>
#include <mutex>

namespace osgVolumizer {
namespace render {

/// A lookup table as a texture. Row 0: colour, and extinction in bits per opacity unit. Row 1, where there
/// are integrals: the integral of extinction times colour, and of extinction, over the texture
/// coordinate, so that a difference of two texels over the difference of their coordinates is a mean.
/// The first and last texels' centres are the ends of the voxels' range.
struct TableTexture
{
    osg::ref_ptr<osg::Texture2D> texture;
    bool integrals = false;
    int count = 0;                             ///< texels of a row
    glm::dvec2 fractionToCoordinate{1.0, 0.0}; ///< scale and offset: fraction of the range -> texture
    glm::vec4 low{0.0f}, high{0.0f};           ///< extinction times colour, extinction: beyond the ends
    LookupTable::Function function;            ///< of the fraction of the range
    unsigned id = 0;                           ///< differs for every texture ever made
};

/// Tables of one appearance, by what they were made from. Thread safe.
class TableTextures
{
public:
    /// BEFORE_INTERPOLATION needs what AFTER_INTERPOLATION needs.
    TableTexture get(const LookupTable& table, const osg::Vec2d& range,
                     VolumeAppearance::Lookup lookup);
    void resizeGLObjectBuffers(unsigned int maximum);
    void releaseGLObjects(osg::State* state) const;

private:
    struct Entry
    {
        osg::ref_ptr<const LookupTable> table;
        unsigned modifiedCount;
        osg::Vec2d range;
        VolumeAppearance::Lookup lookup;
        TableTexture texture;
    };
    static constexpr std::size_t CAPACITY = 3;

    mutable std::mutex _mutex;
    std::list<Entry> _entries; ///< most recent first
};

} // namespace render
} // namespace osgVolumizer
