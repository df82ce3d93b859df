#pragma once

#include "TableTextures.h"

#include "../../Voxels.h"
#include "../../core/geometry/Box.h"
#include "../../core/voxels/LayerRanges.h"
#include "../../core/voxels/Occupancy.h"

#include <osg/Texture3D>

#include <glm/vec3.hpp>

#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace osgVolumizer {
namespace render {

/// Where a brick shows something under one table.
struct BrickCells
{
    core::Box3d box;          ///< voxel frame; around what shows, to one sample; empty for nothing
    bool homogeneous = false; ///< all samples have one value
    /// Chebyshev distance of each cell, in cells, to the next occupied one, as bytes.
    osg::ref_ptr<osg::Texture3D> texture;
    glm::vec3 origin{0.0f}; ///< voxel frame; corner of cell (0,0,0)
    float cellSize = 1.0f;
    /// In the box: all cells, and those that show something.
    std::int64_t cellCount = 0, occupiedCount = 0;
    /// What is marched through where empty cells are leapt over from both ends of a ray, cubic
    /// voxels: mean over rays along the axes. Nothing in homogeneous bricks.
    double marchedVolume = 0.0;
    /// Of cells that are joined: the same of each part by itself, summed.
    double apartMarchedVolume = 0.0;
};

/// What decides which values are shown.
struct OccupancyQuery
{
    const TableTexture* table = nullptr;
    bool cubic = false;      ///< values overshoot the samples'
    bool isosurface = false; ///< only this value is shown
    double isoFraction = 0.0;
};

/// BrickCells::texture of one cell that is occupied.
osg::Texture3D* occupiedEverywhere();

/// Whether anything is shown of data values between two, low <= high.
bool showsValues(const Voxels& voxels, const OccupancyQuery& query, double low, double high);

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
    /// asked for before. Cells of other bricks show nothing.
    std::shared_ptr<const BrickCells> join(const Voxels& voxels, const OccupancyQuery& query,
                                           const std::vector<Part>& parts);
    /// Whether a brick has been read for its cells, in the present state of its data.
    bool isScanned(const Voxels& voxels, std::int64_t brick) const;
    void resizeGLObjectBuffers(unsigned int maximum);
    void releaseGLObjects(osg::State* state) const;

private:
    struct Key
    {
        unsigned tableId = 0;
        bool cubic = false, isosurface = false;
        double isoFraction = 0.0;
        bool operator==(const Key& o) const
        {
            return tableId == o.tableId && cubic == o.cubic && isosurface == o.isosurface &&
                   isoFraction == o.isoFraction;
        }
    };
    struct Brick
    {
        mutable std::mutex mutex; ///< held while the brick is read and scanned
        unsigned modifiedCount = 0, layoutCount = 0;
        std::shared_ptr<const core::CellGrid> linear, cubic; ///< by the support of the filter
        std::shared_ptr<const core::LayerRanges> layers;
        std::list<std::pair<Key, std::shared_ptr<const BrickCells>>> cells; ///< most recent first
    };
    struct Joined
    {
        Key key;
        unsigned layoutCount = 0;
        std::map<std::int64_t, std::shared_ptr<const BrickCells>> parts;
        std::shared_ptr<const BrickCells> cells;
    };
    static constexpr std::size_t CAPACITY = 3;

    static Key keyOf(const Voxels& voxels, const OccupancyQuery& query);
    static bool scan(const Voxels& voxels, std::int64_t brick, bool cubic, Brick& entry);
    std::vector<std::shared_ptr<Brick>> allBricks() const;

    mutable std::mutex _mutex; ///< of what follows; never held while that of a brick is taken
    std::map<std::int64_t, std::shared_ptr<Brick>> _bricks;
    std::list<Joined> _joined; ///< most recent first
};

} // namespace render
} // namespace osgVolumizer
