#pragma once

#include "../LookupTable.h"

#include <osg/Texture2D>

#include <glm/vec2.hpp>

#include <list>
#include <memory>
#include <mutex>

namespace osgVolumizer {
namespace render {

/// A lookup table as a texture of one row: colour, and extinction in bits per opacity unit.
struct TableTexture
{
    osg::ref_ptr<osg::Texture2D> texture;
    glm::dvec2 fractionToCoordinate{1.0, 0.0}; ///< scale and offset: fraction of the range -> texture
    LookupTable::Function function;            ///< of the fraction of the range
    unsigned id = 0;                           ///< differs for every texture ever made
};

/// Tables of one appearance, by what they were made from. Thread safe.
class TableTextures
{
public:
    TableTexture get(const LookupTable& table, const osg::Vec2d& range);
    void resizeGLObjectBuffers(unsigned int maximum);
    void releaseGLObjects(osg::State* state) const;

private:
    struct Entry
    {
        osg::ref_ptr<const LookupTable> table;
        unsigned modifiedCount;
        osg::Vec2d range;
        TableTexture texture;
    };
    static constexpr std::size_t CAPACITY = 3;

    mutable std::mutex _mutex;
    std::list<Entry> _entries; ///< most recent first
};

} // namespace render
} // namespace osgVolumizer
