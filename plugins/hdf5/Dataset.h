#pragma once

#include "Session.h"

#include <osgVolumizer/core/Status.h>
#include <osgVolumizer/core/voxels/VoxelType.h>

#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <vector>

namespace osgVolumizer {
namespace hdf5 {

// All functions here expect a Session.

/// What a dataset says of itself.
struct Dataset
{
    std::string path;
    std::vector<hsize_t> size; ///< slowest axis first
    std::string typeName;      ///< "uint8", "compound"
    bool numeric = false;
    VoxelType type = VoxelType::UINT8; ///< that its numbers are read as
    bool rounded = false;              ///< that is narrower than the file's

    /// "/a/b (10,20,30 of uint8)"
    std::string text() const;
};

/// Where the voxels of a dataset lie: axis z, followed by y and x, and the one of time steps. Axes
/// of length 1 beyond three do not count, the last ones first: so channels of one do not.
struct Axes
{
    int z = 0;
    int time = -1; ///< -1: there is none
};

/// FILE_UNREADABLE where it cannot be opened, NOT_SUPPORTED for one that lacks a decompressor,
/// TOO_LARGE for one in pieces that take too much memory each.
Result<Dataset> inspect(hid_t file, const std::string& path);
/// All datasets of a file, by name; none of those behind links to other files.
Result<std::vector<Dataset>> listDatasets(hid_t file);

/// None unless there are three, or four with time.
std::optional<Axes> axesOf(const Dataset& dataset);
/// Samples along x, y, z. VALUE_INVALID where there are none along an axis, TOO_LARGE for more than
/// 2^31 - 1. Expects `axis` to be followed by two more.
Result<glm::ivec3> voxelSize(const Dataset& dataset, int axis);
/// NOT_SUPPORTED for what is no volume of numbers.
Status checkVolume(const Dataset& dataset);
/// The same, and for one with any other axes than z,y,x.
Status checkLevel(const Dataset& dataset);

} // namespace hdf5
} // namespace osgVolumizer
