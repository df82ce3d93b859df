#pragma once

#include "../../LookupTable.h"
#include "../../core/RecencyCache.h"

#include <osg/TextureBuffer>

#include <mutex>

namespace osgVolumizer {
namespace render {

/// The points of a transfer function as a texture buffer, which a shader searches: exact wherever
/// they are, kinks and jumps included. Two texels a point: the value, as a fraction of the range,
/// in red; colour and opacity, straight.
struct ColorPoints
{
    osg::ref_ptr<osg::TextureBuffer> texture;
    int count = 0;
    /// The first two, where there are no others: what a window has.
    core::TransferFunction::Point ramp[2];
};

/// Those of tables, by what they were made from. Thread safe.
class ColorPointsCache
{
public:
    ColorPoints get(const LookupTable& table, const osg::Vec2d& range);
    void resizeGLObjectBuffers(unsigned int maximum);
    void releaseGLObjects(osg::State* state) const;

private:
    struct Key
    {
        unsigned modifiedCount; ///< different for all tables
        osg::Vec2d range;
        bool operator==(const Key& o) const
        {
            return modifiedCount == o.modifiedCount && range == o.range;
        }
    };

    mutable std::mutex _mutex;
    core::RecencyCache<Key, ColorPoints> _known{3};
};

} // namespace render
} // namespace osgVolumizer
