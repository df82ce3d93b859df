#pragma once

#include "../Export.h"
#include "../geometry/Box.h"

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace osgVolumizer {
namespace core {

/// Boxes that cover those of `boxes`, samples, nearly without overlap and with little else: in
/// lines of 16 x 2 x 2 samples, each cut down to what it has to cover, and joined with neighbours
/// where that adds little. Of thousands of rows, such as those of a ball, it makes some hundred
/// boxes. Many more samples than 2^22 are covered by one box.
OSGVOLUMIZER_CORE_EXPORT std::vector<Box3i> coveringBoxes(const std::vector<Box3i>& boxes);

/// The part of each box that is within another; without those that are outside.
OSGVOLUMIZER_CORE_EXPORT std::vector<Box3i> clipped(const std::vector<Box3i>& boxes,
                                                    const Box3i& within);

/// Each box with a margin on all sides, within another.
OSGVOLUMIZER_CORE_EXPORT std::vector<Box3i> grown(const std::vector<Box3i>& boxes, int margin,
                                                  const Box3i& within);

/// Which samples of a volume have changed since when, as far back as it remembers: the last
/// MAXIMUM_BOXES. Counts only ever grow. Not thread safe.
class OSGVOLUMIZER_CORE_EXPORT ChangeLog
{
public:
    static constexpr std::size_t MAXIMUM_BOXES = std::size_t(1) << 16;

    /// Samples that have changed, and with which count.
    void add(std::vector<Box3i> boxes, unsigned count);
    /// Nothing is known of what changed up to a count.
    void forget(unsigned count);
    /// Covers what changed after a count within a box; nothing where that is not known.
    std::optional<std::vector<Box3i>> since(unsigned count, const Box3i& within) const;

private:
    struct Change
    {
        unsigned count;
        std::vector<Box3i> boxes;
    };

    std::deque<Change> _changes; ///< oldest first
    std::size_t _boxCount = 0;
    unsigned _knownFrom = 0; ///< all changes after this count are there
};

} // namespace core
} // namespace osgVolumizer
