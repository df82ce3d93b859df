#pragma once

#include "Error.h"
#include "core/geometry/Box.h"
#include "core/voxels/VoxelType.h"

#include <osg/Object>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

namespace osgVolumizer {

/// Samples of a box, x fastest, tightly packed, in native byte order; kept alive by `owner`.
struct VoxelBlock
{
    std::shared_ptr<const void> owner;
    const unsigned char* data = nullptr;
    std::size_t bytes = 0;

    explicit operator bool() const { return data != nullptr; }
};

/// Supplies the samples of a volume. Subclass it to page from a database, a simulation or a
/// formula. Every method may be called from any thread, several at once.
class OSGVOLUMIZER_EXPORT VoxelSource : public osg::Object
{
public:
    struct Description
    {
        glm::ivec3 size{0}; ///< samples per axis
        VoxelType type = VoxelType::UINT8;
        int components = 1;      ///< 1 scalar, 4 RGBA
        glm::dvec3 spacing{1.0}; ///< object units between samples
        glm::dvec3 origin{0.0};  ///< object position of sample (0,0,0)
        /// Where the voxel axes point, a unit vector each, as far as the file says: in the frame of
        /// DICOM and ITK, x to the left, y to the back, z to the head (LPS). They may be skewed and
        /// left-handed. Voxel v lies at axes * (origin + spacing * v) in that frame. Of no effect
        /// on voxels by themselves: readVolume() turns what it makes, so that all that it reads
        /// lies where the files say.
        glm::dmat3 axes{1.0};

        std::int64_t sizeInBytes() const;
        /// Refuses a size below 1, an unknown type, components other than 1 and 4, a spacing
        /// outside [1e-18, 1e18], and an origin outside [-1e18, 1e18].
        Status validate() const;
    };

    virtual Description describe() const = 0;
    /// Writes the samples of `region` (inside the volume) to `destination`, x fastest, tightly
    /// packed, in native byte order.
    virtual Status read(const core::Box3i& region, void* destination) const = 0;
    /// Lowest and highest value in a region where that is known without reading; else nothing.
    virtual std::optional<std::pair<double, double>> valueRange(const core::Box3i& /*region*/) const
    {
        return std::nullopt;
    }
    /// The samples of a region where they lie in memory as read() would write them; else an empty
    /// block. Saves the copy.
    virtual VoxelBlock share(const core::Box3i& /*region*/) const { return {}; }

    /// How many copies of the volume there are, each coarser than the one before: see
    /// core/voxels/BrickTree.h. Level 0 is the volume. A source of more than one level is paged:
    /// see Voxels::isPaged().
    virtual int levelCount() const { return 1; }
    /// What read() is for level 0. The value of a sample of level l stands for 2^l samples of the
    /// volume on each axis: their mean, or what suits the data.
    virtual Status readLevel(int level, const core::Box3i& region, void* destination) const;
    /// Lowest and highest value of all samples of the volume that a region of a level stands for,
    /// where that is known without reading; else nothing.
    virtual std::optional<std::pair<double, double>> levelRange(int level,
                                                                const core::Box3i& region) const;
    /// Edge of the bricks in which a source of several levels is read best, in samples.
    virtual int pageSize() const { return 64; }

    /// A level of a source that has only the volume: of the samples that one of a level stands for
    /// the one in the middle. Reads row by row.
    Status readThinned(int level, const core::Box3i& region, void* destination) const;

    /// How many states of the volume there are, one after another, "time steps": all of the same
    /// description, levels and page size; step 0 is what the methods above read. A source of more
    /// than one step is paged, as one of several levels.
    virtual int stepCount() const { return 1; }
    /// What readLevel() is for step 0.
    virtual Status readStep(int step, int level, const core::Box3i& region,
                            void* destination) const;
    /// What levelRange() is for step 0.
    virtual std::optional<std::pair<double, double>> stepRange(int step, int level,
                                                               const core::Box3i& region) const;

protected:
    VoxelSource() = default;
    /// A copy with CopyOp::DEEP_COPY_OBJECTS is to share nothing that can be changed.
    VoxelSource(const VoxelSource& o, const osg::CopyOp& op) : osg::Object(o, op) {}
    ~VoxelSource() override = default;

    /// Refuses a region that reaches beyond a volume of `size` samples (INDEX_OUT_OF_RANGE).
    static Status checkRegion(const core::Box3i& region, const glm::ivec3& size);
};

/// Voxels in memory: the library's own, or the application's without a copy.
class OSGVOLUMIZER_EXPORT MemoryVoxelSource : public VoxelSource
{
public:
    META_Object(osgVolumizer, MemoryVoxelSource);

    /// Bound on what allocate() takes: 2^36 bytes.
    static constexpr std::int64_t DEFAULT_MAXIMUM_BYTES = std::int64_t(1) << 36;

    MemoryVoxelSource() = default;
    /// Shares the voxels; a copy of its own with CopyOp::DEEP_COPY_OBJECTS. Where there is no
    /// memory for that, it is reported, and the copy has none.
    MemoryVoxelSource(const MemoryVoxelSource& o,
                      const osg::CopyOp& op = osg::CopyOp::SHALLOW_COPY);

    /// Allocates zeroed voxels. Refuses a description that is not valid, and more than
    /// `maximumBytes` or than there is memory (TOO_LARGE); the old voxels then stay.
    ReportedStatus allocate(const Description& description,
                            std::int64_t maximumBytes = DEFAULT_MAXIMUM_BYTES);
    /// Uses `data` (x fastest, tightly packed) as it is; `release` is called when neither the
    /// source nor a block of it is in use any more. The application may change the values between
    /// frames; it then tells Voxels::dirty().
    ReportedStatus setExternal(const Description& description, void* data,
                               std::function<void()> release = {});

    /// Null until there are voxels.
    void* data() { return _data.get(); }
    const void* data() const { return _data.get(); }
    std::size_t sizeInBytes() const;

    Description describe() const override { return _description; }
    Status read(const core::Box3i& region, void* destination) const override;
    VoxelBlock share(const core::Box3i& region) const override;

protected:
    ~MemoryVoxelSource() override = default;

private:
    Status checkOwnRegion(const core::Box3i& region) const;

    Description _description;
    std::shared_ptr<void> _data;
};

} // namespace osgVolumizer
