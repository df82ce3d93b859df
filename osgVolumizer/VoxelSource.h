#pragma once

#include "core/Export.h"
#include "core/Status.h"
#include "core/geometry/Box.h"
#include "core/voxels/VoxelType.h"

#include <osg/Object>

#include <glm/vec3.hpp>

#include <functional>
#include <optional>
#include <vector>

namespace osgVolumizer {

/// Where voxels come from. Subclass it to page from a database, a simulation or a formula.
/// Every method may be called from any thread, several at once.
class OSGVOLUMIZER_EXPORT VoxelSource : public osg::Object
{
public:
    struct Description
    {
        glm::ivec3 size{0}; ///< samples per axis
        VoxelType type = VoxelType::UINT8;
        int components = 1; ///< 1 scalar, 4 RGBA
        glm::dvec3 spacing{1.0}; ///< object units between samples
        glm::dvec3 origin{0.0};  ///< object position of sample (0,0,0)
    };

    virtual Description describe() const = 0;
    /// Writes the samples of `region` (inside the volume) to `destination`, x fastest, tightly packed,
    /// in native byte order.
    virtual Status read(const core::Box3i& region, void* destination) const = 0;
    /// Lowest and highest value in a region where that is known without reading; else nothing.
    virtual std::optional<std::pair<double, double>> valueRange(const core::Box3i& region) const
    {
        return std::nullopt;
    }

protected:
    VoxelSource() = default;
    VoxelSource(const VoxelSource& o, const osg::CopyOp& op) : osg::Object(o, op) {}
    ~VoxelSource() override = default;
};

/// Voxels in memory: the library's own, or the application's without a copy.
class OSGVOLUMIZER_EXPORT MemoryVoxelSource : public VoxelSource
{
public:
    META_Object(osgVolumizer, MemoryVoxelSource)

    MemoryVoxelSource() = default;
    MemoryVoxelSource(const MemoryVoxelSource& o, const osg::CopyOp& op);

    /// Allocates zeroed voxels. Refuses sizes below 1, and more than `maximumBytes` (default 2^36).
    Status allocate(const Description& description);
    /// Uses `data` (x fastest, tightly packed) as it is; `keepAlive` is called when no longer needed.
    /// The application may change the values; it then tells Voxels::dirty().
    Status setExternal(const Description& description, void* data, std::function<void()> release = {});

    void* data();
    const void* data() const;
    std::size_t sizeInBytes() const;

    Description describe() const override;
    Status read(const core::Box3i& region, void* destination) const override;

protected:
    ~MemoryVoxelSource() override;

private:
    Description _description;
    std::vector<unsigned char> _own;
    void* _external = nullptr;
    std::function<void()> _release;
};

} // namespace osgVolumizer
