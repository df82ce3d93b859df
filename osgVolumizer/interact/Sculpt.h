#pragma once

#include "../EditableVoxelSource.h"
#include "../Error.h"
#include "../Voxels.h"
#include "../core/voxels/SculptTool.h"

#include <osg/Vec3d>
#include <osg/ref_ptr>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace osgVolumizer {

/// Adds to voxels, and takes away from them, with a tool that is drawn along a stroke: in the
/// memory of an EditableVoxelSource, which their source becomes on the first stroke. The file that
/// they are from stays as it is; writeVoxels() and writePyramid() write what they have become, a
/// scene file has it instead of the file's name.
///
/// Values count from the lower end of Voxels::getRange(), as 0, to its upper end, as 1. The range
/// stays as it is, also where it was found in the data. Of RGBA voxels alpha is changed.
///
/// One at a time sculpts the same voxels: what another does meanwhile is not in its history.
/// To be called between frames. Of what is changed only its part of bricks is read and uploaded
/// again; picks see it at once.
class OSGVOLUMIZER_EXPORT Sculptor
{
public:
    using Operation = core::SculptOperation;
    using Shape = core::SculptShape;
    enum Unit
    {
        VOXELS, ///< samples of the finest level
        OBJECT  ///< object units
    };

    /// What core/voxels/SculptTool.h says, and how close its dabs are.
    struct Tool
    {
        Operation operation = Operation::MAX_ADD;
        Shape shape = Shape::ROUND;
        osg::Vec3d radius{10.0, 10.0, 10.0}; ///< half extents along the axes, each > 0
        Unit unit = VOXELS;                  ///< of the radius
        double strength = 1.0;               ///< in (0, 1]
        /// Distance of dabs along a stroke, of the radius in its direction; in (0, 1]. What is
        /// nearer leaves fewer traces of single dabs, and adds up to more with PERLIN_ADD and
        /// PERLIN_SUB.
        double spacing = 0.25;
        std::optional<double> erased; ///< what ERASE sets; the lower end of the range where not set
    };

    /// Bound on what undo and redo keep, unless another is set: 256 MiB.
    static constexpr std::size_t DEFAULT_HISTORY_BYTES = std::size_t(256) << 20;
    /// Bound on the dabs of a stroke between two points.
    static constexpr std::int64_t MAXIMUM_DABS = std::int64_t(1) << 20;

    explicit Sculptor(Voxels* voxels) : _voxels(voxels) {}
    ~Sculptor();
    Sculptor(const Sculptor&) = delete;
    Sculptor& operator=(const Sculptor&) = delete;

    Voxels* getVoxels() const { return _voxels.get(); }
    /// Refuses (VALUE_INVALID) a radius, strength or spacing out of its bounds; the old tool then
    /// stays. A stroke that is being drawn goes on with the new one.
    ReportedStatus setTool(const Tool& tool);
    const Tool& getTool() const { return _tool; }

    /// Begins a stroke with a dab at a point, object frame; ends one that has begun. Returns how
    /// many dabs have changed any voxel, 0 outside the volume. Refused, and nothing is changed:
    /// VALUE_INVALID for a point that is not finite, and what makeEditable() and
    /// EditableVoxelSource::hold() are refused for.
    Result<std::int64_t> beginStroke(const osg::Vec3d& point);
    /// Goes on to a point, with dabs at equal distances along all of the stroke, however many
    /// points it has. Refused as beginStroke(), and VALUE_INVALID without a stroke; TOO_LARGE for
    /// more than MAXIMUM_DABS.
    Result<std::int64_t> strokeTo(const osg::Vec3d& point);
    /// A stroke becomes one step of undo, unless it has changed nothing.
    void endStroke();
    /// All of a stroke: refused as a whole, and nothing is changed.
    Result<std::int64_t> stroke(const std::vector<osg::Vec3d>& points);

    bool canUndo() const { return !_undo.empty() || !_changed.empty(); }
    bool canRedo() const { return !_redo.empty(); }
    /// Puts the voxels back as they were before the last stroke, to the bit; ends one that has
    /// begun. VALUE_INVALID where there is none.
    Status undo();
    /// Does again what undo() has undone. A new stroke forgets what could be.
    Status redo();
    /// Strokes are forgotten, the oldest first, until the blocks of those that are left have no
    /// more bytes; a stroke that has more by itself cannot be undone.
    void setHistoryBytes(std::size_t bytes);
    std::size_t getHistoryBytes() const { return _historyBytes; }

private:
    using Edit = EditableVoxelSource::Edit;
    /// How far a stroke has come.
    struct Path
    {
        glm::dvec3 last{0.0}; ///< voxel frame
        double left = 0.0;    ///< until the next dab, of the distance of dabs
    };

    Status prepare();
    void forgetAnotherSource();
    Result<std::int64_t> begin(const std::vector<osg::Vec3d>& points);
    core::SculptTool toolVoxel() const;
    glm::dvec3 toVoxel(const osg::Vec3d& point) const;
    Status placeDabs(const osg::Vec3d& end, Path& path, std::vector<glm::dvec3>& dabs) const;
    Status holdAll(const std::vector<glm::dvec3>& dabs);
    std::int64_t apply(const std::vector<glm::dvec3>& dabs);
    bool applyDab(const core::SculptTool& tool, const glm::dvec3& middleVoxel,
                  std::vector<core::Box3i>& changed);
    void limitHistory();
    static std::size_t bytesOf(const std::deque<Edit>& edits);

    osg::ref_ptr<Voxels> _voxels;
    osg::ref_ptr<EditableVoxelSource> _source; // of the voxels; null until it is needed
    Tool _tool;
    bool _stroking = false;
    Path _path;
    std::vector<core::Box3i> _changed;  // by the stroke
    std::vector<unsigned char> _buffer; // samples under the tool
    std::deque<Edit> _undo, _redo;      // the last one is next
    std::size_t _historyBytes = DEFAULT_HISTORY_BYTES;
};

} // namespace osgVolumizer
