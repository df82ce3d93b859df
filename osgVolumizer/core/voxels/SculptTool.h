#pragma once

#include "../Export.h"
#include "../geometry/Box.h"
#include "VoxelType.h"

#include <glm/vec3.hpp>

#include <vector>

namespace osgVolumizer {
namespace core {

/// What a tool does to a value V under it, both V and the tool's T scaled to [0, 1]: after the
/// course notes of J. A. Baerentzen, "Texture based volume editing", 2004; the first two are the
/// soft union and difference of Perlin and Hoffert, "Hypertexture", SIGGRAPH 1989.
enum class SculptOperation : int
{
    PERLIN_ADD, ///< V + T - V T
    PERLIN_SUB, ///< V - V T
    MAX_ADD,    ///< max(V, T)
    MIN_SUB,    ///< min(V, 1 - T)
    ERASE       ///< 0, wherever T > 0
};

/// The form of a tool: T = strength * max(0, 1 - d), where d grows from 0 in its middle to 1 at its
/// surface.
enum class SculptShape : int
{
    ROUND, ///< an ellipsoid: d is the length of x / radius
    BOX    ///< d is the largest component of |x / radius|
};

/// A tool in the voxel frame.
struct SculptTool
{
    SculptOperation operation = SculptOperation::MAX_ADD;
    SculptShape shape = SculptShape::ROUND;
    glm::dvec3 radius{10.0};      ///< half extents, samples, each > 0
    double strength = 1.0;        ///< T in its middle, in (0, 1]
    double low = 0.0, high = 1.0; ///< values of the data that count as 0 and as 1
    double erased = 0.0;          ///< what ERASE sets, a value of the data
};

/// T at a place, from the tool's middle, samples.
OSGVOLUMIZER_CORE_EXPORT double toolValue(const SculptTool& tool, const glm::dvec3& offset);
/// The samples where T may be above 0.
OSGVOLUMIZER_CORE_EXPORT Box3i toolBox(const SculptTool& tool, const glm::dvec3& middleVoxel);

/// Applies a tool at a place to the samples of a box, tightly packed. Values stay within their
/// type, integers are rounded to nearest. What is added never lowers a value, nor does what is
/// taken away raise one, also outside [low, high]. Holes, NaN and infinite values, count as `low`
/// and are filled by what adds or erases; what takes away leaves them. Of RGBA it changes alpha.
/// \param changed gets, of each row, the part from the first to the last sample that has changed
OSGVOLUMIZER_CORE_EXPORT void applyTool(const SculptTool& tool, const glm::dvec3& middleVoxel,
                                        void* data, const Box3i& samples, VoxelType type,
                                        int components, std::vector<Box3i>& changed);

} // namespace core
} // namespace osgVolumizer
