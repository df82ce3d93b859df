#include "GridSource.h"

#include <osgVolumizer/io/Placement.h>

#include <limits>

namespace osgVolumizer {
namespace vdb {

namespace {

glm::dvec3 toGlm(const openvdb::Vec3d& v)
{
    return {v.x(), v.y(), v.z()};
}

} // namespace

std::optional<GridKind> kindOf(const std::string& type, bool half)
{
    const auto real = [half](VoxelType whole) { return half ? VoxelType::HALF : whole; };
    if (type == openvdb::FloatGrid::gridType()) return GridKind{real(VoxelType::FLOAT32)};
    if (type == openvdb::DoubleGrid::gridType()) return GridKind{real(VoxelType::FLOAT64)};
    if (type == openvdb::BoolGrid::gridType() || type == openvdb::MaskGrid::gridType())
        return GridKind{VoxelType::UINT8};
    if (type == openvdb::Int32Grid::gridType()) return GridKind{VoxelType::INT32};
    if (type == openvdb::Int64Grid::gridType()) return GridKind{VoxelType::FLOAT64};
    if (type == openvdb::Vec3SGrid::gridType() || type == openvdb::Vec3IGrid::gridType())
        return GridKind{VoxelType::FLOAT32, 3};
    if (type == openvdb::Vec3DGrid::gridType()) return GridKind{VoxelType::FLOAT64, 3};
    return std::nullopt;
}

Result<GridToShow> gridToShow(const openvdb::GridBase::ConstPtr& grid)
{
    if (!grid->transform().isLinear())
        return Status(ErrorCode::NOT_SUPPORTED,
                      "its voxels lie in the frustum of a camera, which is not read");
    GridToShow show;
    show.grid = grid;
    show.box = grid->evalActiveVoxelBoundingBox();
    if (show.box.empty()) return Status(ErrorCode::FILE_UNREADABLE, "it has no active voxels");
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t size =
            std::int64_t(show.box.max()[axis]) - std::int64_t(show.box.min()[axis]) + 1;
        if (size > std::numeric_limits<int>::max())
            return Status(ErrorCode::TOO_LARGE, "its active voxels are " + std::to_string(size) +
                                                    " apart, more than 2147483647");
        show.description.size[axis] = static_cast<int>(size);
    }
    const openvdb::Vec3d first = grid->indexToWorld(show.box.min());
    glm::dmat3 steps(1.0);
    for (int axis = 0; axis < 3; ++axis) {
        openvdb::Vec3d to(0.0);
        to[axis] = 1.0;
        steps[axis] = toGlm(grid->indexToWorld(to) - grid->indexToWorld(openvdb::Vec3d(0.0)));
    }
    if (Status status = io::place(show.description, steps, toGlm(first)); !status.ok())
        return status;
    return show;
}

} // namespace vdb
} // namespace osgVolumizer
