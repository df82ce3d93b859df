#pragma once

#include "../textures/TableTextures.h"

#include "../../Voxels.h"
#include "../../core/geometry/Box.h"

#include <glm/mat3x3.hpp>

#include <list>
#include <mutex>

namespace osgVolumizer {
namespace render {

/// How finely a volume is sampled, and with which kind of table.
struct SamplingChoice
{
    double periodVoxel = 1.0;
    bool integrals = false;
    double error =
        0.0; ///< expected: root mean square over the components of pixels that show something
};

/// What a choice depends on, besides the data.
struct SamplingQuestion
{
    double tolerance = 1e-3; ///< root mean square error
    TableTexture midpoints;  ///< a table without integrals; none where texture is null
    TableTexture integrals;  ///< the same table with them; none where texture is null
    glm::dmat3 frameToUnits{1.0};
    core::Box3d box; ///< voxel frame; of the region
    bool nearest = false;
};

/// The longest period, and the cheaper table, whose error is within a tolerance. Found by marching
/// some random rays through the data itself, so it holds whatever the view: their values are
/// sampled once, much more finely than any choice, and then integrated with periods of a geometric
/// sequence, and compared. Reads the bricks that show something. Kept for the last few questions.
/// Thread safe.
class SamplingChoices
{
public:
    /// Expects voxels of one component.
    SamplingChoice get(const Voxels& voxels, const SamplingQuestion& question);

private:
    struct Entry
    {
        unsigned midpointsId, integralsId, layoutCount;
        std::uint64_t modified;
        double tolerance;
        glm::dmat3 frameToUnits;
        core::Box3d box;
        bool nearest;
        SamplingChoice choice;
    };
    static constexpr std::size_t CAPACITY = 4;

    std::mutex _mutex;
    std::list<Entry> _entries; ///< most recent first
};

} // namespace render
} // namespace osgVolumizer
