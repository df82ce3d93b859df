#pragma once

#include "../../VolumeAppearance.h"
#include "../../core/RecencyCache.h"
#include "../../core/transfer/ExtinctionTable.h"
#include "../../core/transfer/IntervalTable.h"

#include <osg/TextureBuffer>

#include <glm/vec4.hpp>

#include <memory>
#include <mutex>
#include <vector>

namespace osgVolumizer {
namespace render {

/// A core::ExtinctionTable as a texture buffer, read at the nearest entry, which on some devices
/// costs a third of what a filtered texture does; or a core::IntervalTable.
struct TableTexture
{
    osg::ref_ptr<osg::TextureBuffer> texture;
    bool integrals = false;
    /// What a sample may miss where the value changes by a 64th of the range from one to the next,
    /// in premultiplied colour and opacity of one unit; of RayRule::CELLS nothing.
    double missed = 0.0;
    bool shortRuns = false; ///< integrals are too large for differences over few entries
    int count = 1;          ///< entries; of intervals 2, so that an entry is a fraction
    std::shared_ptr<const core::IntervalTable> intervals; ///< null where it is one of entries
    glm::vec4 low{0.0f}, high{0.0f}; ///< extinction times colour, extinction: beyond the ends
    /// Numbers of entries, and of gaps between entries (integrals only), that show something before
    /// each. Intervals: of their texels.
    std::shared_ptr<const std::vector<int>> shownEntries, shownGaps;
    LookupTable::Function function; ///< of the fraction of the range
    /// How it is read.
    VolumeAppearance::Lookup lookup() const
    {
        return intervals   ? VolumeAppearance::CELL_BY_CELL
               : integrals ? VolumeAppearance::PREINTEGRATED
                           : VolumeAppearance::AFTER_INTERPOLATION;
    }
    /// Whether anything is shown of values between two fractions of the range, low <= high, the way
    /// the table is read: at entries, or over runs of them.
    bool shows(double lowFraction, double highFraction) const;
    /// The texels in memory, for as long as there is the texture; empty where that is null, and of
    /// intervals.
    core::ExtinctionTable entries() const;
    unsigned id = 0; ///< differs for every texture ever made
};

/// Applies the texture of a table to a unit; false, reported once, where the card refuses it: what
/// it is for is not drawn.
bool applyTable(osg::State& state, osg::TextureBuffer* texture, unsigned unit);

/// Tables of one appearance, by what they were made from. Those of a lookup table that appearances
/// share are shared too. Thread safe.
class TableTextures
{
public:
    /// BEFORE_INTERPOLATION needs what AFTER_INTERPOLATION needs.
    TableTexture get(const LookupTable& table, const osg::Vec2d& range,
                     VolumeAppearance::Lookup lookup);
    /// The points of a table, and not entries: two texels each, colour and opacity, then the
    /// fraction of the range where it is; the first and last are far away. `count` is theirs.
    TableTexture points(const LookupTable& table, const osg::Vec2d& range);
    void resizeGLObjectBuffers(unsigned int maximum);
    void releaseGLObjects(osg::State* state) const;

private:
    struct Key
    {
        osg::ref_ptr<const LookupTable> table;
        unsigned modifiedCount;
        osg::Vec2d range;
        VolumeAppearance::Lookup lookup;
        bool points = false;
        bool operator==(const Key& o) const
        {
            return table == o.table && modifiedCount == o.modifiedCount && range == o.range &&
                   lookup == o.lookup && points == o.points;
        }
    };
    static constexpr std::size_t CAPACITY = 3;

    mutable std::mutex _mutex;
    core::RecencyCache<Key, std::shared_ptr<const TableTexture>> _tables{CAPACITY};
};

} // namespace render
} // namespace osgVolumizer
