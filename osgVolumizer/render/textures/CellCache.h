#pragma once

#include "../../core/RecencyCache.h"
#include "BrickCells.h"

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace render {

/// The cells of one Voxels' bricks: ranges are found once for each state of the data, which cells
/// are occupied once for each table. Thread safe.
class CellCache
{
public:
    /// Reads the brick on the first call. Null where the source fails. Waits for no other brick.
    std::shared_ptr<const BrickCells> get(const Voxels& voxels, std::int64_t brick,
                                          const OccupancyQuery& query);
    using Part = std::pair<std::int64_t, std::shared_ptr<const BrickCells>>;
    /// The cells of all bricks as of one: of these, by number, as get() gave them, and of those
    /// asked for before and have not changed since. Cells of other bricks show nothing.
    std::shared_ptr<const BrickCells> join(const Voxels& voxels, const OccupancyQuery& query,
                                           const std::vector<Part>& parts);
    /// Whether a brick has been read for its cells, in the present state of its data.
    bool isScanned(const Voxels& voxels, std::int64_t brick) const;
    void resizeGLObjectBuffers(unsigned int maximum);
    void releaseGLObjects(osg::State* state) const;

private:
    static constexpr std::size_t CAPACITY = 3;

    struct Brick
    {
        mutable std::mutex mutex; ///< held while the brick is read and scanned
        unsigned modifiedCount = 0, layoutCount = 0;
        std::shared_ptr<core::CellGrid> linear, cubic; ///< by the support of the filter
        std::shared_ptr<core::LayerRanges> layers;
        core::RecencyCache<OccupancyKey, std::shared_ptr<const BrickCells>> cells{CAPACITY};
    };
    struct Joined
    {
        unsigned layoutCount = 0;
        std::map<std::int64_t, std::shared_ptr<const BrickCells>> parts;
        std::map<std::int64_t, unsigned> modifiedCounts; ///< of the parts' data
        std::shared_ptr<const BrickCells> cells;
    };

    static bool update(const Voxels& voxels, std::int64_t brick, Brick& entry);
    static bool scan(const Voxels& voxels, std::int64_t brick, bool cubic, Brick& entry);
    std::vector<std::shared_ptr<Brick>> allBricks() const;

    mutable std::mutex _mutex; ///< of what follows; never held while that of a brick is taken
    std::map<std::int64_t, std::shared_ptr<Brick>> _bricks;
    core::RecencyCache<OccupancyKey, Joined> _joined{CAPACITY};
};

} // namespace render
} // namespace osgVolumizer
